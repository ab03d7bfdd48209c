//! The factor by which most failures of light are off: where there is no cause yet, it says by how much.
//! `light is 0.25 times what it should be in 28 of 36 failures`

use super::Observation;
use super::readings::Reading;
use crate::case::Subject;
use crate::checks::Finding;
use crate::text::number::figure;

/// Failures that have to agree on it.
const FEWEST: usize = 3;
/// How well it has to be known, as a share of it: numbers that are known badly agree on anything.
const UNCERTAIN: f64 = 0.02;

/// What most failures agree on.
#[derive(Debug, PartialEq)]
pub(super) struct Factor {
    /// Holds it.
    interval: [f64; 2],
    fitting: usize,
    failing: usize,
}

impl Factor {
    /// Of failures of light, but for images.
    pub(super) fn of<'o, 'a: 'o>(
        failing: impl Iterator<Item = &'o Observation<'a>>,
    ) -> Option<Self> {
        let of_light =
            |seen: &&Observation<'_>| seen.is_about_light() && !seen.is_about(Subject::Image);
        let all: Vec<_> =
            failing.filter(of_light).map(|seen| seen.finding.and_then(of_one)).collect();
        let known: Vec<_> = all.iter().copied().flatten().collect();
        let at = |ratio: f64| {
            known.iter().copied().filter(move |[low, high]| *low <= ratio && ratio <= *high)
        };
        // What most have in common begins where one of them does.
        let begins = known.iter().map(|[low, _]| *low).max_by_key(|low| at(*low).count())?;
        let interval = at(begins).reduce(common)?;
        let (fitting, failing) = (at(begins).count(), all.len());
        let is_known = interval[1] - interval[0] <= UNCERTAIN * interval[0];
        let is_told = fitting >= FEWEST && 2 * fitting > failing && is_known;
        is_told.then_some(Self { interval, fitting, failing })
    }

    pub(super) fn in_words(&self) -> String {
        let Self { interval: [low, high], fitting, failing } = *self;
        let factor = figure(0.5 * (low + high));
        let failures = match fitting == failing {
            true => format!("all {failing} failures"),
            false => format!("{fitting} of {failing} failures"),
        };
        format!("light is {factor} times what it should be in {failures}")
    }
}

/// What two intervals have in common; the ends are exchanged where that is nothing.
fn common([low, high]: [f64; 2], [from, to]: [f64; 2]) -> [f64; 2] {
    [low.max(from), high.min(to)]
}

/// What all that failed of one case agrees on; none where it is dark.
fn of_one(finding: &Finding) -> Option<[f64; 2]> {
    let wrong = finding.failed_measures().map(|measure| Some(Reading::of(measure)?.interval));
    let [low, high] = wrong.collect::<Option<Vec<_>>>()?.into_iter().reduce(common)?;
    let is_one = low <= 1.0 && 1.0 <= high;
    (0.0 < low && low <= high && !is_one).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::testing::{Made, mean, means};
    use crate::image::Channel;

    /// Cases of light with these ratios, each known within a thousandth.
    fn factor(ratios: &[f64]) -> Option<String> {
        let mut made = Made::new();
        for (number, ratio) in ratios.iter().enumerate() {
            let seen = means(vec![mean("bounce 1", Channel::Red, 0.5, *ratio, 0.0005)]);
            made = made.with(&format!("light/{number}")[..], seen);
        }
        let evidence = made.evidence();
        Some(Factor::of(evidence.failures())?.in_words())
    }

    #[test]
    fn what_most_failures_agree_on_is_told() {
        let told = factor(&[0.25, 0.2503, 0.2498, 0.5, 0.29]);
        assert_eq!(
            told.as_deref(),
            Some("light is 0.25 times what it should be in 3 of 5 failures")
        );
        let told = factor(&[1.5, 1.5, 1.5]);
        assert_eq!(told.as_deref(), Some("light is 1.5 times what it should be in all 3 failures"));
    }

    #[test]
    fn few_and_those_that_disagree_or_are_dark_have_none() {
        assert_eq!(factor(&[0.25, 0.25]), None);
        assert_eq!(factor(&[0.25, 0.25, 0.25, 0.5, 0.6, 0.7]), None);
        assert_eq!(factor(&[0.0, 0.0, 0.0]), None);
    }
}
