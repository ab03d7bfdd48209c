//! One kind of random stream, put to one core, against the exact law of the stopping rule.

use super::rule::{Rule, Sums, WRONG_RULES};
use crate::cause::{Cause, adaptive};
use crate::checks::phrase::{figure, percent};
use crate::checks::series::{OneLine, Series, StopCounts};
use crate::checks::{CheckError, Measure, Result};
use crate::contract::{AdaptiveMean, AdaptiveSettings, Core, Precision};
use crate::math::rng::{Seed, uniform};
use crate::stats::{
    Band, CellProbabilities, Claim, CountReport, Counts, Effort, MeanReport, StoppingLaw,
    TwoValues, Verdict, follows_law, judge_counts, judge_means,
};
use crate::text::Percent;
use serde::Deserialize;

/// Streams handed over in one call.
const BATCH: u64 = 256;

/// What is rarer and did not come is not drawn.
const SELDOM: f64 = 1e-4;

/// Roundings that both sides of the rule may have been through.
const ROUNDINGS: f64 = 16.0;

/// Independent samples that are either low or high, and the settings they are watched with.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct StreamEntry {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Of being high.
    chance: Percent,
    pub(super) batch: u32,
    pub(super) tolerance: Percent,
    pub(super) cap: u32,
}

impl StreamEntry {
    pub(super) fn validate(&self) -> Result<(), String> {
        let is_sound = self.batch >= 2 && self.cap >= self.batch;
        let is_random = self.low.is_finite() && self.high.is_finite() && self.low != self.high;
        match is_sound && is_random {
            true => Ok(()),
            false => Err("a stream needs two values, a batch of 2 or more \
                          and a cap not below it"
                .to_owned()),
        }
    }

    pub(super) fn values(&self) -> TwoValues {
        TwoValues { low: self.low, high: self.high, chance: self.chance.0 }
    }

    pub(super) fn settings(&self) -> AdaptiveSettings {
        AdaptiveSettings { samples_per_batch: self.batch, max_tolerance: self.tolerance.0 }
    }

    /// The law of a rule whose tolerance is a little off.
    pub(super) fn law(&self, rule: Rule, batch: u32, slack: f64) -> StoppingLaw {
        let tolerance = self.tolerance.0 * (1.0 + slack);
        StoppingLaw::new(self.values(), batch as usize, self.cap as usize, |n, highs| {
            n > 1 && rule.stops(&Sums::of_two_values(n, highs, self.low, self.high), tolerance)
        })
    }

    /// How often which count should come. Where rounding decides, either may be right.
    fn cells(&self, rule: Rule, batch: u32, precision: Precision) -> CellProbabilities {
        let slack = ROUNDINGS * precision.epsilon();
        self.law(rule, batch, slack).cells(&self.law(rule, batch, -slack))
    }

    /// The mistakes whose law the counts follow.
    pub(super) fn explanations(
        &self,
        report: &CountReport,
        precision: Precision,
    ) -> Vec<&'static Cause> {
        let counts = Counts { cells: report.observed.clone(), absorbed: report.absorbed_observed };
        let wrong = WRONG_RULES.iter().map(|(cause, made)| (*cause, made(Rule::RIGHT), self.batch));
        let too_often = (&adaptive::LOOKS_AFTER_EVERY_SAMPLE, Rule::RIGHT, 1);
        wrong
            .chain([too_often])
            .filter(|(_, rule, batch)| follows_law(&self.cells(*rule, *batch, precision), &counts))
            .map(|(cause, ..)| cause)
            .collect()
    }

    pub(super) fn name(&self) -> String {
        let Self { low, high, .. } = self;
        format!("{low} or {high} with {}", percent(self.chance.0))
    }
}

/// One kind of stream, put to one core.
pub(super) struct Trial<'a> {
    pub(super) core: &'a mut dyn Core,
    pub(super) entry: &'a StreamEntry,
    pub(super) precision: Precision,
    pub(super) seed: Seed,
}

/// What came of one kind of stream.
pub(super) struct Judged {
    pub(super) name: String,
    pub(super) law: StoppingLaw,
    pub(super) truth: f64,
    pub(super) counts: CountReport,
    pub(super) mean: MeanReport,
    /// The mistakes whose law the counts follow.
    pub(super) causes: Vec<&'static Cause>,
}

impl Trial<'_> {
    pub(super) fn judge(&mut self, of_counts: &Effort, of_mean: &Effort) -> Result<Judged> {
        let law = self.entry.law(Rule::RIGHT, self.entry.batch, 0.0);
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
    fn judge_counts(&mut self, effort: &Effort) -> Result<CountReport> {
        let expected = self.entry.cells(Rule::RIGHT, self.entry.batch, self.precision);
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
    pub(super) fn answers(
        &mut self,
        seed: Seed,
        count: u64,
        take: &mut dyn FnMut(&AdaptiveMean),
    ) -> Result<()> {
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

impl Judged {
    pub(super) fn measures(&self) -> [Measure; 2] {
        let counts = Measure {
            measured: self.mean_count(),
            expected: self.law.expected_count(),
            allowed: 0.0,
            ..Measure::of("samples used", &self.counts)
        };
        [counts, Measure::of("mean returned", &self.mean)].map(|m| m.of_row(&self.name))
    }

    /// How many streams stopped where.
    pub(super) fn series(&self) -> Series {
        let CountReport { observed, expected, .. } = &self.counts;
        let total: f64 = expected.iter().sum();
        let is_there = |n: &usize| observed[*n] > 0 || expected[*n] > SELDOM * total;
        let shown = || (0..observed.len()).filter(is_there);
        Series::Stops(StopCounts {
            of: self.name.clone(),
            samples: shown().map(|n| n as u64).collect(),
            observed: shown().map(|n| observed[n]).collect(),
            expected: OneLine::rounded(shown().map(|n| expected[n])),
            rejected: self.counts.rejected_cells().into_iter().map(|n| n as u64).collect(),
        })
    }

    /// Samples used on average, in the last stage drawn; beyond the maximum, one more than that.
    fn mean_count(&self) -> f64 {
        let CountReport { observed, absorbed_observed: beyond, .. } = &self.counts;
        let all = || observed.iter().chain([beyond]);
        let sum: f64 = (0..).zip(all()).map(|(n, streams)| f64::from(n) * *streams as f64).sum();
        sum / all().sum::<u64>() as f64
    }

    /// What the numbers of samples are that the streams of the last stage told, and what they should be.
    fn told_of_counts(&self) -> String {
        let CountReport { observed, absorbed_observed: beyond, .. } = &self.counts;
        if *beyond > 0 {
            let (all, most) = (observed.iter().sum::<u64>() + beyond, observed.len() - 1);
            return format!(
                "{beyond} of {all} streams tell more than the maximum of {most} samples"
            );
        }
        let (is, should) = (figure(self.mean_count()), figure(self.law.expected_count()));
        format!("{is} samples are used on average where the rule uses {should}")
    }

    /// Whether the mean is so far from the truth that a stream that is read to its end has another.
    pub(super) fn is_biased_by_the_rule(&self) -> bool {
        let [low, high] = self.mean.interval;
        self.truth < low || self.truth > high
    }

    pub(super) fn complaint(&self) -> Option<String> {
        let (name, law) = (&self.name, &self.law);
        if self.counts.verdict == Verdict::Fail {
            return Some(format!("{name}: {}", self.told_of_counts()));
        }
        (self.mean.verdict == Verdict::Fail).then(|| {
            let (is, should) = (figure(self.mean.mean), figure(law.mean));
            let by = percent(self.mean.mean / law.mean - 1.0);
            format!("{name}: stops rightly, with a mean of {is} instead of {should}, off by {by}")
        })
    }
}
