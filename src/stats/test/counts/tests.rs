//! Samplers that are right, and wrong in the ways that samplers are.

use super::*;
use crate::math::frame::direction;
use crate::math::rng::{Seed, Stream, uniform};
use crate::stats::SphereCells;
use glam::DVec3;
use std::convert::Infallible;
use std::f64::consts::{FRAC_1_PI, TAU};

fn cells() -> SphereCells {
    SphereCells::hemisphere(10, 20)
}

fn cosine() -> CellProbabilities {
    cells().probabilities_of(|d| d.z.max(0.0) * FRAC_1_PI)
}

/// Samples with cos θ = u^(1/(exponent + 1)): the cosine law at exponent 1.
fn power(stream: &mut Stream, exponent: f64) -> DVec3 {
    let z = uniform(stream).powf(1.0 / (exponent + 1.0));
    direction(z.acos(), TAU * uniform(stream))
}

fn right(stream: &mut Stream) -> Option<DVec3> {
    Some(power(stream, 1.0))
}

fn judge(
    expected: &CellProbabilities,
    detects: f64,
    sample: impl Fn(&mut Stream) -> Option<DVec3>,
) -> CountReport {
    let mut draw = |stage: Stage, samples: u64| {
        let mut stream = Seed(1).child(stage).stream();
        Ok::<_, Infallible>(cells().count((0..samples).map(|_| sample(&mut stream))))
    };
    let Ok(report) = judge_counts(expected, &Effort::new(detects), &mut draw);
    report
}

#[test]
fn a_right_sampler_passes_and_says_what_it_would_have_seen() {
    let report = judge(&cosine(), 0.03, right);
    assert_eq!(report.verdict, Verdict::Pass, "{:?}", report.stages);
    assert!(report.resolution <= 0.03 && report.resolution > 0.02);
    assert_eq!(report.stages.len(), 1);
}

#[test]
fn gross_mistakes_fail() {
    let uniform_for_cosine =
        judge(&cosine(), 0.1, |s| Some(direction(uniform(s).acos(), TAU * uniform(s))));
    let half_the_circle =
        judge(&cosine(), 0.1, |s| Some(power(s, 1.0)).map(|d| d.with_y(d.y.abs())));
    let one_number_twice = judge(&cosine(), 0.1, |s| {
        let u = uniform(s);
        Some(direction(u.sqrt().acos(), TAU * u))
    });
    for report in [uniform_for_cosine, half_the_circle, one_number_twice] {
        assert_eq!(report.verdict, Verdict::Fail, "{:?}", report.stages);
        assert_eq!(report.stages.len(), 3);
    }
}

#[test]
fn a_slightly_wrong_exponent_fails_where_it_is_promised_and_not_below() {
    // The pdf of exponent 1.05 is 1.2 % off, root mean square.
    let seen = judge(&cosine(), 0.012, |s| Some(power(s, 1.05)));
    assert_eq!(seen.verdict, Verdict::Fail);
    let unseen = judge(&cosine(), 0.1, |s| Some(power(s, 1.05)));
    assert_eq!(unseen.verdict, Verdict::Pass);
}

#[test]
fn one_sample_below_the_horizon_fails() {
    let report = judge(&cosine(), 0.1, |s| {
        let up = power(s, 1.0);
        Some(if uniform(s) < 1e-3 { -up } else { up })
    });
    assert_eq!(report.verdict, Verdict::Fail);
    assert!(report.forbidden.is_some_and(|forbidden| forbidden.cell < 20));
}

#[test]
fn failed_samples_are_right_if_the_pdf_lacks_them_and_wrong_if_not() {
    let lossy = |s: &mut Stream| (uniform(s) < 0.9).then(|| power(s, 1.0));
    let honest = cells().probabilities_of(|d| 0.9 * d.z.max(0.0) * FRAC_1_PI);
    assert_eq!(judge(&honest, 0.1, lossy).verdict, Verdict::Pass);
    assert_eq!(judge(&cosine(), 0.1, lossy).verdict, Verdict::Fail);
}

#[test]
fn a_pdf_that_is_twice_too_large_or_not_a_number_fails() {
    let doubled = cells().probabilities_of(|d| 2.0 * d.z.max(0.0) * FRAC_1_PI);
    assert_eq!(judge(&doubled, 0.1, right).verdict, Verdict::Fail);
    let mut nan = cosine();
    nan.cells[50] = f64::NAN;
    let report = judge(&nan, 0.1, right);
    assert_eq!((report.verdict, report.improper_cell), (Verdict::Fail, Some(50)));
}

#[test]
fn an_unknown_integral_is_no_ground_for_a_verdict_and_does_not_hide_a_gross_mistake() {
    let mut expected = cosine();
    expected.errors.fill(1e-4);
    let gross = judge(&expected, 0.1, |s| Some(power(s, 3.0)));
    assert_eq!(gross.verdict, Verdict::Fail);
    expected.errors.fill(1e-3);
    let report = judge(&expected, 0.1, right);
    assert_eq!(report.verdict, Verdict::Inconclusive);
    assert_eq!(report.doubt, Some(CountDoubt::QuadratureNotConverged));
}

#[test]
fn an_integral_known_roughly_takes_more_samples_to_pass() {
    let mut expected = cosine();
    let exact = judge(&expected, 0.03, right);
    expected.errors.fill(3e-6);
    let rough = judge(&expected, 0.03, right);
    assert_eq!(rough.verdict, Verdict::Pass, "{:?}", rough.doubt);
    assert!(rough.samples > exact.samples && rough.resolution <= 0.03);
}

#[test]
fn starved_cells_are_pooled_until_they_expect_enough() {
    let expected = CellProbabilities::exact(vec![0.001; 1000]);
    let pools = pools(&expected, 1000.0);
    assert!(pools.iter().all(|pool| pool.len() as f64 >= FEWEST_EXPECTED));
    // "Absorbed" is one more.
    assert_eq!(pools.iter().map(Vec::len).sum::<usize>(), 1001);
}

#[test]
fn p_values_of_a_right_sampler_are_uniform() {
    let expected = cosine();
    let mut stream = Seed(7).stream();
    let trials = 2000;
    let p_values: Vec<f64> = (0..trials)
        .map(|_| {
            let samples = (0..6000).map(|_| Some(power(&mut stream, 1.0)));
            score(Stage::First, &expected, &cells().count(samples), &[]).p_value
        })
        .collect();
    for level in [0.01, 0.05, 0.5] {
        let below = p_values.iter().filter(|p| **p < level).count() as f64;
        let deviation = (trials as f64 * level * (1.0 - level)).sqrt();
        assert!((below - trials as f64 * level).abs() < 4.0 * deviation, "{level}: {below}");
    }
}

/// A sampler whose calls have seeds of their own; the samples of a call may depend on each other.
struct Calls {
    call: fn(&mut Stream, u64) -> Vec<DVec3>,
    seed: Seed,
    batches: Vec<Counts>,
}

impl Calls {
    fn of(call: fn(&mut Stream, u64) -> Vec<DVec3>, seed: u64) -> Self {
        Self { call, seed: Seed(seed), batches: Vec::new() }
    }

    fn judged(mut self, detects: f64) -> CountReport {
        let Ok(report) = judge_count_source(&Effort::new(detects), &mut self);
        report
    }
}

impl CountSource for Calls {
    type Error = Infallible;

    fn expected(&mut self, _: Stage) -> Result<CellProbabilities, Infallible> {
        Ok(cosine())
    }

    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts, Infallible> {
        let batch = |number: u64| {
            let mut stream = self.seed.child(stage).child(number).stream();
            cells().count((self.call)(&mut stream, batch_size(samples, 32)).into_iter().map(Some))
        };
        self.batches = (0..32).map(batch).collect();
        let mut all = cells().count([]);
        self.batches.iter().for_each(|batch| all.add(batch));
        Ok(all)
    }

    fn batches(&self) -> &[Counts] {
        &self.batches
    }
}

fn independent(stream: &mut Stream, count: u64) -> Vec<DVec3> {
    (0..count).map(|_| power(stream, 1.0)).collect()
}

/// Each direction four times; the exponent says how they are distributed.
fn repeating(stream: &mut Stream, count: u64, exponent: f64) -> Vec<DVec3> {
    (0..count / 4).flat_map(|_| [power(stream, exponent); 4]).collect()
}

/// Kronecker's sequence from a random start.
fn low_discrepancy(stream: &mut Stream, count: u64) -> Vec<DVec3> {
    let [u, v] = [uniform(stream), uniform(stream)];
    let at = |start: f64, step: f64, number: u64| (start + number as f64 * step).fract();
    let point =
        |n| direction(at(u, 0.754_877_666_2, n).sqrt().acos(), TAU * at(v, 0.569_840_291, n));
    (0..count).map(point).collect()
}

#[test]
fn samples_that_depend_on_each_other_pass_if_they_follow_the_pdf() {
    let samplers: [fn(&mut Stream, u64) -> Vec<DVec3>; 3] =
        [independent, low_discrepancy, |stream, count| repeating(stream, count, 1.0)];
    for (number, sampler) in samplers.into_iter().enumerate() {
        let report = Calls::of(sampler, 2).judged(0.05);
        assert_ne!(report.verdict, Verdict::Fail, "{number}: {:?}", report.stages);
        assert_eq!(report.verdict == Verdict::Pass, number < 2, "what varies more says less");
    }
    let mut calls = Calls::of(samplers[2], 2);
    let mut fresh = |stage, samples| {
        let Ok(counts) = calls.draw(stage, samples);
        Ok::<_, Infallible>(counts)
    };
    let Ok(as_if_independent) = judge_counts(&cosine(), &Effort::new(0.05), &mut fresh);
    assert_eq!(as_if_independent.verdict, Verdict::Fail, "χ² alone does not know");
}

#[test]
fn samples_that_depend_on_each_other_fail_if_they_do_not() {
    let wrong = |stream: &mut Stream, count| repeating(stream, count, 1.3);
    assert_eq!(Calls::of(wrong, 3).judged(0.05).verdict, Verdict::Fail);
}

#[test]
fn batches_cost_independent_samples_little() {
    let known = judge(&cosine(), 0.05, right).resolution;
    let learnt = Calls::of(independent, 4).judged(0.05).resolution;
    assert!(learnt < 1.1 * known, "{learnt} in place of {known}");
}

#[test]
fn samples_that_depend_on_each_other_are_suspected_no_more_often_than_others() {
    let suspected = |seed| {
        let calls = Calls::of(|stream, count| repeating(stream, count, 1.0), seed);
        calls.judged(0.2).stages.suspects()
    };
    // 0.2 by the level of a stage; of batches alone more, but by a factor and not by powers of ten.
    assert!((0..400).filter(|seed| suspected(*seed)).count() <= 4);
}
