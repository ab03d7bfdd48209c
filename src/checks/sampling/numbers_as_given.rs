//! A sample is a function of its own random numbers: the same again for the same, wherever it
//! stands in a batch, and moved by each of the two that choose the direction.

use super::distribution::{DistributionEntry, Drawn, random_numbers};
use crate::cause::{Cause, sampling};
use crate::checks::phrase::{at_most, percent, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Capabilities, Randomness, Result};
use crate::math::rng::Seed;
use glam::{DVec2, DVec3};
use serde::Deserialize;

/// Samples.
const COUNT: usize = 2000;
/// A number is changed by this much: about a third of its range, round the end.
const STEP: f64 = 0.37;
/// A direction that is moved by less than this has not been moved.
const MOVED: f64 = 1e-4;
/// Numbers that do nothing for more samples than this share are not used. Failed samples stay where
/// they are, and so do those of a lobe that needs fewer numbers.
const MOSTLY: f64 = 0.5;

/// Samples follow from the numbers they are given.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct NumbersAsGiven {
    distribution: DistributionEntry,
}

impl Check for NumbersAsGiven {
    const NAME: &'static str = "numbers-as-given";
    const SUMMARY: &'static str = "samples follow from their own numbers, and use both";

    fn needs(&self) -> Capabilities {
        self.distribution.needs() | Capabilities::CALLERS_RANDOMNESS
    }

    fn validate(&self) -> std::result::Result<(), String> {
        self.distribution.validate()
    }

    fn run(&self, context: &mut Context<'_>) -> std::result::Result<Finding, CheckError> {
        let mut judged = Vec::new();
        for distribution in self.distribution.distributions() {
            let seed = context.seed.child(distribution.name());
            let mut ask = |numbers: &Numbers| {
                let random =
                    Randomness { points: &numbers.points, lobes: &numbers.lobes, seed: seed.0 };
                distribution.sample(context.core, random)
            };
            judged.push(Judged::of(distribution.name(), &Numbers::random(seed), &mut ask)?);
        }
        Ok(finding(&judged))
    }
}

/// The numbers of a batch.
#[derive(Clone)]
struct Numbers {
    points: Vec<DVec2>,
    lobes: Vec<f64>,
}

impl Numbers {
    fn random(seed: Seed) -> Self {
        let (points, lobes) = random_numbers(seed, COUNT);
        Self { points, lobes }
    }

    /// The same backwards.
    fn reversed(&self) -> Self {
        Self {
            points: self.points.iter().rev().copied().collect(),
            lobes: self.lobes.iter().rev().copied().collect(),
        }
    }

    /// One of the numbers of every sample, changed.
    fn with_changed(&self, number: Number) -> Self {
        let change = |value: &mut f64| *value = (*value + STEP).fract();
        let mut changed = self.clone();
        match number {
            Number::First => changed.points.iter_mut().for_each(|point| change(&mut point.x)),
            Number::Second => changed.points.iter_mut().for_each(|point| change(&mut point.y)),
        }
        changed
    }
}

#[derive(Clone, Copy)]
enum Number {
    First,
    Second,
}

/// What came of one distribution.
struct Judged {
    name: String,
    /// Samples that differ when the same is asked again.
    forgotten: usize,
    /// Samples that differ when the batch is asked backwards.
    misplaced: usize,
    /// Shares of samples that the first and the second number move.
    moved: [f64; 2],
    /// Whether both numbers move every sample along the same curve.
    along_one_curve: bool,
}

impl Judged {
    fn of(
        name: String,
        numbers: &Numbers,
        ask: &mut dyn FnMut(&Numbers) -> Result<Vec<Drawn>>,
    ) -> Result<Self> {
        let first = ask(numbers)?;
        let again = ask(numbers)?;
        let mut backwards = ask(&numbers.reversed())?;
        backwards.reverse();
        let changed = [Number::First, Number::Second].map(|number| numbers.with_changed(number));
        let moved = [ask(&changed[0])?, ask(&changed[1])?];
        let swapped = Numbers {
            points: numbers.points.iter().map(|point| DVec2::splat(point.x)).collect(),
            ..numbers.clone()
        };
        let along = ask(&swapped)?;
        Ok(Self {
            name,
            forgotten: differing(&first, &again),
            misplaced: differing(&first, &backwards),
            moved: moved.each_ref().map(|moved| share_moved(&first, moved)),
            along_one_curve: differing(&first, &along) == 0,
        })
    }

    fn measures(&self) -> Vec<Measure> {
        let count = |what: &str, found: usize| {
            Measure::exact(format!("{}: {what}", self.name), found as f64, 0.0, 0.0)
        };
        let share = |which: &str, moved: f64| {
            let what = "share of samples that are not moved by the";
            at_most(format!("{}: {what} {which} number", self.name), 1.0 - moved, 1.0 - MOSTLY)
        };
        vec![
            count("samples that differ when they are asked for again", self.forgotten),
            count("samples that depend on their place in the batch", self.misplaced),
            share("first", self.moved[0]),
            share("second", self.moved[1]),
        ]
    }

    fn complaint(&self) -> Option<String> {
        let told = |some: usize, what: &str| {
            format!("{}: {} {what}", self.name, some_are(some, COUNT, "samples"))
        };
        if self.forgotten > 0 {
            return Some(told(self.forgotten, "another when the same numbers are given again"));
        }
        if self.misplaced > 0 {
            return Some(told(self.misplaced, "another at another place of the batch"));
        }
        let unused = (0..2).find(|number| self.moved[*number] < MOSTLY)?;
        let share = percent(self.moved[unused]);
        let which = ["first", "second"][unused];
        Some(format!("{}: the {which} number moves {share} of the samples", self.name))
    }

    fn cause(&self) -> Option<(&'static Cause, String)> {
        if self.forgotten > 0 {
            let evidence = format!("{} of {COUNT} samples change", self.forgotten);
            return Some((&sampling::OWN_NUMBERS, evidence));
        }
        if self.misplaced > 0 {
            let evidence = format!("{} of {COUNT} samples change with their place", self.misplaced);
            return Some((&sampling::NUMBERS_OF_ANOTHER, evidence));
        }
        let evidence = || "the second number of every sample can be replaced by its first";
        (self.along_one_curve).then(|| (&sampling::ONE_NUMBER_TWICE, evidence().to_owned()))
    }
}

/// Samples that have not the same bits.
fn differing(first: &[Drawn], other: &[Drawn]) -> usize {
    let bits = |drawn: &Drawn| {
        let direction = drawn.direction.map(|direction| direction.to_array().map(f64::to_bits));
        (direction, drawn.pdf.to_bits())
    };
    first.iter().zip(other).filter(|(a, b)| bits(a) != bits(b)).count()
}

/// The share of samples that lie elsewhere, of those that lie anywhere.
fn share_moved(first: &[Drawn], other: &[Drawn]) -> f64 {
    let pairs = || first.iter().zip(other).filter_map(|(a, b)| Some((a.direction?, b.direction?)));
    let is_moved = |(a, b): &(DVec3, DVec3)| a.distance(*b) > MOVED;
    pairs().filter(is_moved).count() as f64 / pairs().count() as f64
}

fn finding(judged: &[Judged]) -> Finding {
    let measures = judged.iter().flat_map(Judged::measures).collect();
    let complaints: Vec<_> = judged.iter().filter_map(Judged::complaint).collect();
    let statement = match complaints.is_empty() {
        true => format!("{} samples follow from their own numbers", COUNT * judged.len()),
        false => complaints.join("; "),
    };
    let resolution = "would have caught one sample that is not a function of its numbers";
    let finding = Finding::of(statement, resolution, measures);
    let causes = judged.iter().filter_map(Judged::cause);
    causes.fold(finding, |finding, (cause, evidence)| finding.because(cause, evidence))
}

#[cfg(test)]
mod tests {
    use super::super::fake::cosine;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, info, judge};
    use crate::contract::{Core, CoreInfo, DirectionSample, Precision, Sampler};

    /// Samples by the numbers of a whole batch.
    struct Batches {
        point: fn(&[DVec2], usize, u64) -> DVec2,
        calls: u64,
    }

    impl Core for Batches {
        fn info(&self) -> CoreInfo {
            info(Precision::Double)
        }

        fn sample_direction(
            &mut self,
            _: Sampler,
            random: Randomness<'_>,
            samples: &mut [DirectionSample],
        ) -> Result<()> {
            self.calls += 1;
            for (number, sample) in samples.iter_mut().enumerate() {
                let point = (self.point)(random.points, number, self.calls);
                let direction = cosine(point).unwrap_or(DVec3::Z);
                *sample = DirectionSample { direction, pdf: direction.z };
            }
            Ok(())
        }
    }

    fn found(point: fn(&[DVec2], usize, u64) -> DVec2) -> Finding {
        let check: NumbersAsGiven =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        judge(&check, &mut Batches { point, calls: 0 })
    }

    fn cause(point: fn(&[DVec2], usize, u64) -> DVec2) -> String {
        let finding = found(point);
        failure(&finding);
        finding.clues.first().map_or_else(String::new, |clue| clue.cause.clone())
    }

    #[test]
    fn a_function_of_its_numbers_passes() {
        assert_passes(&found(|points, number, _| points[number]));
    }

    #[test]
    fn numbers_of_its_own_are_named() {
        let name = cause(|points, number, calls| (points[number] + 0.1 * calls as f64).fract());
        assert_eq!(name, "own-random-numbers");
    }

    #[test]
    fn numbers_of_another_sample_are_named() {
        let name = cause(|points, number, _| points[(number + 1) % points.len()]);
        assert_eq!(name, "numbers-of-another-sample");
        assert_eq!(cause(|points, _, _| points[0]), "numbers-of-another-sample");
    }

    #[test]
    fn one_number_for_both_coordinates_is_named() {
        assert_eq!(cause(|points, number, _| DVec2::splat(points[number].x)), "one-number-twice");
    }

    #[test]
    fn a_number_that_moves_nothing_is_told() {
        let finding = found(|points, number, _| points[number].with_y(0.3));
        assert!(failure(&finding).ends_with("the second number moves 0 % of the samples"));
    }
}
