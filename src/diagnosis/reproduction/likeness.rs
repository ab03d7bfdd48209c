//! Whether two cores are wrong alike, number by number.

use crate::checks::law::LOST_SAMPLES;
use crate::checks::{Finding, Measure, STANDARD_ERRORS};
use crate::diagnosis::Observation;
use std::collections::{BTreeMap, BTreeSet};

/// Of the numbers that are wrong in one core or the other, so many have to agree.
const MOST: f64 = 0.95;
/// By how much of itself an error of the same mistake may differ from core to core: their samplers, tolerances and
/// trees are not the same.
pub(super) const ALIKE: f64 = 0.1;
/// The same of light, of which both know the mean within their noise: what differs by more is weighted otherwise.
const NEARLY: f64 = 0.03;
/// The same where light is known without noise: roundings and quadratures alone differ.
const EXACTLY: f64 = 0.01;

/// What explains less than one of so many wrong answers explains hardly anything.
const HARDLY: usize = 4;

/// How the numbers of a core compare with those of a planted mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Likeness {
    /// Wrong in the same places, to the same side, by as much.
    Same,
    /// Wrong in the same places and to the same side.
    Alike,
    /// Wrong elsewhere, or to the other side.
    Other,
    /// Both are wrong, and have no numbers to compare.
    Unsized,
    /// They cannot be compared.
    Unknown,
}

impl Likeness {
    /// Whether numbers were compared, or the planted mistake passes what the core fails.
    pub(super) fn is_known(self) -> bool {
        !matches!(self, Self::Unsized | Self::Unknown)
    }

    /// Whether nothing tells the two apart, as far as it is known.
    pub(super) fn may_be_reproduced(self) -> bool {
        self.is_reproduced() || self == Self::Unknown
    }

    /// Whether nothing tells the two apart.
    pub(super) fn is_reproduced(self) -> bool {
        matches!(self, Self::Same | Self::Unsized)
    }
}

/// How what a core answered compares with what a planted mistake answers; a core that stopped answering has no finding.
pub(super) fn likeness(core: Option<&Finding>, planted: &Finding) -> Likeness {
    let Some(core) = core else { return by_verdict(planted) };
    if follow_other_formulas(core, planted) {
        return Likeness::Other;
    }
    let pairs = core.measures.iter().filter_map(|of_core| {
        let is_same = |other: &&Measure| asks_the_same(of_core, other);
        Some((of_core, planted.measures.iter().find(is_same)?))
    });
    // That both are dark, or NaN, many mistakes have in common.
    let tells = |(a, b): &(&Measure, &Measure)| {
        (is_off(a) || is_off(b)) && !(a.is_degenerate() && b.is_degenerate())
    };
    let wrong: Vec<_> = pairs.filter(tells).collect();
    if wrong.is_empty() {
        return if broke_alike(core, planted) { Likeness::Same } else { by_verdict(planted) };
    }
    let told = wrong.len() + unanswered(core, planted);
    let most = |agree: fn(&Measure, &Measure) -> bool| {
        let count = wrong.iter().filter(|(a, b)| agree(a, b)).count();
        count as f64 >= MOST * told as f64
    };
    match (most(errs_alike), most(errs_as_much)) {
        // So little is wrong that the noise of one of them hides it.
        (_, true) if !planted.failed() => Likeness::Unknown,
        (_, true) => Likeness::Same,
        (true, false) => Likeness::Alike,
        (false, false) => Likeness::Other,
    }
}

/// How many numbers are wrong with the planted mistake of which the core has none, as where it never samples that lobe.
fn unanswered(core: &Finding, planted: &Finding) -> usize {
    let missing = core.measures.iter().filter(|one| one.measured.is_nan() && !one.failed());
    let is_wrong =
        |one: &&Measure| planted.failed_measures().any(|other| one.question() == other.question());
    missing.filter(is_wrong).count()
}

/// Whether the case has recognised each by a formula of its own: sizes may meet by chance, and answers follow one formula.
/// Light is recognised by ratios, which noise blurs; but what loses samples weighs the others rightly. What follows a law with
/// one core does with the other: both are asked for the same numbers.
fn follow_other_formulas(core: &Finding, planted: &Finding) -> bool {
    let [of_core, of_planted] = [core, planted].map(formulas);
    let are_known = !of_core.is_empty() && !of_planted.is_empty();
    let loses_samples = |finding: &Finding| finding.laws.iter().any(|law| law == LOST_SAMPLES);
    let [law_of_core, law_of_planted] = [core, planted].map(laws);
    let breaks_the_law = !law_of_core.is_empty() && law_of_core.is_disjoint(&law_of_planted);
    are_known && of_core.is_disjoint(&of_planted)
        || breaks_the_law && planted.failed()
        || loses_samples(core) && planted.failed() && !loses_samples(planted)
}

/// The causes whose formula gives every answer of a finding about single functions.
fn formulas(finding: &Finding) -> BTreeSet<&str> {
    let is_light = finding.measures.iter().any(|measure| measure.channel.is_some());
    let is_numbered = finding.failed_measures().next().is_some();
    let alone = finding.clues.iter().filter(|clue| !clue.beside && is_numbered && !is_light);
    alone.map(|clue| &clue.cause[..]).collect()
}

/// The laws of wrong answers of single functions, without their numbers, which depend on what was asked.
fn laws(finding: &Finding) -> BTreeSet<String> {
    let is_light = finding.measures.iter().any(|measure| measure.channel.is_some());
    let laws = finding.laws.iter().filter(|_| !is_light);
    let is_of_number = |letter: char| letter.is_ascii_digit() || letter == '.';
    laws.map(|law| law.replace(is_of_number, "")).collect()
}

/// How a finding is known to have broken the contract.
fn ways(finding: &Finding) -> BTreeSet<&str> {
    finding.clues.iter().map(|clue| &clue.cause[..]).collect()
}

/// Whether both broke the contract, and in the same way: one that has a name, or else in the same words, numbers included
/// (`hit 3 of 432: shape 1 has no primitive 1002`).
fn broke_alike(core: &Finding, planted: &Finding) -> bool {
    let have_no_measures = core.measures.is_empty() && planted.measures.is_empty();
    let is_named = !core.clues.is_empty();
    let has_numbers = core.statement.contains(|letter: char| letter.is_ascii_digit());
    let is_to_the_letter = has_numbers && planted.failed() && core.statement == planted.statement;
    have_no_measures && ways(core) == ways(planted) && (is_named || is_to_the_letter)
}

/// Whether the core broke the contract in a way that is known, and what is planted has wrong numbers and kept it: something
/// else is wrong.
pub(super) fn breaks_otherwise(core: &Finding, planted: &Finding) -> bool {
    let has_numbers = |finding: &Finding| finding.failed_measures().next().is_some();
    let (of_core, of_planted) = (ways(core), ways(planted));
    let breaks = !of_core.is_empty() && !has_numbers(core);
    breaks && has_numbers(planted) && of_core.is_disjoint(&of_planted)
}

/// Whether what is planted explains hardly anything of what is wrong, of answers of single functions, which are known without
/// noise: one more mistake in the same lines adds some wrong answers, and hardly takes any away.
pub(super) fn hardly_explains(planted: &Finding, core: &Finding) -> bool {
    let is_known = |measure: &Measure| {
        measure.channel.is_none() && measure.interval.is_none() && measure.hypothesis.is_none()
    };
    let pair = |of_core| {
        let is_same = |other: &&Measure| asks_the_same(of_core, other);
        Some((of_core, planted.measures.iter().find(is_same)?))
    };
    let known = core.measures.iter().filter(|one| is_known(one)).filter_map(pair);
    let wrong: Vec<_> = known.filter(|(core, other)| core.failed() || other.failed()).collect();
    let explained = wrong.iter().filter(|(core, other)| errs_as_much(core, other)).count();
    planted.failed() && HARDLY * explained < wrong.len()
}

/// Of what failed without a number: nothing is known of its size.
fn by_verdict(planted: &Finding) -> Likeness {
    if planted.failed() { Likeness::Unsized } else { Likeness::Other }
}

/// The same number of the same row, of which the same is expected.
fn asks_the_same(a: &Measure, b: &Measure) -> bool {
    let slack = 1e-6 * a.expected.abs() + a.allowed.max(b.allowed);
    a.question() == b.question() && (a.expected - b.expected).abs() <= slack
}

/// Whether a number is wrong itself: one that stands for a test fails with it, however right it is.
fn is_off(measure: &Measure) -> bool {
    let holds = |[low, high]: [f64; 2]| low <= measure.expected && measure.expected <= high;
    measure.failed() && !measure.interval.is_some_and(holds)
}

/// Both are wrong, to the same side; or they cannot be told apart.
fn errs_alike(a: &Measure, b: &Measure) -> bool {
    let side = |measure: &Measure| measure.measured.partial_cmp(&measure.expected);
    a.failed() && b.failed() && side(a) == side(b) || errs_as_much(a, b)
}

/// The numbers lie within each other's noise, and a little of the error; light without noise follows from a formula. Of what
/// is known and nearly all lost what is left counts: a fortieth is not darkness. What is counted in standard errors
/// grows with the samples and has no size.
fn errs_as_much(a: &Measure, b: &Measure) -> bool {
    if a.unit == STANDARD_ERRORS {
        return a.failed() == b.failed();
    }
    let error = (a.measured - a.expected).abs().max((b.measured - b.expected).abs());
    let left = a.measured.abs().max(b.measured.abs());
    let are_light = a.channel.is_some() && b.channel.is_some();
    let is_noisy = a.interval.or(b.interval).is_some();
    // What was drawn and has no interval, as counts, is noisy nevertheless.
    let is_known = are_light || !is_noisy && a.hypothesis.is_none() && b.hypothesis.is_none();
    let size = if is_known { error.min(left) } else { error };
    a.meets(b, share(are_light, is_noisy) * size)
}

/// By how much of itself an error of the same mistake may differ.
fn share(is_light: bool, is_noisy: bool) -> f64 {
    match (is_light, is_noisy) {
        (true, false) => EXACTLY,
        (true, true) => NEARLY,
        (false, _) => ALIKE,
    }
}

/// The chance that a mistake which is not made comes to the numbers of these cases all the same. Each number that is off by
/// another factor tells something that the others do not: as much as its error is known to. Of answers that are yes or no
/// all errors are one, and which of them are wrong tells: each after the first halves it.
pub(super) fn by_chance(cases: &[&Observation<'_>]) -> f64 {
    let measures = cases.iter().filter_map(|seen| seen.finding).flat_map(|found| &found.measures);
    let wrong = measures.filter(|measure| measure.failed() && !measure.is_degenerate());
    let answers = wrong.clone().filter(|measure| measure.is_yes_or_no()).count();
    let scale = |measure: &Measure| if measure.expected == 0.0 { 1.0 } else { measure.expected };
    let class =
        |measure: &Measure| ((measure.measured / scale(measure)).abs().ln() / ALIKE).round() as i64;
    let mut chances: BTreeMap<i64, f64> = BTreeMap::new();
    for measure in wrong {
        let of_class = chances.entry(class(measure)).or_insert(1.0);
        *of_class = of_class.min(chance_of(measure));
    }
    chances.values().product::<f64>() * 0.5_f64.powi(answers.saturating_sub(1) as i32)
}

/// The part of what an error might be that counts as the same.
fn chance_of(measure: &Measure) -> f64 {
    let is_light = measure.channel.is_some();
    let width = measure.interval.map_or(0.0, |[low, high]| high - low);
    let error = (measure.measured - measure.expected).abs();
    share(is_light, measure.interval.is_some()) + width / error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{contract, shape};
    use crate::diagnosis::testing::{Made, failing, mean, means, passing};
    use crate::image::Channel;
    use crate::stats::Verdict;

    #[test]
    fn answers_of_another_formula_are_not_alike_though_their_sizes_meet() {
        let wrong = |cause: &'static crate::cause::Cause| {
            let error = Measure::exact("ray 1: error of the normal", 0.17, 0.0, 1e-9);
            means(vec![error]).because(cause, "predicts the answers to all 2 rays")
        };
        let [swapped, moved_on] = [&shape::NORMALS_SWAPPED, &shape::NORMALS_MOVED_ON].map(wrong);
        assert_eq!(likeness(Some(&moved_on), &swapped), Likeness::Other);
        assert_eq!(likeness(Some(&swapped), &swapped), Likeness::Same);
        let half = || means(vec![mean("a", Channel::Red, 0.5, 0.5, 0.01)]);
        let lost = half().knowing_laws([LOST_SAMPLES.to_owned()]);
        assert_eq!(
            likeness(Some(&lost), &half()),
            Likeness::Other,
            "no light is weighted by a half"
        );
        assert_eq!(likeness(Some(&half()), &lost), Likeness::Same);
        let nameless = Finding { clues: Vec::new(), ..moved_on };
        assert_eq!(likeness(Some(&nameless), &swapped), Likeness::Same);
    }

    #[test]
    fn one_more_mistake_leaves_the_wrong_answers_of_another() {
        let answers = |wrong: &[usize]| {
            let hits = |ray: usize| {
                let measured = f64::from(u8::from(!wrong.contains(&ray)));
                Measure::exact("hits", measured, 1.0, 0.0).of_row(format!("ray {ray}"))
            };
            means((0..12).map(hits).collect())
        };
        let planted = answers(&[1, 2]);
        assert!(hardly_explains(&planted, &answers(&[2, 3, 4, 5, 6])));
        assert!(hardly_explains(&planted, &answers(&[1, 2, 3, 4, 5, 6, 7, 8, 9])));
        assert!(!hardly_explains(&planted, &answers(&[1, 2, 3, 4, 5, 6])));
        assert!(!hardly_explains(&answers(&[]), &planted), "it gets nothing wrong");
        let lit = |by: f64| means(vec![mean("a", Channel::Red, 0.5, by, 0.01)]);
        assert!(!hardly_explains(&lit(2.0), &lit(1.0)), "light may be made up for");
    }

    #[test]
    fn which_of_many_answers_are_wrong_tells_more_than_that_one_is() {
        let hits = |ray: usize| Measure::exact("hits", 1.0, 0.0, 0.0).of_row(format!("ray {ray}"));
        let chance = |rays: usize| {
            let made = Made::new().with("bvh/boxes", means((0..rays).map(hits).collect()));
            let evidence = made.evidence();
            by_chance(&evidence.failures().collect::<Vec<_>>())
        };
        assert_eq!([1, 2, 7].map(chance), [1, 2, 64].map(|part| ALIKE / f64::from(part)));
        let lost = Measure::exact("hits", 0.0, 1.0, 0.0);
        assert!(lost.is_yes_or_no() && !Measure::exact("t", 1.0, 0.5, 0.0).is_yes_or_no());
    }

    #[test]
    fn what_a_core_never_answers_is_not_wrong_alike() {
        let share = |name: &str, measured| Measure::exact(name, measured, 0.03, 1e-9);
        let both = means(vec![share("reflected share", 0.7), share("refracted share", 0.2)]);
        let unmet = Measure {
            verdict: Verdict::Inconclusive,
            ..Measure::exact("refracted share", f64::NAN, 0.0, 1e-9)
        };
        let reflected = means(vec![share("reflected share", 0.7), unmet]);
        assert_eq!(likeness(Some(&reflected), &both), Likeness::Other);
        assert_eq!(likeness(Some(&reflected), &reflected), Likeness::Same);
    }

    #[test]
    fn what_follows_a_law_is_not_alike_what_follows_another_or_none() {
        let wrong = || means(vec![Measure::exact("error of half of the points", 0.9, 0.0, 1e-9)]);
        let of = |law: &str| wrong().knowing_laws([law.to_owned()]);
        let constant = of("f is 0.0286 / D(h) times what it should be");
        let cosine = of("f is 0.938 (cos θh)² times what it should be");
        assert_eq!(likeness(Some(&constant), &cosine), Likeness::Other);
        assert_eq!(likeness(Some(&constant), &wrong()), Likeness::Other);
        let other_rows = of("f is 0.258 / D(h) times what it should be");
        assert_eq!(likeness(Some(&constant), &other_rows), Likeness::Same);
        assert_eq!(likeness(Some(&wrong()), &cosine), Likeness::Same, "no law is found of noise");
    }

    #[test]
    fn numbers_are_compared_row_by_row_and_what_has_none_by_its_verdict() {
        let two = |a, b| {
            means(vec![
                mean("a", Channel::Red, 0.5, a, 0.01),
                mean("b", Channel::Red, 0.5, b, 0.01),
            ])
        };
        assert_eq!(likeness(Some(&two(2.0, 1.0)), &two(2.0, 1.0)), Likeness::Same);
        assert_eq!(likeness(Some(&two(2.0, 1.0)), &two(3.0, 1.0)), Likeness::Alike);
        assert_eq!(likeness(Some(&two(2.0, 1.0)), &two(1.85, 1.0)), Likeness::Alike, "weighted");
        assert_eq!(likeness(Some(&two(2.0, 1.0)), &two(1.0, 2.0)), Likeness::Other);
        assert_eq!(likeness(Some(&two(0.02, 1.0)), &two(0.0, 1.0)), Likeness::Alike, "not dark");
        assert_eq!(likeness(Some(&failing("lost")), &failing("lost")), Likeness::Unsized);
        let index = |number: u32| failing(&format!("shape 1 has no primitive {number}"));
        assert_eq!(likeness(Some(&index(7)), &index(7)), Likeness::Same);
        assert_eq!(likeness(Some(&index(7)), &index(8)), Likeness::Unsized);
        let infinite = || failing("inf").because(&contract::INFINITE, "inf");
        let not_a_number = failing("NaN").because(&contract::NOT_A_NUMBER, "NaN");
        assert_eq!(likeness(Some(&infinite()), &infinite()), Likeness::Same);
        assert_eq!(likeness(Some(&infinite()), &not_a_number), Likeness::Unsized);
        assert_eq!(likeness(None, &passing()), Likeness::Other);
        assert_eq!(likeness(Some(&two(0.0, 1.0)), &two(0.0, 1.0)), Likeness::Unsized, "darkness");
        let albedo = |left| means(vec![Measure::exact("albedo", left, 0.877, 1e-6)]);
        assert_eq!(likeness(Some(&albedo(0.0376)), &albedo(0.0332)), Likeness::Alike);
        assert_eq!(likeness(Some(&albedo(0.0376)), &albedo(0.0370)), Likeness::Same);
        assert_eq!(likeness(Some(&two(0.0, 1.0)), &two(1.0, 1.0)), Likeness::Other);
    }
}
