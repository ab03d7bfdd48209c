//! Shares of yes-or-no samples: exact binomial tails, in three stages ([`Escalation`]).
//!
//! For samples that the harness draws itself, one by one, through a core's `sample` functions: the
//! share of reflections of glass, the share of samples accepted. The law is then binomial for every
//! core, so no variance has to be estimated and no limit theorem believed.

use crate::stats::law::{binomial_at_least, binomial_at_most, normal_upper, share_interval};
use crate::stats::plan::level::{MISS_LEVEL, STAGE_LEVEL};
use crate::stats::plan::{
    Band, Claim, Effort, Escalation, Judgement, Report, Scored, Stage, TestKind, Verdict,
};

/// Samples of the smallest first stage.
const FEWEST_SAMPLES: f64 = 1000.0;

/// One stage of counting hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShareStage {
    pub(crate) stage: Stage,
    pub(crate) trials: u64,
    /// Those that were "yes".
    pub(crate) hits: u64,
    /// The smaller tail, were the share at the near end of its band.
    pub(crate) p_value: f64,
    /// How far outside the band the share is, in the standard errors of what should be or of what is, the larger.
    pub(crate) sigmas: f64,
    /// Whether that is too small, on the side the first stage chose.
    pub(crate) rejects: bool,
}

impl Scored for ShareStage {
    fn rejects(&self) -> bool {
        self.rejects
    }

    fn samples(&self) -> u64 {
        self.trials
    }

    fn excess(&self) -> f64 {
        (self.sigmas / sigmas()).powi(2)
    }
}

/// The judgement of a share. Its interval is that of the largest stage, the last of equals.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShareReport {
    pub(crate) verdict: Verdict,
    pub(crate) expected: f64,
    pub(crate) share: f64,
    /// Holds the share of the core with 99.9 % confidence.
    pub(crate) interval: [f64; 2],
    pub(crate) stages: Escalation<ShareStage>,
    pub(crate) resolution: f64,
}

impl Report for ShareReport {
    fn judgement(&self) -> Judgement {
        Judgement {
            interval: Some(self.interval),
            smallest_detectable_error: Some(self.resolution),
            hypothesis: Some(self.stages.hypothesis(TestKind::Share)),
            p_value: self.stages.first().and_then(|first| p_value(first, self.expected)),
            ..Judgement::new(self.verdict, self.share, self.expected)
        }
    }
}

/// Judges whether `draw`, asked for a number of samples, answers "yes" with probability `expected`.
/// Shares of exactly 0 or 1 have no chance in them: one sample on the wrong side fails.
pub(crate) fn judge_share<E>(
    expected: f64,
    band: Band,
    effort: &Effort,
    draw: &mut dyn FnMut(Stage, u64) -> Result<u64, E>,
) -> Result<ShareReport, E> {
    let claim = Claim::value(expected, band);
    let first = planned_samples(&claim, effort.detects).min(effort.most_samples as f64) as u64;
    let mut stages: Escalation<ShareStage> = Escalation::default();
    while let Some(stage) = stages.next() {
        let trials = match stages.first() {
            Some(_) => stages.confirming(stage).max(FEWEST_SAMPLES).ceil() as u64,
            None => first,
        };
        let hits = draw(stage, trials)?;
        let suspected_high = stages.first().map(|first| is_high(first, expected));
        stages.push(score(&claim, stage, [hits, trials], suspected_high));
    }
    Ok(report(&claim, effort, stages))
}

fn is_high(stage: &ShareStage, expected: f64) -> bool {
    stage.hits as f64 > expected * stage.trials as f64
}

fn score(
    claim: &Claim,
    stage: Stage,
    [hits, trials]: [u64; 2],
    suspected_high: Option<bool>,
) -> ShareStage {
    let (expected, width) = (claim.expected, claim.band_width());
    let too_high = binomial_at_least(hits, trials, (expected + width).min(1.0));
    let too_low = binomial_at_most(hits, trials, (expected - width).max(0.0));
    let p_value = match suspected_high {
        Some(true) => too_high,
        Some(false) => too_low,
        None => too_high.min(too_low),
    };
    let share = hits as f64 / trials as f64;
    let variance = (share * (1.0 - share)).max(expected * (1.0 - expected));
    let departure = claim.departure(share).abs();
    // Shares of 0 and 1 have no noise; the cap is beyond all others.
    let sigmas = (departure / (variance / trials as f64).sqrt()).min(1e9);
    ShareStage { stage, trials, hits, p_value, sigmas, rejects: p_value < STAGE_LEVEL }
}

/// Two-sided, half of what is just as likely counted; none of what is certain.
fn p_value(stage: &ShareStage, expected: f64) -> Option<f64> {
    let ShareStage { hits, trials, .. } = *stage;
    let at_least =
        |hits| if hits > trials { 0.0 } else { binomial_at_least(hits, trials, expected) };
    let above = 0.5 * (at_least(hits) + at_least(hits + 1));
    (0.0 < expected && expected < 1.0).then_some(2.0 * above.min(1.0 - above))
}

/// Standard errors between the band and an error that is seen.
fn sigmas() -> f64 {
    normal_upper(STAGE_LEVEL) + normal_upper(MISS_LEVEL)
}

/// Samples of the first stage that see a relative error of `detects`, on the side where the share
/// varies more.
fn planned_samples(claim: &Claim, detects: f64) -> f64 {
    let expected = claim.expected;
    let wrong = (expected * (1.0 + detects)).min(0.5f64.max(expected));
    let variance = (wrong * (1.0 - wrong)).max(expected * (1.0 - expected));
    let room = (detects - claim.band.relative()) * expected;
    let needed = if room > 0.0 { (sigmas() / room).powi(2) * variance } else { f64::INFINITY };
    needed.max(FEWEST_SAMPLES).ceil()
}

fn report(claim: &Claim, effort: &Effort, stages: Escalation<ShareStage>) -> ShareReport {
    let expected = claim.expected;
    let (first, largest) = (stages[0], *stages.largest().unwrap_or(&stages[0]));
    let deviation = (expected * (1.0 - expected) / first.trials as f64).sqrt();
    let resolution = claim.band.relative() + sigmas() * deviation / expected;
    ShareReport {
        verdict: Verdict::of_test(stages.rejects(), resolution <= effort.detects),
        expected,
        share: largest.hits as f64 / largest.trials as f64,
        interval: share_interval(largest.hits, largest.trials, STAGE_LEVEL),
        resolution,
        stages,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};
    use std::convert::Infallible;

    fn judge(truth: f64, expected: f64, detects: f64) -> ShareReport {
        let mut draw = |stage: Stage, trials: u64| {
            let mut stream = Seed(8).child(stage).stream();
            let hits = (0..trials).filter(|_| uniform(&mut stream) < truth).count();
            Ok::<_, Infallible>(hits as u64)
        };
        let Ok(report) = judge_share(expected, Band::NONE, &Effort::new(detects), &mut draw);
        report
    }

    #[test]
    fn the_right_share_passes_and_a_share_off_by_the_promise_fails() {
        let fresnel_at_60_degrees = 0.089_186_7;
        let right = judge(fresnel_at_60_degrees, fresnel_at_60_degrees, 0.03);
        assert_eq!(right.verdict, Verdict::Pass);
        assert!(right.resolution <= 0.03);
        for gain in [0.97, 1.03] {
            let wrong = judge(gain * fresnel_at_60_degrees, fresnel_at_60_degrees, 0.03);
            assert_eq!(wrong.verdict, Verdict::Fail);
            assert!(wrong.interval[0] < wrong.share && wrong.share < wrong.interval[1]);
        }
    }

    #[test]
    fn one_lost_sample_in_a_thousand_is_seen_where_none_may_be_lost() {
        assert_eq!(judge(1.0, 1.0, 0.01).verdict, Verdict::Pass);
        assert_eq!(judge(0.99, 1.0, 0.01).verdict, Verdict::Fail);
    }

    #[test]
    fn p_values_of_a_right_share_are_uniform() {
        let mut stream = Seed(31).stream();
        let p_values: Vec<_> = (0..2000)
            .map(|_| {
                let hits = (0..1000).filter(|_| uniform(&mut stream) < 0.3).count() as u64;
                let claim = Claim::share(0.3, Band::NONE);
                p_value(&score(&claim, Stage::First, [hits, 1000], None), 0.3).unwrap()
            })
            .collect();
        for level in [0.01, 0.1, 0.5, 0.9] {
            let below = p_values.iter().filter(|p| **p < level).count() as f64 / 2000.0;
            let deviation = (level * (1.0 - level) / 2000.0_f64).sqrt();
            // A share of 1000 has steps of a few per cent in p.
            assert!(
                (below - level).abs() < 4.0 * deviation + 0.03 * level,
                "{below} below {level}"
            );
        }
        assert_eq!(
            p_value(&score(&Claim::share(0.3, Band::NONE), Stage::First, [9, 9], None), 1.0),
            None
        );
    }
}
