//! Unbiased estimators of the same radiance have the same mean, whatever that is: no reference is needed.

use super::estimate::{RayEntry, estimate, judge_difference, needs, settings};
use crate::checks::phrase::percent;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, DirectSampling, IntegratorSettings, Ray,
};
use crate::math::rng::Seed;
use crate::stats::Effort;
use crate::text::{Between, Bounces, Count, Percent, Several};
use serde::Deserialize;

/// Samples of the estimate that relative errors are relative to.
const SCALE_SAMPLES: u64 = 65_536;

check! {
    pub(crate) struct EstimatorsAgree {
        ray: Several<RayEntry>,
        bounces: Bounces,
        /// At least two; the first is what the others are compared with.
        estimator: Vec<Estimator>,
        detects: Percent,
        at_most: Count,
    }
    name: "estimators-agree",
    summary: "hemisphere and light sampling, few and many samples: one mean",
}

/// A way to estimate light.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Estimator {
    direct: DirectSampling,
    samples_per_light: Between<1, 4096>,
}

impl Estimator {
    fn settings(self, bounces: [u32; 2]) -> IntegratorSettings {
        IntegratorSettings {
            samples_per_light: self.samples_per_light.0,
            ..settings(bounces, self.direct)
        }
    }

    fn name(self) -> String {
        let direct = match self.direct {
            DirectSampling::Hemisphere => "hemisphere",
            DirectSampling::Lights => "lights",
        };
        format!("{direct} x {}", self.samples_per_light.0)
    }
}

impl Check for EstimatorsAgree {
    fn needs_besides(&self) -> Capabilities {
        self.estimator
            .iter()
            .fold(Capabilities::empty(), |all, e| all | needs(&e.settings(self.bounces.0)))
    }

    fn validate(&self) -> Result<(), String> {
        if self.estimator.len() < 2 {
            return Err("two estimators at least are needed to agree".to_owned());
        }
        Ok(())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let (seed, effort) = (context.seed, context.effort(self.detects, self.at_most));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut measures = Vec::new();
        for (number, ray) in self.ray.iter().enumerate() {
            for other in &self.estimator[1..] {
                let seed = seed.child(number).child(other.name());
                let comparison = Comparison { check: self, ray: ray.ray(), other: *other, seed };
                let found = comparison.judge(built.as_mut(), &effort)?;
                let row = format!("ray {}", number + 1);
                measures.extend(found.into_iter().map(|measure| measure.of_row(&row)));
            }
        }
        let passing = format!("{} differences of means, none of them real", measures.len());
        Ok(Finding::measured(
            statement("the estimators do not agree", passing, &measures),
            measures,
        ))
    }
}

/// One estimator against the first, along one ray.
struct Comparison<'a> {
    check: &'a EstimatorsAgree,
    ray: Ray,
    other: Estimator,
    seed: Seed,
}

impl Comparison<'_> {
    fn judge(&self, scene: &mut dyn BuiltScene, effort: &Effort) -> Result<Vec<Measure>> {
        let first = self.check.estimator[0];
        let (ours, theirs) =
            (self.other.settings(self.check.bounces.0), first.settings(self.check.bounces.0));
        let scale =
            estimate(scene, self.ray, &theirs, self.seed.child("scale"), SCALE_SAMPLES)?.mean;
        let reports = judge_difference(scale, effort, self.seed, &mut |seed, samples| {
            let a = estimate(scene, self.ray, &ours, seed.child("a"), samples)?.mean;
            let b = estimate(scene, self.ray, &theirs, seed.child("b"), samples)?.mean;
            Ok([0, 1, 2].map(|c| a[c] - b[c]))
        })?;
        let name = format!("{} minus {}", self.other.name(), first.name());
        let measures = Measure::of_channels(&name, &reports).into_iter().zip(scale);
        Ok(measures.map(|(measure, scale)| relative(measure, scale)).collect())
    }
}

/// A measured difference as a share of what was subtracted.
pub(super) fn relative(measure: Measure, scale: f64) -> Measure {
    // Of a dark mean no difference is none, and 0 / 0 would be NaN.
    let share = |value: f64| if value == 0.0 { 0.0 } else { value / scale };
    Measure {
        measured: share(measure.measured),
        allowed: share(measure.allowed),
        interval: measure.interval.map(|interval| interval.map(share)),
        unit: "of the mean".to_owned(),
        ..measure
    }
}

/// What is wrong and the largest of the differences that failed, or what `passing` says.
pub(super) fn statement(wrong: &str, passing: String, measures: &[Measure]) -> String {
    let worst = measures
        .iter()
        .filter(|measure| measure.failed())
        .max_by(|a, b| a.measured.abs().total_cmp(&b.measured.abs()));
    match worst {
        None => passing,
        Some(worst) => {
            format!("{wrong}: {} is {} of the mean", worst.name(), percent(worst.measured))
        }
    }
}
