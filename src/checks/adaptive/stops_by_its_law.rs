//! The stopping rule on random streams: how often it stops where, and with what mean.
//!
//! An adaptive mean is biased by construction, so it is held to its own expectation ([`StoppingLaw`]), never to
//! the true mean.

use super::rule::{Rule, Sums, WRONG_RULES, stops};
use crate::cause::{Cause, adaptive};
use crate::checks::phrase::{figure, percent};
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{AdaptiveMean, AdaptiveSettings, Capabilities, Core, Precision};
use crate::math::rng::{Seed, uniform};
use crate::stats::{
    Band, CellProbabilities, Claim, CountReport, Counts, Effort, MeanReport, StoppingLaw,
    TwoValues, Verdict, follows_law, judge_counts, judge_means,
};
use crate::text::{Count, Percent, Several};
use serde::Deserialize;

/// Streams handed over in one call.
const BATCH: u64 = 256;
/// Roundings that both sides of the rule may have been through.
const ROUNDINGS: f64 = 16.0;

/// Random streams of two values stop by the exact law of the rule.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StopsByItsLaw {
    /// The smallest error of the law of the counts that must be seen, root mean square.
    detects: Percent,
    /// The smallest error of the mean that must be seen.
    mean_detects: Percent,
    /// Past this the verdict is inconclusive, never a pass.
    at_most: Count,
    stream: Several<StreamEntry>,
}

/// Independent samples that are either low or high, and the settings they are watched with.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct StreamEntry {
    low: f64,
    high: f64,
    /// Of being high.
    chance: Percent,
    batch: u32,
    tolerance: Percent,
    cap: u32,
}

impl Check for StopsByItsLaw {
    const NAME: &'static str = "stops-by-its-law";
    const SUMMARY: &'static str = "the adaptive stopping rule on random streams: counts and means";

    fn needs(&self) -> Capabilities {
        Capabilities::ADAPTIVE_MEAN
    }

    fn validate(&self) -> Result<(), String> {
        self.stream.iter().try_for_each(StreamEntry::validate)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
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

impl StreamEntry {
    fn validate(&self) -> Result<(), String> {
        let is_sound = self.batch >= 2 && self.cap >= self.batch;
        let is_random = self.low.is_finite() && self.high.is_finite() && self.low != self.high;
        match is_sound && is_random {
            true => Ok(()),
            false => Err("a stream needs two values, a batch of 2 or more \
                          and a cap not below it"
                .to_owned()),
        }
    }

    fn values(&self) -> TwoValues {
        TwoValues { low: self.low, high: self.high, chance: self.chance.0 }
    }

    fn settings(&self) -> AdaptiveSettings {
        AdaptiveSettings { samples_per_batch: self.batch, max_tolerance: self.tolerance.0 }
    }

    /// The law of a rule whose tolerance is a little off.
    fn law(&self, rule: Rule, batch: u32, slack: f64) -> StoppingLaw {
        let tolerance = self.tolerance.0 * (1.0 + slack);
        StoppingLaw::new(self.values(), batch as usize, self.cap as usize, |n, highs| {
            n > 1 && rule(&Sums::of_two_values(n, highs, self.low, self.high), tolerance)
        })
    }

    /// How often which count should come. Where rounding decides, either may be right.
    fn cells(&self, rule: Rule, batch: u32, precision: Precision) -> CellProbabilities {
        let slack = ROUNDINGS * precision.epsilon();
        self.law(rule, batch, slack).cells(&self.law(rule, batch, -slack))
    }

    /// The mistakes whose law the counts follow.
    fn explanations(&self, report: &CountReport, precision: Precision) -> Vec<&'static Cause> {
        let counts = Counts { cells: report.observed.clone(), absorbed: report.absorbed_observed };
        let wrong = WRONG_RULES.iter().map(|(cause, rule)| (*cause, *rule, self.batch));
        let too_often = (&adaptive::LOOKS_AFTER_EVERY_SAMPLE, stops as Rule, 1);
        wrong
            .chain([too_often])
            .filter(|(_, rule, batch)| follows_law(&self.cells(*rule, *batch, precision), &counts))
            .map(|(cause, ..)| cause)
            .collect()
    }

    fn name(&self) -> String {
        let Self { low, high, .. } = self;
        format!("{low} or {high} with {}", percent(self.chance.0))
    }
}

/// One kind of stream, put to one core.
struct Trial<'a> {
    core: &'a mut dyn Core,
    entry: &'a StreamEntry,
    precision: Precision,
    seed: Seed,
}

/// What came of one kind of stream.
struct Judged {
    name: String,
    law: StoppingLaw,
    truth: f64,
    counts: CountReport,
    mean: MeanReport,
    /// The mistakes whose law the counts follow.
    causes: Vec<&'static Cause>,
}

impl Trial<'_> {
    fn judge(&mut self, of_counts: &Effort, of_mean: &Effort) -> Result<Judged, CheckError> {
        let law = self.entry.law(stops, self.entry.batch, 0.0);
        let counts = self.judge_counts(of_counts)?;
        let claim = Claim::value(law.mean, Band::math(self.precision));
        let claim = claim.with_null_deviation(law.deviation);
        let seed = self.seed.child("mean");
        let means = judge_means(&[claim], of_mean, &mut |draw| {
            let mut sum = 0.0;
            self.answers(draw.seed(seed), draw.samples, &mut |answer| sum += answer.mean)?;
            Ok::<_, CheckError>(vec![sum / draw.samples as f64])
        })?;
        let causes = match counts.verdict {
            Verdict::Fail => self.entry.explanations(&counts, self.precision),
            _ => Vec::new(),
        };
        Ok(Judged {
            name: self.entry.name(),
            law,
            truth: self.entry.values().mean(),
            counts,
            mean: means[0].clone(),
            causes,
        })
    }

    /// Whether the counts follow the law of the rule.
    fn judge_counts(&mut self, effort: &Effort) -> Result<CountReport, CheckError> {
        let expected = self.entry.cells(stops, self.entry.batch, self.precision);
        let seed = self.seed.child("counts");
        judge_counts(&expected, effort, &mut |stage, samples| {
            let mut counts = Counts { cells: vec![0; expected.cells.len()], absorbed: 0 };
            self.answers(seed.child(stage), samples, &mut |answer| match counts
                .cells
                .get_mut(answer.used as usize)
            {
                Some(cell) => *cell += 1,
                None => counts.absorbed += 1,
            })?;
            Ok(counts)
        })
    }

    /// What the core makes of `count` fresh streams.
    fn answers(
        &mut self,
        seed: Seed,
        count: u64,
        take: &mut dyn FnMut(&AdaptiveMean),
    ) -> Result<(), CheckError> {
        let (cap, values) = (self.entry.cap as usize, self.entry.values());
        let mut draws = seed.stream();
        let mut samples = Vec::new();
        for first in (0..count).step_by(BATCH as usize) {
            let streams = usize::try_from(BATCH.min(count - first)).unwrap_or(usize::MAX);
            samples.clear();
            samples.extend((0..streams * cap).map(|_| {
                if uniform(&mut draws) < values.chance { values.high } else { values.low }
            }));
            let streams: Vec<&[f64]> = samples.chunks(cap).collect();
            let mut means = vec![AdaptiveMean { mean: 0.0, used: 0, reserved: 0 }; streams.len()];
            self.core.adaptive_mean(self.entry.settings(), &streams, &mut means)?;
            means.iter().for_each(&mut *take);
        }
        Ok(())
    }
}

fn finding(judged: &[Judged]) -> Finding {
    let measures = judged.iter().flat_map(Judged::measures);
    let finding = Finding::measured(passing_statement(judged), measures)
        .complaining(judged.iter().filter_map(Judged::complaint));
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

impl Judged {
    fn measures(&self) -> [Measure; 2] {
        let counts = Measure {
            measured: self.mean_count(),
            expected: self.law.expected_count(),
            allowed: 0.0,
            ..Measure::of("samples used", &self.counts)
        };
        [counts, Measure::of("mean returned", &self.mean)].map(|m| m.of_row(&self.name))
    }

    /// Samples used on average, in the last stage drawn.
    fn mean_count(&self) -> f64 {
        let counts = self.counts.observed.iter().enumerate();
        let sum: f64 = counts.map(|(n, streams)| n as f64 * *streams as f64).sum();
        sum / (self.counts.observed.iter().sum::<u64>() + self.counts.absorbed_observed) as f64
    }

    /// Whether the mean is so far from the truth that a stream that is read to its end has another.
    fn is_biased_by_the_rule(&self) -> bool {
        let [low, high] = self.mean.interval;
        self.truth < low || self.truth > high
    }

    fn complaint(&self) -> Option<String> {
        let (name, law) = (&self.name, &self.law);
        if self.counts.verdict == Verdict::Fail {
            let (is, should) = (figure(self.mean_count()), figure(law.expected_count()));
            return Some(format!(
                "{name}: {is} samples are used on average where the rule uses {should}"
            ));
        }
        (self.mean.verdict == Verdict::Fail).then(|| {
            let (is, should) = (figure(self.mean.mean), figure(law.mean));
            let by = percent(self.mean.mean / law.mean - 1.0);
            format!("{name}: stops rightly, with a mean of {is} instead of {should}, off by {by}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

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
                if used > 1 && (self.rule)(&sums, settings.max_tolerance) {
                    break;
                }
            }
            let sums = Sums::of_two_values(used, highs, low, high);
            let used = if self.says_cap { stream.len() } else { used };
            let used = u32::try_from(used).unwrap();
            AdaptiveMean { mean: self.gain * sums.mean(), used, reserved: 0 }
        }
    }

    const RIGHT: Stopping = Stopping { rule: stops, every: None, gain: 1.0, says_cap: false };

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
        assert_passes(&found_by(&check_of(CASE), RIGHT));
    }

    #[test]
    fn every_wrong_rule_is_named() {
        for (cause, rule) in WRONG_RULES {
            let finding = found(Stopping { rule: *rule, ..RIGHT });
            let (statement, clues) = (failure(&finding).to_owned(), &finding.clues);
            assert!(clues.len() == 1 && clues[0].cause == cause.name, "{statement} {clues:?}");
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
        failure(&finding);
        let clues: Vec<_> = finding.clues.iter().map(|clue| clue.cause.as_str()).collect();
        assert_eq!(clues, [adaptive::COUNTS_ARE_CAP.name]);
    }

    #[test]
    fn a_mean_that_is_a_hundredth_off_is_seen() {
        let finding = found(Stopping { gain: 1.01, ..RIGHT });
        assert!(failure(&finding).contains("stops rightly, with a mean of"), "{finding:?}");
    }
}
