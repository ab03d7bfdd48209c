//! How the error falls with the number of samples: the slope of log error on log samples, and the
//! plateau.
//!
//! Independent samples have slope −1/2. An error that stops falling is a bias; one that does not
//! fall at all says that the samples are always the same. A core that stratifies may fall faster.
//!
//! Where a few pixels carry most of the squared error (one sample in thousands carries the light), the spread of the
//! runs does not know the error of their mean: a slope that is off is then no proof, and the answer is inconclusive. So it
//! is where pictures of any number of samples are right: without noise there is no error to fall.

use crate::stats::Moments;
use crate::stats::plan::{Doubt, Hypothesis, Judgement, Report, TestKind, Verdict};
use serde::Deserialize;

/// The slope of independent samples.
const INDEPENDENT: f64 = -0.5;
/// How far a correct core's slope may be from that: rounding, and a band of its own bias at the far
/// end.
const BAND: f64 = 0.02;
/// Standard errors that chance is given: beyond 7 it has a probability below 1e-11.
const SIGMAS: f64 = 7.0;
/// Equal squared errors that a level's mean has to rest on before its spread is believed. Normal errors are worth a
/// third of their number, 80 or more of the smallest level of a case.
const FEWEST_CARRIERS: f64 = 32.0;
/// Standard errors on each side of a 99.9 % interval.
const THREE_NINES: f64 = 3.29;
/// Standard errors more with which an error is seen with probability 0.999.
const SIGMAS_TO_SEE: f64 = 3.09;

/// The errors at one number of samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ErrorLevel {
    /// Samples per pixel.
    pub(crate) samples: u64,
    /// Of each run, the mean over pixels of the squared difference to the truth.
    pub(crate) squared_errors: Vec<f64>,
    /// Mean over pixels of the variance between runs.
    pub(crate) variance: f64,
    /// So many equal ones would make the same mean of squared errors, and as uncertain: (Σe²)²/Σe⁴.
    pub(crate) carriers: f64,
}

impl ErrorLevel {
    pub(crate) fn from_runs(samples: u64, runs: &[Vec<f64>], truth: &[f64]) -> Self {
        let squared = |run: &Vec<f64>| {
            let squares: f64 = run.iter().zip(truth).map(|(x, mu)| (x - mu).powi(2)).sum();
            squares / truth.len() as f64
        };
        let variance =
            |pixel: usize| runs.iter().map(|run| run[pixel]).collect::<Moments>().variance();
        let variances: f64 = (0..truth.len()).map(variance).sum();
        let errors = || runs.iter().flat_map(|run| run.iter().zip(truth)).map(|(x, mu)| x - mu);
        let powers = |exponent| errors().map(|error| error.powi(exponent)).sum::<f64>();
        Self {
            carriers: powers(2).powi(2) / powers(4),
            samples,
            squared_errors: runs.iter().map(squared).collect(),
            variance: variances / truth.len() as f64,
        }
    }

    /// Root mean square error, and its standard error.
    pub(crate) fn error_with_spread(&self) -> [f64; 2] {
        let squared = self.error();
        let error = squared.mean().sqrt();
        [error, 0.5 * squared.standard_error() / error]
    }

    fn error(&self) -> Moments {
        self.squared_errors.iter().copied().collect()
    }
}

/// What slope is right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Sampling {
    /// Slope −1/2.
    #[default]
    Independent,
    /// Slope −1/2 or steeper.
    Stratified,
}

/// The judgement of a series of errors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SlopeReport {
    pub(crate) verdict: Verdict,
    /// Of log error on log samples; NaN of errors without noise, which have no rate to fall at.
    pub(crate) slope: f64,
    /// Of `slope`.
    pub(crate) standard_error: f64,
    /// The smallest deviation of the slope that would have been caught with probability 0.999.
    pub(crate) resolution: f64,
    /// The bias that would explain what the last level's error exceeds its own noise by; 0 if
    /// nothing.
    pub(crate) plateau_bias: f64,
    /// Why this decides nothing, where more samples would not help.
    pub(crate) doubt: Option<Doubt>,
}

impl Report for SlopeReport {
    fn judgement(&self) -> Judgement {
        let end = |side: f64| self.slope + side * THREE_NINES * self.standard_error;
        Judgement {
            interval: Some([end(-1.0), end(1.0)]),
            smallest_detectable_error: Some(self.resolution / INDEPENDENT.abs()),
            doubt: self.doubt,
            hypothesis: Some(Hypothesis::new(TestKind::Slope, false)),
            ..Judgement::new(self.verdict, self.slope, INDEPENDENT)
        }
    }
}

/// Judges the slope of the errors; it must be seen if it is off by `detects`. `forgiven` is the error that a right core may
/// have however many samples it takes, in the unit of the errors.
pub(crate) fn judge_slope(
    levels: &[ErrorLevel],
    sampling: Sampling,
    detects: f64,
    forgiven: f64,
) -> SlopeReport {
    let points: Vec<_> = levels.iter().map(point).collect();
    let have_noise = points.iter().any(|[.., weight]| *weight < weight_of(0.0));
    let (slope, standard_error) = if have_noise { fit(&points) } else { (f64::NAN, f64::NAN) };
    let off = match sampling {
        Sampling::Independent => (slope - INDEPENDENT).abs(),
        Sampling::Stratified => slope - INDEPENDENT,
    };
    let resolution = BAND + (SIGMAS + SIGMAS_TO_SEE) * standard_error;
    let rejects = off > BAND + SIGMAS * standard_error || slope.is_nan();
    let few_carry = || levels.iter().any(|level| level.carriers < FEWEST_CARRIERS);
    let doubt = match rejects {
        _ if are_right(levels, forgiven) => Some(Doubt::NoError),
        true if few_carry() => Some(Doubt::FewCarryTheError),
        _ => None,
    };
    SlopeReport {
        verdict: match doubt {
            Some(_) => Verdict::Inconclusive,
            None => Verdict::of_test(rejects, resolution <= detects),
        },
        doubt,
        slope,
        standard_error,
        resolution,
        plateau_bias: levels.last().map_or(0.0, plateau_bias),
    }
}

/// Whether no level has a larger root mean square error than `forgiven`; one that is not a number has.
fn are_right(levels: &[ErrorLevel], forgiven: f64) -> bool {
    levels.iter().all(|level| level.error().mean().sqrt() <= forgiven)
}

/// ln samples, ln of the root mean square error over pixels and runs, and how much that weighs: one over its variance.
fn point(level: &ErrorLevel) -> [f64; 3] {
    let squared = level.error();
    // d ln √m = dm / 2m
    let log_error = 0.5 * squared.standard_error() / squared.mean();
    let weight = weight_of(log_error);
    [(level.samples as f64).ln(), squared.mean().sqrt().ln(), weight]
}

/// Of a logarithm with this standard error. Pictures that are all off by the same are no better known than to rounding.
fn weight_of(standard_error: f64) -> f64 {
    standard_error.max(f64::EPSILON).powi(2).recip()
}

/// Weighted least squares of ln error on ln samples: slope and standard error. NaN of fewer than
/// two levels.
fn fit(points: &[[f64; 3]]) -> (f64, f64) {
    let sum = |term: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(term).sum::<f64>();
    let centre = sum(&|[x, _, weight]| weight * x) / sum(&|[.., weight]| *weight);
    let squares = sum(&|[x, _, weight]| weight * (x - centre).powi(2));
    let products = sum(&|[x, y, weight]| weight * (x - centre) * y);
    (products / squares, squares.recip().sqrt())
}

/// E[(x − μ)²] = bias² + variance.
fn plateau_bias(level: &ErrorLevel) -> f64 {
    // A clamp keeps NaN, which `max` would take for no bias.
    (level.error().mean() - level.variance).clamp(0.0, f64::INFINITY).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    /// 32 runs of 256 pixels of value 1, whose samples are exponential; `distort` is the core's
    /// mistake.
    fn levels(distort: impl Fn(f64, f64) -> f64) -> Vec<ErrorLevel> {
        let mut stream = Seed(12).stream();
        let truth = vec![1.0; 256];
        [4u64, 16, 64, 256]
            .map(|samples| {
                let n = samples as f64;
                let mut pixel = || {
                    let sum: f64 = (0..samples).map(|_| -(1.0 - uniform(&mut stream)).ln()).sum();
                    distort(sum / n, n)
                };
                let runs: Vec<Vec<f64>> =
                    (0..32).map(|_| (0..256).map(|_| pixel()).collect()).collect();
                ErrorLevel::from_runs(samples, &runs, &truth)
            })
            .into()
    }

    #[test]
    fn independent_samples_fall_with_slope_one_half() {
        let report = judge_slope(&levels(|mean, _| mean), Sampling::Independent, 0.1, 0.0);
        assert_eq!(report.verdict, Verdict::Pass, "{report:?}");
        assert!((report.slope + 0.5).abs() < 4.0 * report.standard_error + 0.005);
        assert!(report.plateau_bias < 0.02);
    }

    #[test]
    fn a_bias_makes_a_plateau_and_is_measured() {
        let report = judge_slope(&levels(|mean, _| mean + 0.1), Sampling::Independent, 0.1, 0.0);
        assert_eq!(report.verdict, Verdict::Fail);
        assert!((report.plateau_bias - 0.1).abs() < 0.01, "{}", report.plateau_bias);
    }

    #[test]
    fn noise_that_does_not_fall_fails() {
        let stuck = |mean: f64, n: f64| 1.0 + (mean - 1.0) * n.sqrt();
        let report = judge_slope(&levels(stuck), Sampling::Independent, 0.1, 0.0);
        assert_eq!(report.verdict, Verdict::Fail);
        assert!(report.slope.abs() < 0.05);
    }

    #[test]
    fn pictures_that_are_all_off_by_the_same_have_no_slope() {
        let dark = judge_slope(&levels(|_, _| 0.0), Sampling::Stratified, 0.1, 1e-3);
        assert_eq!(dark.verdict, Verdict::Fail);
        assert!(dark.slope.is_nan(), "{dark:?}");
        assert!((dark.plateau_bias - 1.0).abs() < 1e-9, "{dark:?}");
    }

    #[test]
    fn where_all_pictures_are_right_no_error_has_to_fall() {
        let judged = |mean: f64| judge_slope(&levels(|_, _| mean), Sampling::Stratified, 0.1, 1e-3);
        for mean in [1.0, 1.0 + 1e-7, 0.9991] {
            let report = judged(mean);
            let found = (report.verdict, report.doubt);
            assert_eq!(found, (Verdict::Inconclusive, Some(Doubt::NoError)), "{report:?}");
        }
        assert_eq!(judged(1.0011).verdict, Verdict::Fail);
        // One number of samples that is wrong is enough.
        let late = judge_slope(
            &levels(|_, n| if n < 200.0 { 1.0 } else { 1.1 }),
            Sampling::Stratified,
            0.1,
            1e-3,
        );
        assert_eq!(late.verdict, Verdict::Fail);
    }

    #[test]
    fn a_steeper_slope_is_right_only_where_samples_are_stratified() {
        let steeper = |mean: f64, n: f64| 1.0 + (mean - 1.0) * n.powf(-0.25);
        let levels = levels(steeper);
        assert_eq!(judge_slope(&levels, Sampling::Independent, 0.1, 0.0).verdict, Verdict::Fail);
        assert_eq!(judge_slope(&levels, Sampling::Stratified, 0.1, 0.0).verdict, Verdict::Pass);
    }

    /// Pictures of 64 pixels and fewer, whose light comes by one sample in `rarity`.
    fn carried_by_one_in(rarity: f64, seed: u64) -> Vec<ErrorLevel> {
        let mut stream = Seed(seed).stream();
        [(4, 64), (16, 64), (64, 32), (256, 8)]
            .map(|(samples, pixels)| {
                let mut sample = || if uniform(&mut stream) * rarity < 1.0 { rarity } else { 0.0 };
                let mut pixel = || (0..samples).map(|_| sample()).sum::<f64>() / samples as f64;
                let runs: Vec<Vec<f64>> =
                    (0..32).map(|_| (0..pixels).map(|_| pixel()).collect()).collect();
                ErrorLevel::from_runs(samples, &runs, &vec![1.0; pixels])
            })
            .into()
    }

    #[test]
    fn a_tail_that_carries_the_light_proves_nothing() {
        let judged = |rarity| {
            (0..100).map(move |seed| {
                judge_slope(&carried_by_one_in(rarity, seed), Sampling::Stratified, 0.15, 0.0)
            })
        };
        for rarity in [1000.0, 4000.0, 30_000.0] {
            let failed = judged(rarity).filter(|report| report.verdict == Verdict::Fail).count();
            assert_eq!(failed, 0, "one sample in {rarity}");
        }
        assert!(judged(4000.0).any(|report| report.doubt == Some(Doubt::FewCarryTheError)));
    }

    #[test]
    fn one_level_or_a_nan_is_no_pass() {
        let mut few = levels(|mean, _| mean);
        few.truncate(1);
        assert_ne!(judge_slope(&few, Sampling::Independent, 0.1, 0.0).verdict, Verdict::Pass);
        let nan = judge_slope(&levels(|_, _| f64::NAN), Sampling::Independent, 0.1, 0.0);
        assert_eq!(nan.verdict, Verdict::Fail);
        assert!(nan.plateau_bias.is_nan(), "{nan:?}");
    }
}
