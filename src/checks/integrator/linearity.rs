//! What twice the light, one light of two and twice the size make of the radiance along a ray.

use super::changed_scene::{BRIGHTER, brightened, only, scaled};
use super::estimate::{estimate, judge_difference};
use crate::cause::{Cause, light};
use crate::checks::{Measure, Result};
use crate::contract::{Acceleration, Core, IntegratorSettings, Ray};
use crate::image::CHANNELS;
use crate::math::rng::Seed;
use crate::scene::SceneDescription;
use crate::stats::Effort;

/// Samples of an estimate that relative errors are relative to, and of the bitwise comparison.
pub(super) const SCALE_SAMPLES: u64 = 16_384;

/// How far a sum may be from what a mistake makes of its parts, relative: more than their noise.
const LIKE: f64 = 0.05;

pub(super) struct Trial {
    pub(super) settings: IntegratorSettings,
    pub(super) effort: Effort,
    pub(super) ray: Ray,
    pub(super) seed: Seed,
}

impl Trial {
    pub(super) fn mean(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
        ray: Ray,
        seed: Seed,
        samples: u64,
    ) -> Result<[f64; 3]> {
        let mut built = core.build_scene(scene, Acceleration::DEFAULT)?;
        Ok(estimate(built.as_mut(), ray, &self.settings, seed, samples)?.mean)
    }

    /// The same seed, twice the light: the very same paths, each worth exactly twice as much.
    pub(super) fn doubles(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Vec<Measure>> {
        let seed = self.seed.child("doubled");
        let once = self.mean(core, scene, self.ray, seed, SCALE_SAMPLES)?;
        let twice = self.mean(core, &brightened(scene), self.ray, seed, SCALE_SAMPLES)?;
        let exact = |c: usize| {
            Measure::exact("twice the light", twice[c], BRIGHTER * once[c], 0.0)
                .of_channel(CHANNELS[c])
        };
        Ok((0..3).map(exact).collect())
    }

    /// The same where paths may depend on how bright light is, or on what was drawn before.
    pub(super) fn doubles_in_the_mean(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Vec<Measure>> {
        let bright = brightened(scene);
        let scale = self.mean(core, &bright, self.ray, self.seed.child("scale"), SCALE_SAMPLES)?;
        let seed = self.seed.child("doubled");
        let reports = judge_difference(scale, &self.effort, seed, &mut |seed, samples| {
            let once = self.mean(core, scene, self.ray, seed.child("once"), samples)?;
            let twice = self.mean(core, &bright, self.ray, seed.child("twice"), samples)?;
            Ok([0, 1, 2].map(|c| twice[c] - BRIGHTER * once[c]))
        })?;
        Ok(Measure::of_channels("twice the light minus twice the radiance", &reports))
    }

    /// The sum over lights of the radiance from each alone is the radiance from all.
    pub(super) fn superposes(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Vec<Measure>> {
        if scene.lights.len() < 2 {
            return Ok(Vec::new());
        }
        let alone: Vec<_> = (0..scene.lights.len()).map(|light| only(scene, light)).collect();
        let scale = self.mean(core, scene, self.ray, self.seed.child("scale"), SCALE_SAMPLES)?;
        let reports = judge_difference(scale, &self.effort, self.seed, &mut |seed, samples| {
            let mut difference = self.mean(core, scene, self.ray, seed.child("all"), samples)?;
            for (light, scene) in alone.iter().enumerate() {
                let part = self.mean(core, scene, self.ray, seed.child(light), samples)?;
                (0..3).for_each(|c| difference[c] -= part[c]);
            }
            Ok(difference)
        })?;
        Ok(Measure::of_channels("all lights minus each alone", &reports))
    }

    /// The mistake that makes the radiance of all lights out of that of each alone.
    pub(super) fn what_lights_make_of_each_other(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Option<&'static Cause>> {
        let seed = self.seed.child("cause");
        let all = self.mean(core, scene, self.ray, seed, SCALE_SAMPLES)?;
        let alone = (0..scene.lights.len())
            .map(|light| self.mean(core, &only(scene, light), self.ray, seed, SCALE_SAMPLES))
            .collect::<Result<Vec<_>, _>>()?;
        let is_like = |predicted: [f64; 3]| {
            (0..3).all(|c| (all[c] - predicted[c]).abs() <= LIKE * predicted[c])
        };
        let count = alone.len() as f64;
        let mean = [0, 1, 2].map(|c| alone.iter().map(|part| part[c]).sum::<f64>() / count);
        Ok(if alone.len() < 2 {
            None
        } else if is_like(mean) {
            Some(&light::DIVIDED_BY_LIGHTS)
        } else if alone.iter().any(|part| is_like(*part)) {
            Some(&light::LAST_LIGHT_ONLY)
        } else {
            None
        })
    }

    /// Everything `factor` times as large, and the ray starts as many times as far away.
    pub(super) fn ignores_size(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
        factor: f64,
    ) -> Result<Vec<Measure>> {
        let other = scaled(scene, factor);
        let from_there = Ray { origin: factor * self.ray.origin, ..self.ray };
        let scale = self.mean(core, scene, self.ray, self.seed.child("scale"), SCALE_SAMPLES)?;
        let reports = judge_difference(scale, &self.effort, self.seed, &mut |seed, samples| {
            let one = self.mean(core, scene, self.ray, seed.child("one"), samples)?;
            let two = self.mean(core, &other, from_there, seed.child("two"), samples)?;
            Ok([0, 1, 2].map(|c| two[c] - one[c]))
        })?;
        Ok(Measure::of_channels(&format!("{factor} times as large minus as it is"), &reports))
    }
}
