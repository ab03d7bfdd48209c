//! The test of means on cores that are right, wrong and odd.

use super::*;
use crate::math::rng::{Stream, uniform};
use crate::stats::{Band, Verdict};
use std::convert::Infallible;

/// Runs of a core whose samples are `gain` times `sample(stream)`.
pub(super) fn runs(
    seed: Seed,
    gain: f64,
    sample: impl Fn(&mut Stream) -> f64,
) -> impl FnMut(Draw) -> Result<Vec<f64>, Infallible> {
    move |draw| {
        let mut stream = draw.seed(seed).stream();
        let sum: f64 = (0..draw.samples).map(|_| sample(&mut stream)).sum();
        Ok(vec![gain * sum / draw.samples as f64])
    }
}

/// A core whose samples are `sample(stream)`, judged on one claim.
fn judge(
    claim: Claim,
    effort: &Effort,
    seed: Seed,
    sample: impl Fn(&mut Stream) -> f64,
) -> MeanReport {
    let Ok(mut reports) = judge_means(&[claim], effort, &mut runs(seed, 1.0, sample));
    reports.remove(0)
}

/// The same on a claim of radiance, with the usual effort.
fn judged(expected: f64, sample: impl Fn(&mut Stream) -> f64) -> MeanReport {
    judge(Claim::value(expected, Band::RADIANCE), &Effort::new(0.02), SEED, sample)
}

fn exponential(mean: f64) -> impl Fn(&mut Stream) -> f64 {
    move |stream| -mean * (1.0 - uniform(stream)).ln()
}

const SEED: Seed = Seed(2026);

#[test]
fn a_right_core_passes_and_the_pass_says_what_it_would_have_seen() {
    let report = judged(1.0, exponential(1.0));
    assert_eq!(report.verdict, Verdict::Pass);
    assert!(report.resolution <= 0.02, "{report:?}");
    assert!(report.resolution > 0.01, "more samples than were needed: {report:?}");
    assert!(report.interval[0] < 1.0 && 1.0 < report.interval[1]);
}

#[test]
fn an_error_of_the_promised_size_fails_on_either_side() {
    for wrong in [0.98, 1.02] {
        let report = judged(1.0, exponential(wrong));
        assert_eq!(report.verdict, Verdict::Fail, "{wrong}");
        assert_eq!(report.stages.len(), 3);
        assert!(report.stages.iter().all(|stage| stage.rejects));
    }
}

#[test]
fn noise_that_could_hide_the_error_is_inconclusive() {
    let effort = Effort::new(0.02).with_most_samples(10_000);
    let report = judge(Claim::value(1.0, Band::RADIANCE), &effort, SEED, exponential(1.0));
    assert_eq!(report.verdict, Verdict::Inconclusive);
}

#[test]
fn a_constant_needs_hardly_any_samples() {
    let report =
        judge(Claim::value(0.5, Band::DOUBLE_MATH), &Effort::new(0.02), SEED, |_| 0.5 + 1e-9);
    assert_eq!(report.verdict, Verdict::Pass);
    assert!(report.samples < 10_000, "{report:?}");
    assert_eq!(judged(0.5, |_| 0.51).verdict, Verdict::Fail);
}

#[test]
fn a_black_core_fails_and_so_does_one_nan() {
    let black = judged(0.2, |_| 0.0);
    assert_eq!((black.verdict, black.ratio), (Verdict::Fail, Some([0.0, 0.0])));
    let nan_once = judged(1.0, |stream| if uniform(stream) < 1e-3 { f64::NAN } else { 1.0 });
    assert_eq!(nan_once.verdict, Verdict::Fail);
}

#[test]
fn a_light_hit_once_in_ten_thousand_samples_is_not_taken_for_darkness() {
    let rare = |stream: &mut Stream| if uniform(stream) < 1e-4 { 1e4 } else { 0.0 };
    for seed in 0..40 {
        let effort = Effort::new(0.5).with_most_samples(20_000);
        let report = judge(Claim::value(1.0, Band::RADIANCE), &effort, Seed(seed), rare);
        assert_ne!(report.verdict, Verdict::Fail, "{report:?}");
    }
}

/// Samples that are 10 once in ten, more often or less.
fn light(share: f64) -> impl Fn(&mut Stream) -> f64 {
    move |stream| if uniform(stream) < share { 10.0 } else { 0.0 }
}

fn hasty() -> Effort {
    Effort { coarse_first: true, in_a_hurry: true, ..Effort::new(0.02) }
}

#[test]
fn gross_errors_on_either_side_take_half_the_samples_where_that_is_wanted() {
    let claim = Claim::value(1.0, Band::RADIANCE);
    for share in [0.03, 0.3] {
        let hasty = judge(claim, &hasty(), SEED, light(share));
        let thorough = judged(1.0, light(share));
        assert_eq!([hasty.verdict, thorough.verdict], [Verdict::Fail; 2], "{share}");
        assert!(2 * hasty.samples < thorough.samples, "{share}: {hasty:?}");
        assert!(hasty.false_alarm > thorough.false_alarm);
    }
}

#[test]
fn beside_a_failure_darkness_takes_a_quarter_of_the_samples_and_a_right_core_as_many_as_ever() {
    let claim = Claim::value(1.0, Band::RADIANCE);
    let effort = Effort::new(0.02);
    let judged = |share: f64, effort| judge(claim, &effort, SEED, light(share));
    let both = |share: f64| [effort, effort.beside_a_failure()].map(|e| judged(share, e));
    let [thorough, beside] = both(0.0);
    assert_eq!([thorough.verdict, beside.verdict], [Verdict::Fail; 2]);
    assert!(4 * beside.samples < thorough.samples, "{beside:?}, {thorough:?}");
    assert_eq!(beside.false_alarm, thorough.false_alarm);
    let [thorough, beside] = both(0.1);
    assert_eq!((thorough.verdict, thorough.samples), (Verdict::Pass, beside.samples));
}

#[test]
fn a_core_without_gross_errors_is_judged_as_ever() {
    for share in [0.1, 0.103] {
        let claim = Claim::value(1.0, Band::RADIANCE);
        let hasty = judge(claim, &hasty(), SEED, light(share));
        let thorough = judged(1.0, light(share));
        assert_eq!((hasty.verdict, hasty.interval), (thorough.verdict, thorough.interval));
    }
}

#[test]
fn a_gross_error_in_one_claim_passes_no_other() {
    let claims = [1.0, 1.0].map(|mean| Claim::value(mean, Band::RADIANCE));
    let mut draw = |_: Draw| Ok::<_, Infallible>(vec![1.0, 3.0]);
    let Ok(reports) = judge_means(&claims, &hasty(), &mut draw);
    let verdicts = reports.iter().map(|report| report.verdict).collect::<Vec<_>>();
    assert_eq!(verdicts, [Verdict::Inconclusive, Verdict::Fail]);
}

#[test]
fn stratified_runs_pass_although_their_spread_is_far_below_the_theory_of_independent_samples() {
    let claim = Claim::value(0.5, Band::RADIANCE).with_null_deviation(12f64.sqrt().recip());
    let mut draw = |draw: Draw| {
        let mut stream = draw.seed(SEED).stream();
        let n = draw.samples as f64;
        let strata = (0..draw.samples).map(|i| (i as f64 + uniform(&mut stream)) / n);
        Ok::<_, Infallible>(vec![strata.sum::<f64>() / n])
    };
    let Ok(reports) = judge_means(&[claim], &Effort::new(0.02), &mut draw);
    assert_eq!(reports[0].verdict, Verdict::Pass);
}

#[test]
fn claims_on_the_same_runs_are_judged_apart() {
    let claims = [0.37, 0.53, 0.71].map(|albedo| Claim::value(albedo, Band::RADIANCE));
    let mut draw = |draw: Draw| {
        let mut stream = draw.seed(SEED).stream();
        let mean = (0..draw.samples).map(|_| 2.0 * uniform(&mut stream)).sum::<f64>()
            / draw.samples as f64;
        Ok::<_, Infallible>(vec![0.37 * mean, 0.56 * mean, 0.71 * mean])
    };
    let Ok(reports) = judge_means(&claims, &Effort::new(0.02), &mut draw);
    let verdicts = reports.iter().map(|report| report.verdict).collect::<Vec<_>>();
    assert_eq!(verdicts, [Verdict::Pass, Verdict::Fail, Verdict::Pass]);
}

#[test]
fn the_error_of_a_core_is_passed_on() {
    let mut draw = |_: Draw| Err::<Vec<f64>, _>("out of memory");
    let answer = judge_means(&[Claim::value(1.0, Band::NONE)], &Effort::new(0.02), &mut draw);
    assert_eq!(answer.unwrap_err(), "out of memory");
}

#[test]
fn every_run_has_its_own_seed() {
    let at = |stage, attempt, run| Draw { stage, attempt, run, samples: 1 }.seed(SEED);
    let mut seeds = Vec::new();
    for stage in [Stage::Pilot, Stage::First, Stage::Second, Stage::Third] {
        for attempt in 0..2 {
            seeds.extend((0..64).map(|run| at(stage, attempt, run).0));
        }
    }
    seeds.sort_unstable();
    seeds.dedup();
    assert_eq!(seeds.len(), 512);
}
