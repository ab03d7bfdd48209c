//! The stopping rule on random streams: how often it stops where, and with what mean.
//!
//! An adaptive mean is biased by construction, so it is held to its own expectation ([`crate::stats::StoppingLaw`]), never to
//! the true mean.

use super::random_stream::{Judged, StreamEntry, Trial};
use crate::cause::adaptive;
use crate::checks::phrase::percent;
use crate::checks::{Check, Context, Finding, Result, check};
use crate::stats::Verdict;
use crate::text::{Count, Percent, Several};

check! {
    pub(crate) struct StopsByItsLaw {
        /// The smallest error of the law of the counts that must be seen, root mean square.
        detects: Percent,
        /// The smallest error of the mean that must be seen.
        mean_detects: Percent,
        at_most: Count,
        stream: Several<StreamEntry>,
    }
    name: "stops-by-its-law",
    summary: "the adaptive stopping rule on random streams: counts and means",
    needs: ADAPTIVE_MEAN,
}

impl Check for StopsByItsLaw {
    fn validate(&self) -> Result<(), String> {
        self.stream.iter().try_for_each(StreamEntry::validate)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let precision = context.info.precision;
        let effort = |detects: Percent| context.effort(detects, self.at_most);
        let (of_counts, of_mean) = (effort(self.detects), effort(self.mean_detects));
        let mut judged = Vec::new();
        for (number, entry) in self.stream.iter().enumerate() {
            let seed = context.seed.child(number);
            let mut trial = Trial { core: &mut *context.core, entry, precision, seed };
            judged.push(trial.judge(&of_counts, &of_mean)?);
        }
        Ok(finding(&judged))
    }
}

fn finding(judged: &[Judged]) -> Finding {
    let measures = judged.iter().flat_map(Judged::measures);
    let finding = Finding::measured(passing_statement(judged), measures)
        .complaining(judged.iter().filter_map(Judged::complaint))
        .showing(judged.iter().map(Judged::series));
    let failed = || judged.iter().filter(|one| one.counts.verdict == Verdict::Fail);
    let Some(first) = failed().next() else { return finding };
    let common = first.causes.iter().filter(|cause| failed().all(|one| one.causes.contains(cause)));
    let evidence = format!("its law fits where {} kinds of random streams stop", failed().count());
    let means_know_better = judged.iter().all(|one| one.mean.verdict == Verdict::Pass)
        && judged.iter().any(Judged::is_biased_by_the_rule);
    if means_know_better && common.clone().any(|cause| *cause == &adaptive::NEVER_STOPS) {
        let evidence = "every count is the cap, and the means are biased as the rule biases them";
        return finding.because(&adaptive::COUNTS_ARE_CAP, evidence);
    }
    finding.because_each(common.copied(), &evidence)
}

fn passing_statement(judged: &[Judged]) -> String {
    let bias = |one: &Judged| one.law.mean / one.truth - 1.0;
    let largest =
        judged.iter().map(bias).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let way = if largest < 0.0 { "dark" } else { "bright" };
    format!(
        "{} kinds of random streams stop by the law of the rule, which by itself makes means up to {} too {way}",
        judged.len(),
        percent(largest.abs()),
    )
}

#[cfg(test)]
mod tests {
    use super::super::rule::{Rule, Sums, WRONG_RULES};
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::series::Series;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, judge};
    use crate::contract::{AdaptiveMean, AdaptiveSettings};

    const CASE: &str =
        include_str!("../../../cases/adaptive/stop-counts-follow-their-distribution.toml");

    /// Stops by a rule that it asks every so many samples, and multiplies what it says.
    struct Stopping {
        rule: Rule,
        every: Option<u32>,
        gain: f64,
        /// Whatever was used.
        says_cap: bool,
    }

    impl Stopping {
        fn mean(&self, settings: AdaptiveSettings, stream: &[f64]) -> AdaptiveMean {
            let step = self.every.unwrap_or(settings.samples_per_batch) as usize;
            let high = stream.iter().copied().fold(f64::NAN, f64::max);
            let low = stream.iter().copied().fold(f64::NAN, f64::min);
            let (mut used, mut highs) = (0, 0);
            while used < stream.len() {
                let next = stream.len().min(used + step);
                highs += stream[used..next].iter().filter(|x| **x == high).count();
                used = next;
                let sums = Sums::of_two_values(used, highs, low, high);
                if used > 1 && self.rule.stops(&sums, settings.max_tolerance) {
                    break;
                }
            }
            let sums = Sums::of_two_values(used, highs, low, high);
            let used = if self.says_cap { stream.len() } else { used };
            let used = u32::try_from(used).unwrap();
            AdaptiveMean { mean: self.gain * sums.mean(), used, reserved: 0 }
        }
    }

    const RIGHT: Stopping = Stopping { rule: Rule::RIGHT, every: None, gain: 1.0, says_cap: false };

    /// Streams that stop early cost little: the third kind of the case.
    fn found(stopping: Stopping) -> Finding {
        let mut check = check_of::<StopsByItsLaw>(CASE);
        check.stream = vec![check.stream[2].clone()].try_into().unwrap();
        found_by(&check, stopping)
    }

    fn found_by(check: &StopsByItsLaw, stopping: Stopping) -> Finding {
        let mean = Box::new(move |settings, stream: &[f64]| stopping.mean(settings, stream));
        judge(check, &mut Fake { mean, ..Fake::default() })
    }

    #[test]
    fn the_rule_itself_passes() {
        let finding = found_by(&check_of(CASE), RIGHT);
        assert_passes(&finding);
        for series in &finding.series {
            let Series::Stops(counts) = series else { panic!("{series:?}") };
            let [observed, expected] =
                [counts.observed.iter().sum::<u64>() as f64, counts.expected.iter().sum()];
            assert!(
                (observed / expected - 1.0).abs() < 1e-3 && counts.rejected.is_empty(),
                "{counts:?}"
            );
        }
    }

    #[test]
    fn every_wrong_rule_is_named() {
        for (cause, made) in WRONG_RULES {
            let finding = found(Stopping { rule: made(Rule::RIGHT), ..RIGHT });
            assert_eq!(causes(&finding), [cause.name], "{finding:?}");
        }
    }

    #[test]
    fn looking_after_every_sample_is_named() {
        let finding = found(Stopping { every: Some(1), ..RIGHT });
        assert!(failure(&finding).contains("on average where the rule uses 37.7"), "{finding:?}");
        assert_eq!(finding.clues[0].cause, adaptive::LOOKS_AFTER_EVERY_SAMPLE.name);
    }

    #[test]
    fn counts_that_are_the_cap_beside_right_means_are_named() {
        let finding = found_by(&check_of(CASE), Stopping { says_cap: true, ..RIGHT });
        assert_eq!(causes(&finding), [adaptive::COUNTS_ARE_CAP.name]);
    }

    #[test]
    fn a_mean_that_is_a_hundredth_off_is_seen() {
        let finding = found(Stopping { gain: 1.01, ..RIGHT });
        assert!(failure(&finding).contains("stops rightly, with a mean of"), "{finding:?}");
    }
}
