//! The mean along a ray does not depend on the rays that are asked beside it. Renderers that trace many rays at a time,
//! in waves, packets or arrays, mix them up where a mask or an index is that of another ray; along equal rays nobody sees
//! it.

use super::estimate::{RayEntry, RouletteEntry, estimate, needs, settings};
use super::estimators_agree::{relative, statement};
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, DirectSampling, IntegratorSettings, Ray, Roulette,
};
use crate::image::CHANNELS;
use crate::math::rng::{Seed, shuffle};
use crate::stats::{Band, Claim, judge_means};
use crate::text::{Bounces, Count, Percent, Several};

/// Samples of the estimate that relative errors are relative to, a ray.
const SCALE_SAMPLES: u64 = 16_384;
/// Rays asked in one call: many more than fit a wave or a packet, and no whole number of them.
const RAYS_PER_CALL: usize = 10_007;

check! {
    pub(crate) struct RaysStandAlone {
        /// Those that meet no light anywhere stand between the others.
        ray: Several<RayEntry>,
        bounces: Bounces,
        roulette: Option<RouletteEntry>,
        detects: Percent,
        at_most: Count,
    }
    name: "rays-stand-alone",
    summary: "the mean along a ray, whatever rays are asked beside it",
}

impl Check for RaysStandAlone {
    fn needs_besides(&self) -> Capabilities {
        needs(&self.settings())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let (seed, effort) = (context.seed, context.effort(self.detects, self.at_most));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let rays = self.ray.iter().map(|entry| entry.ray()).collect();
        let mut asked = Asked { scene: built.as_mut(), rays, settings: self.settings() };
        let scale = asked.alone(seed.child("scale"), SCALE_SAMPLES)?;
        let is_lit = |number: &usize| scale[*number] != 0.0;
        let lit: Vec<_> = (0..scale.len()).filter(is_lit).collect();
        let claims: Vec<_> =
            lit.iter().map(|n| Claim::difference(scale[*n], Band::RADIANCE)).collect();
        let reports = judge_means(&claims, &effort, &mut |step| {
            let seed = step.seed(seed);
            let alone = asked.alone(seed.child("alone"), step.samples)?;
            let mixed = asked.mixed(seed.child("mixed"), step.samples)?;
            Ok::<_, crate::checks::CheckError>(lit.iter().map(|n| mixed[*n] - alone[*n]).collect())
        })?;
        let measures = lit.iter().zip(&reports).map(|(number, report)| {
            let measure = Measure::of("beside others minus alone", report);
            let row = format!("ray {}", number / CHANNELS.len() + 1);
            let channel = CHANNELS[number % CHANNELS.len()];
            relative(measure.of_channel(channel).of_row(&row), scale[*number])
        });
        let measures: Vec<_> = measures.collect();
        let passing = match lit.is_empty() {
            true => "there is no light along any of the rays".to_owned(),
            false => format!("{} rays have the same mean beside each other", self.ray.len()),
        };
        let wrong = "rays that are asked together do not have their own light";
        Ok(Finding::measured(statement(wrong, passing, &measures), measures))
    }
}

impl RaysStandAlone {
    fn settings(&self) -> IntegratorSettings {
        IntegratorSettings {
            roulette: self.roulette.map(Roulette::from),
            ..settings(self.bounces.0, DirectSampling::Lights)
        }
    }
}

/// Means along rays, channel by channel, one ray after the other.
struct Asked<'a> {
    scene: &'a mut dyn BuiltScene,
    rays: Vec<Ray>,
    settings: IntegratorSettings,
}

impl Asked<'_> {
    /// Each ray in calls of its own.
    fn alone(&mut self, seed: Seed, samples: u64) -> Result<Vec<f64>> {
        let mut means = Vec::new();
        for (number, ray) in self.rays.clone().into_iter().enumerate() {
            let seed = seed.child(number);
            means.extend(estimate(self.scene, ray, &self.settings, seed, samples)?.mean);
        }
        Ok(means)
    }

    /// All rays in the same calls, in no order.
    fn mixed(&mut self, seed: Seed, samples: u64) -> Result<Vec<f64>> {
        let count = self.rays.len();
        let mut order: Vec<_> = (0..count * samples as usize).map(|n| n % count).collect();
        shuffle(&mut order, &mut seed.child("order").stream());
        let mut sums = vec![0.0; CHANNELS.len() * count];
        for (call, numbers) in order.chunks(RAYS_PER_CALL).enumerate() {
            let rays: Vec<_> = numbers.iter().map(|number| self.rays[*number]).collect();
            let settings = IntegratorSettings { seed: seed.child(call).0, ..self.settings.clone() };
            let mut radiance = vec![[0.0; 3]; rays.len()];
            self.scene.radiance(&rays, &settings, &mut radiance)?;
            for (number, values) in numbers.iter().zip(&radiance) {
                for (channel, value) in values.iter().enumerate() {
                    sums[CHANNELS.len() * number + channel] += value;
                }
            }
        }
        Ok(sums.into_iter().map(|sum| sum / samples as f64).collect())
    }
}
