//! Error against sample count: the slope of log error on log samples is −1/2.

use crate::cause;
use crate::checks::{Check, CheckError, Context, Finding, Measure, camera_of};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, DirectSampling, Film, IntegratorSettings,
    RenderSettings,
};
use crate::image::luminance;
use crate::math::rng::Seed;
use crate::scene::Camera;
use crate::stats::{ErrorLevel, Sampling, SlopeReport, Verdict, judge_slope};
use crate::text::{Colour, Percent};
use serde::Deserialize;

/// Renders small pictures of which every pixel has the same known radiance, at growing sample counts.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ErrorFallsAsRootN {
    size: [u32; 2],
    bounces: [u32; 2],
    #[serde(default)]
    direct: DirectSampling,
    /// Samples per pixel, growing; each at least twice the one before.
    samples: Vec<u32>,
    /// Pictures at each count.
    runs: u32,
    /// What every pixel is.
    radiance: Colour,
    /// The deviation of the slope from −1/2 that must be seen, as a share of 1.
    detects: Percent,
}

impl Check for ErrorFallsAsRootN {
    const NAME: &'static str = "error-falls-as-root-n";
    const SUMMARY: &'static str = "error against sample count has slope -1/2 and no plateau";

    fn needs(&self) -> Capabilities {
        let needs = Capabilities::BUILD_SCENE | Capabilities::RENDER;
        match self.direct {
            DirectSampling::Lights => needs,
            DirectSampling::Hemisphere => needs | Capabilities::HEMISPHERE_SAMPLING,
        }
    }

    fn validate(&self) -> Result<(), String> {
        if self.samples.len() < 3 || self.samples.windows(2).any(|pair| pair[1] < 2 * pair[0]) {
            return Err("`samples` needs three counts or more, each twice the last".to_owned());
        }
        if self.runs < 8 {
            return Err(
                "`runs` must be at least 8, or the noise of the error is unknown".to_owned()
            );
        }
        Ok(())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let levels = self
            .samples
            .iter()
            .map(|samples| self.level(built.as_mut(), &camera, *samples, seed))
            .collect::<Result<Vec<_>, _>>()?;
        let report = judge_slope(&levels, Sampling::Stratified, self.detects.0);
        Ok(self.finding(&report))
    }
}

impl ErrorFallsAsRootN {
    /// The errors at one sample count.
    fn level(
        &self,
        scene: &mut dyn BuiltScene,
        camera: &Camera,
        samples: u32,
        seed: Seed,
    ) -> Result<ErrorLevel, CheckError> {
        let seed = seed.child(samples);
        let runs = (0..self.runs)
            .map(|run| self.luminances(scene, camera, samples, seed.child(run)))
            .collect::<Result<Vec<_>, _>>()?;
        let truth = vec![luminance(self.radiance.0.map(|value| value as f32)); runs[0].len()];
        Ok(ErrorLevel::from_runs(u64::from(samples), &runs, &truth))
    }

    fn luminances(
        &self,
        scene: &mut dyn BuiltScene,
        camera: &Camera,
        samples: u32,
        seed: Seed,
    ) -> Result<Vec<f64>, CheckError> {
        let settings = RenderSettings {
            width: self.size[0],
            height: self.size[1],
            samples_per_pixel: samples,
            integrator: IntegratorSettings {
                bounces: self.bounces[0]..=self.bounces[1],
                direct: self.direct,
                seed: seed.0,
                ..Default::default()
            },
            adaptive: None,
        };
        let mut film = Film::default();
        scene.render(camera, &settings, &mut film)?;
        Ok(film.pixels.iter().copied().map(luminance).collect())
    }

    fn finding(&self, report: &SlopeReport) -> Finding {
        let slope = Measure {
            interval: Some(
                [-1.0, 1.0].map(|side| report.slope + side * THREE_NINES * report.standard_error),
            ),
            resolution: Some(report.resolution / 0.5),
            verdict: report.verdict,
            leaf: Some(report.leaf()),
            ..Measure::exact("slope of log error on log samples", report.slope, -0.5, 0.0)
        };
        let statement = match report.verdict {
            Verdict::Fail => format!(
                "error falls as n^{:.3}, not n^-0.5; a bias of {:.2e} would explain its plateau",
                report.slope, report.plateau_bias
            ),
            _ => format!("error falls as n^{:.3}", report.slope),
        };
        let resolution =
            format!("would have caught a slope that is off by {:.3}", report.resolution);
        let repeats = report.verdict == Verdict::Fail && report.slope.abs() <= NO_SLOPE;
        let cause = repeats.then_some(&cause::seed::SAMPLES_REPEAT);
        let evidence = format!("more samples change nothing: the slope is {:.3}", report.slope);
        Finding::of(statement, resolution, vec![slope]).because_each(cause, &evidence)
    }
}

/// A slope that is none: samples that repeat, or a bias that nothing averages out.
const NO_SLOPE: f64 = 0.05;
/// Standard errors on each side of a 99.9 % interval of a normal mean.
const THREE_NINES: f64 = 3.29;
