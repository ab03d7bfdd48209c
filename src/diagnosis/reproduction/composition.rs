//! What several mistakes do together, foretold from what each does alone: factors multiply, and what is added adds up.
//!
//! Two mistakes and more in one function show in all of its numbers together, and the sets of them are too many to be
//! tried. Those that foretell the most numbers are.

use super::Mistake;
use super::likeness::ALIKE;
use crate::checks::{Finding, Measure};
use std::collections::BTreeSet;

/// Mistakes of one set.
const LARGEST: usize = 4;
/// Sets that are looked at, so that it takes no longer than a trial.
const LOOKED_AT: usize = 500_000;
/// Numbers that are foretold of a case.
const NUMBERS: usize = 24;

/// What came of one case.
pub(super) struct Seen<'a> {
    pub(super) core: &'a Finding,
    /// By each mistake alone, at a first look; none where it could not be asked.
    pub(super) alone: Vec<Option<Finding>>,
}

/// A wrong number of the core: what would be right, and what each mistake alone makes of it.
struct Number {
    right: f64,
    core: f64,
    slack: f64,
    alone: Vec<Alone>,
}

/// NaN where it could not be asked.
#[derive(Clone, Copy)]
struct Alone {
    measured: f64,
    noise: f64,
}

/// The sets of two mistakes and more that foretell the most of what was seen, the likeliest first, each of other causes.
pub(super) fn likely(mistakes: &[Mistake], seen: &[Seen<'_>], count: usize) -> Vec<Vec<Mistake>> {
    let cases: Vec<_> = seen.iter().map(|one| numbers(one, mistakes.len())).collect();
    let shows = |mistake: &usize| {
        let is_wrong = |number: &Number| {
            let Alone { measured, noise } = number.alone[*mistake];
            measured.is_finite() && !is_near(measured, number.right, number.slack + noise)
        };
        cases.iter().flatten().any(is_wrong)
    };
    let showing: Vec<_> = (0..mistakes.len()).filter(shows).collect();
    let mut scored = Vec::new();
    for set in sets(&showing) {
        let score: f64 = cases.iter().map(|case| foretold(case, &set)).sum();
        if 2.0 * score > cases.len() as f64 {
            scored.push((score, set));
        }
    }
    scored.sort_by(|(a, one), (b, other)| b.total_cmp(a).then(one.len().cmp(&other.len())));
    let mut causes = BTreeSet::new();
    let sets = scored
        .into_iter()
        .map(|(_, set)| -> Vec<_> { set.into_iter().map(|number| mistakes[number]).collect() });
    let is_new = |set: &Vec<Mistake>| {
        let of_set: BTreeSet<_> = set.iter().map(|mistake| mistake.cause.name).collect();
        of_set.len() == set.len() && causes.insert(of_set)
    };
    sets.filter(is_new).take(count).collect()
}

/// All sets of two and more of these, the small ones first.
fn sets(of: &[usize]) -> impl Iterator<Item = Vec<usize>> + use<> {
    let mut all: Vec<Vec<usize>> = of.iter().map(|one| vec![*one]).collect();
    let mut from = 0;
    for _ in 1..LARGEST {
        let smaller = from..all.len();
        from = smaller.end;
        for number in smaller {
            let last = all[number].last().copied();
            let beyond = of.iter().filter(|one| Some(**one) > last);
            let larger: Vec<_> = beyond.map(|one| [&all[number][..], &[*one]].concat()).collect();
            all.extend(larger);
            if all.len() > LOOKED_AT {
                break;
            }
        }
    }
    all.into_iter().skip(of.len())
}

/// The share of a case's numbers that a set foretells.
fn foretold(case: &[Number], set: &[usize]) -> f64 {
    let is_foretold = |number: &&Number| {
        let alone = || set.iter().map(|mistake| number.alone[*mistake]);
        let right = number.right;
        let product = alone().map(|one| one.measured / right).product::<f64>() * right;
        let largest = |one: Alone| (one.measured.abs() + one.noise) / right.abs();
        let of_product = alone().map(largest).product::<f64>() * right.abs() - product.abs();
        let sum = alone().map(|one| one.measured - right).sum::<f64>() + right;
        let of_sum: f64 = alone().map(|one| one.noise).sum();
        let is_given = |given, noise: f64| is_near(given, number.core, number.slack + noise);
        is_given(product, of_product) || is_given(sum, of_sum)
    };
    case.iter().filter(is_foretold).count() as f64 / case.len().max(1) as f64
}

impl Alone {
    fn of(measure: Option<&Measure>) -> Self {
        let none = Self { measured: f64::NAN, noise: 0.0 };
        measure.map_or(none, |one| Self { measured: one.measured, noise: noise(one) })
    }
}

/// Half of the interval that it lies in.
fn noise(measure: &Measure) -> f64 {
    measure.interval.map_or(0.0, |[low, high]| 0.5 * (high - low))
}

/// NaN is near nothing.
fn is_near(one: f64, other: f64, slack: f64) -> bool {
    (one - other).abs() <= slack
}

/// The numbers of a case that are wrong, or that some mistake makes wrong.
fn numbers(seen: &Seen<'_>, mistakes: usize) -> Vec<Number> {
    let of_mistake = |mistake: usize, core: &Measure| {
        let measures = &seen.alone[mistake].as_ref()?.measures;
        measures.iter().find(|of_mistake| of_mistake.question() == core.question())
    };
    let number = |core: &Measure| {
        let alone: Vec<_> = (0..mistakes).map(|mistake| of_mistake(mistake, core)).collect();
        let is_wrong = core.failed() || alone.iter().flatten().any(|measure| measure.failed());
        // What is infinite is near everything, and foretold by anything.
        (is_wrong && core.measured.is_finite()).then(|| Number {
            right: core.expected,
            core: core.measured,
            slack: core.allowed + noise(core) + ALIKE * (core.measured - core.expected).abs(),
            alone: alone.into_iter().map(Alone::of).collect(),
        })
    };
    let mut all: Vec<_> = seen.core.measures.iter().filter_map(number).collect();
    // What is the furthest off tells the most.
    let error = |number: &Number| ((number.core - number.right) / number.right).abs();
    all.sort_by(|one, other| error(other).total_cmp(&error(one)));
    all.truncate(NUMBERS);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{bsdf, integrator, light};
    use crate::contract::Components;
    use crate::diagnosis::testing::{mean, means};
    use crate::image::Channel;

    #[test]
    fn factors_multiply_and_what_is_added_adds_up() {
        let mistake = |name, cause| Mistake {
            name,
            cause,
            components: Components::BSDF,
            caught_by: "bsdf/a",
        };
        let mistakes = [
            mistake("pi", &bsdf::WITHOUT_PI),
            mistake("again", &integrator::EMISSION_AGAIN),
            mistake("cosine", &light::WORLD_COSINE),
            mistake("divided", &light::DIVIDED_BY_LIGHTS),
        ];
        let light = |ratios: [f64; 3]| {
            let of = |(row, ratio)| mean(row, Channel::Red, 0.5, ratio, 0.01);
            means(["a", "b", "c"].into_iter().zip(ratios).map(of).collect())
        };
        let alone = [[3.0, 3.0, 3.0], [1.0, 1.5, 1.0], [1.0, 0.5, 0.7], [0.5, 0.5, 0.5]];
        let likely = |core: [f64; 3]| -> Vec<_> {
            let core = light(core);
            let alone = alone.map(|ratios| Some(light(ratios))).to_vec();
            let sets = likely(&mistakes, &[Seen { core: &core, alone }], 1).into_iter().flatten();
            sets.map(|mistake| mistake.name).collect()
        };
        assert_eq!(likely([1.5, 0.75, 1.05]), ["pi", "cosine", "divided"]);
        assert_eq!(likely([3.0, 3.5, 3.0]), ["pi", "again"]);
        assert!(likely([7.0, 11.0, 13.0]).is_empty());
        assert!(likely([f64::INFINITY, f64::INFINITY, f64::NAN]).is_empty());
    }
}
