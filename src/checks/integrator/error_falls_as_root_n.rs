//! Error against sample count: the slope of log error on log samples is −1/2.

use super::estimate::needs_direct;
use crate::cause;
use crate::checks::convergence;
use crate::checks::rendering::Rendering;
use crate::checks::{Check, Context, Finding, Measure, Result, camera_of, check};
use crate::contract::{Acceleration, BuiltScene, Capabilities, DirectSampling};
use crate::image::luminance;
use crate::math::rng::Seed;
use crate::scene::Camera;
use crate::stats::{Allowance, Band, ErrorLevel, Sampling, SlopeReport, Verdict, judge_slope};
use crate::text::number::{figure, to_step};
use crate::text::{Between, Bounces, Count, Lit, Percent, Size};

check! {
    /// Renders small pictures of which every pixel has the same known radiance, at growing sample counts.
    pub(crate) struct ErrorFallsAsRootN {
        size: Size,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        /// Samples per pixel, growing; each at least twice the one before.
        samples: Vec<Between<1, 65536>>,
        /// Pictures at each count; of fewer the noise of the error is unknown.
        runs: Between<8, 4096>,
        /// Samples of all pictures at one count: pictures of more samples have fewer rows, down to one.
        at_most: Count,
        /// What every pixel is.
        radiance: Lit,
        /// The deviation of the slope from −1/2 that must be seen, as a share of 1.
        detects: Percent,
    }
    name: "error-falls-as-root-n",
    summary: "error against sample count has slope -1/2 and no plateau",
    needs: BUILD_SCENE | RENDER,
}

impl Check for ErrorFallsAsRootN {
    fn needs_besides(&self) -> Capabilities {
        needs_direct(self.direct)
    }

    fn validate(&self) -> Result<(), String> {
        if self.samples.len() < 3 || self.samples.windows(2).any(|pair| pair[1].0 < 2 * pair[0].0) {
            return Err("`samples` needs three counts or more, each twice the last".to_owned());
        }
        Ok(())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let levels = self
            .levels(context.budget)
            .into_iter()
            .map(|level| self.level(built.as_mut(), &camera, level, seed))
            .collect::<Result<Vec<_>, _>>()?;
        // The band of a slope is the same in every budget: a strict one cannot ask for less than it.
        let detects = self.detects.0 * context.budget.coarseness().max(1.0);
        let (levels, variances): (Vec<_>, Vec<_>) = levels.into_iter().unzip();
        let mean = luminance(self.radiance.0.map(|value| value as f32));
        let forgiven = Band::RADIANCE.relative() * mean;
        let report = judge_slope(&levels, Sampling::Stratified, detects, forgiven);
        let errors = convergence::series(&levels, mean, 0.0);
        Ok(finding(&report, &variances).showing([errors]))
    }
}

impl ErrorFallsAsRootN {
    /// The counts that a budget can afford, each with the rows of its pictures: the first three, and those of which
    /// it can pay a row.
    fn levels(&self, budget: Allowance) -> Vec<(u32, u32)> {
        let most = budget.samples(self.at_most.0);
        let Size([width, height]) = self.size;
        let rows = |samples: u32| {
            let row = u64::from(samples) * u64::from(self.runs.0) * u64::from(width);
            u32::try_from(most / row).unwrap_or(u32::MAX).min(height)
        };
        let levels = self.samples.iter().map(|&Between(samples)| (samples, rows(samples)));
        let affordable = levels.enumerate().filter(|(number, (_, rows))| *number < 3 || *rows > 0);
        affordable.map(|(_, (samples, rows))| (samples, rows.max(1))).collect()
    }

    /// The errors at one sample count, and the variance between its pictures.
    fn level(
        &self,
        scene: &mut dyn BuiltScene,
        camera: &Camera,
        (samples, rows): (u32, u32),
        seed: Seed,
    ) -> Result<(ErrorLevel, f64)> {
        let size = [self.size.0[0], rows];
        let rendering = Rendering::through(*camera, size, self.bounces.0, samples).by(self.direct);
        let luminances = |run: u32| {
            let film = rendering.film(scene, seed.child(samples).child(run).0, 0)?;
            Ok(film.pixels.into_iter().map(luminance).collect())
        };
        let runs = (0..self.runs.0).map(luminances).collect::<Result<Vec<Vec<_>>>>()?;
        let truth = vec![luminance(self.radiance.0.map(|value| value as f32)); runs[0].len()];
        Ok((ErrorLevel::from_runs(u64::from(samples), &runs, &truth), variance_between(&runs)))
    }
}

/// The mean over pixels of the variance between runs.
fn variance_between(runs: &[Vec<f64>]) -> f64 {
    let over_runs =
        |of: &dyn Fn(&Vec<f64>) -> f64| runs.iter().map(of).sum::<f64>() / runs.len() as f64;
    let variance = |pixel: usize| {
        let mean = over_runs(&|run| run[pixel]);
        over_runs(&|run| (run[pixel] - mean).powi(2))
    };
    (0..runs[0].len()).map(variance).sum::<f64>() / runs[0].len() as f64
}

/// What the slope says, and the variance between pictures of ever more samples.
fn finding(report: &SlopeReport, variances: &[f64]) -> Finding {
    let slope = Measure::of("slope of log error on log samples", report);
    let shown = to_step(report.slope, report.resolution);
    let statement = match report.verdict {
        Verdict::Fail if report.slope.is_nan() => format!(
            "pictures have no noise to average out, and those of the most samples are off by {}",
            figure(report.plateau_bias)
        ),
        Verdict::Fail => format!(
            "error falls as n^{shown}, not n^-0.5; a bias of {} would explain its plateau",
            figure(report.plateau_bias)
        ),
        _ => format!("error falls as n^{shown}"),
    };
    let caught = |off| format!("would have caught a slope that is off by {}", figure(off));
    let resolution = if report.slope.is_nan() { String::new() } else { caught(report.resolution) };
    // Where it is bias alone that stays, the pictures agree with each other better and better.
    let noise_stays = matches!(variances, [first, .., last] if *last > 0.5 * first);
    let repeats = report.verdict == Verdict::Fail && report.slope.abs() <= NO_SLOPE && noise_stays;
    let cause = repeats.then_some(&cause::integrator::SAMPLES_REPEAT);
    let evidence = format!("more samples change nothing: the slope is {shown}");
    Finding::of(statement, resolution, vec![slope]).because_each(cause, &evidence)
}

/// A slope that is none: samples that repeat, or a bias that nothing averages out.
const NO_SLOPE: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::camera::fake::FakeFilm;
    use crate::checks::series::Series;
    use crate::checks::testing::{assert_passes, check_of, failure};
    use crate::stats::Budget;
    use glam::DVec2;

    const CASE: &str = r#"
        [expect]
        size     = [8, 8]
        bounces  = [0, 0]
        samples  = [4, 16, 64, 256]
        runs     = 32
        at-most  = "70 k"
        radiance = 1
        detects  = "15 %"
    "#;

    /// What is found of a core whose samples are uniform between 0 and 2.
    fn found(core: FakeFilm) -> Finding {
        let radiance: Box<dyn Fn(DVec2, DVec2) -> [f64; 3] + Send> =
            Box::new(|at, _| [2.0 * at.x.fract(); 3]);
        FakeFilm { radiance, ..core }.judged_by(&check_of::<ErrorFallsAsRootN>(CASE))
    }

    #[test]
    fn means_of_samples_pass() {
        let finding = found(FakeFilm::default());
        assert_passes(&finding);
        let [Series::Convergence(errors)] = &finding.series[..] else { panic!("{finding:?}") };
        assert_eq!(errors.samples[..], [4, 16, 64, 256]);
        let falls = errors.error.windows(2).all(|pair| (pair[1] / pair[0] / 0.5 - 1.0).abs() < 0.2);
        assert!(falls, "{errors:?}");
    }

    #[test]
    fn a_plateau_fails_and_is_measured() {
        let biased = FakeFilm { develop: |mean, _| mean.map(|v| v + 0.1), ..FakeFilm::default() };
        let finding = found(biased);
        let told = failure(&finding);
        assert!(told.contains("a bias of 0.1") || told.contains("a bias of 0.099"), "{told}");
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn a_bias_that_nothing_averages_out_is_no_repetition() {
        let bright = |noise: f64| {
            let core = FakeFilm {
                radiance: Box::new(move |at, _| [9.0 + noise * at.x.fract(); 3]),
                ..FakeFilm::default()
            };
            core.judged_by(&check_of::<ErrorFallsAsRootN>(CASE))
        };
        for finding in [bright(0.0), bright(0.1)] {
            failure(&finding);
            assert!(finding.clues.is_empty(), "{finding:?}");
        }
    }

    /// A slope of 0 would be that of samples that repeat.
    #[test]
    fn darkness_has_no_noise_and_no_slope() {
        let found = |develop| found(FakeFilm { develop, ..FakeFilm::default() });
        for (finding, bias) in [(found(|_, _| [0.0; 3]), "1"), (found(|_, _| [0.7; 3]), "0.3")] {
            let told =
                "pictures have no noise to average out, and those of the most samples are off by ";
            assert_eq!(failure(&finding), format!("{told}{bias}"));
            assert!(finding.measures[0].is_degenerate(), "{finding:?}");
            assert_eq!(finding.resolution, "", "no slope would have been caught");
            assert!(finding.clues.is_empty(), "{finding:?}");
        }
    }

    #[test]
    fn who_is_right_without_noise_is_not_failed() {
        let exact = FakeFilm { develop: |_, _| [1.0; 3], ..FakeFilm::default() };
        let finding = found(exact);
        assert_eq!(finding.verdict, Verdict::Inconclusive, "{finding:?}");
        assert!(finding.statement.contains("there is no error to fall"), "{}", finding.statement);
    }

    #[test]
    fn samples_that_change_nothing_are_named() {
        let first = FakeFilm { samples_used: |_| 1, ..FakeFilm::default() };
        assert_eq!(found(first).clues[0].cause, cause::integrator::SAMPLES_REPEAT.name);
    }

    #[test]
    fn pictures_of_many_samples_are_small_and_a_budget_does_without_the_dearest() {
        let check = check_of::<ErrorFallsAsRootN>(CASE);
        let of = |budget: Budget| check.levels(budget.into());
        assert_eq!(of(Budget::Default), [(4, 8), (16, 8), (64, 4), (256, 1)]);
        assert_eq!(of(Budget::Quick), [(4, 8), (16, 2), (64, 1)]);
    }
}
