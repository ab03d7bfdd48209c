//! Light adds up: twice the light gives twice the radiance, two lights give the sum of each, and the size of the
//! scene does not matter.

use super::estimate::{RayEntry, estimate, needs, settings};
use crate::cause::{Cause, light};
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Acceleration, Capabilities, Core, DirectSampling, IntegratorSettings, Ray};
use crate::image::CHANNELS;
use crate::math::rng::Seed;
use crate::scene::{Light, SceneDescription};
use crate::stats::{Band, Claim, Effort, MeanReport, judge_means};
use crate::text::number::apart;
use crate::text::{Bounces, Count, Percent};
use serde::Deserialize;

/// Samples of an estimate that relative errors are relative to, and of the bitwise comparison.
const SCALE_SAMPLES: u64 = 16_384;
/// How far a sum may be from what a mistake makes of its parts, relative: more than their noise.
const LIKE: f64 = 0.05;
/// A power of two, so that doubling commutes with every rounding.
const BRIGHTER: f64 = 2.0;
const LARGER: f64 = 2.0;

/// Superposition and scaling along a ray.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RadianceIsLinear {
    ray: RayEntry,
    bounces: Bounces,
    #[serde(default)]
    direct: DirectSampling,
    /// The smallest difference that must be seen.
    detects: Percent,
    /// Past this the verdict is inconclusive, never a pass.
    at_most: Count,
}

impl Check for RadianceIsLinear {
    const NAME: &'static str = "radiance-is-linear";
    const SUMMARY: &'static str = "twice the light, the sum of two lights, a scene twice as large";

    fn needs(&self) -> Capabilities {
        needs(&settings(self.bounces.0, self.direct))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let trial = Trial {
            settings: settings(self.bounces.0, self.direct),
            effort: context.effort(self.detects, self.at_most),
            ray: self.ray.ray(),
            seed: context.seed,
        };
        let mut measures = Vec::new();
        if context.info.capabilities.contains(Capabilities::DETERMINISTIC) {
            measures.extend(trial.doubles(context.core, &scene)?);
        }
        measures.extend(trial.superposes(context.core, &scene)?);
        let cause = match measures.iter().any(Measure::failed) {
            true => trial.what_lights_make_of_each_other(context.core, &scene)?,
            false => None,
        };
        measures.extend(trial.ignores_size(context.core, &scene)?);
        let complaint = measures.iter().find(|measure| measure.failed()).map(|measure| {
            let [measured, expected] = apart([measure.measured, measure.expected]);
            format!("light does not add up: {} is {measured} instead of {expected}", measure.name())
        });
        Ok(Finding::measured("light adds up", measures)
            .complaining(complaint)
            .because_each(cause, "predicts the radiance of all lights from that of each alone"))
    }
}

struct Trial {
    settings: IntegratorSettings,
    effort: Effort,
    ray: Ray,
    seed: Seed,
}

impl Trial {
    fn mean(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
        ray: Ray,
        seed: Seed,
        samples: u64,
    ) -> Result<[f64; 3], CheckError> {
        let mut built = core.build_scene(scene, Acceleration::DEFAULT)?;
        Ok(estimate(built.as_mut(), ray, &self.settings, seed, samples)?.mean)
    }

    /// The same seed, twice the light: the very same paths, each worth exactly twice as much.
    fn doubles(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Vec<Measure>, CheckError> {
        let seed = self.seed.child("doubled");
        let once = self.mean(core, scene, self.ray, seed, SCALE_SAMPLES)?;
        let twice = self.mean(core, &brightened(scene), self.ray, seed, SCALE_SAMPLES)?;
        let exact = |c: usize| {
            Measure::exact("twice the light", twice[c], BRIGHTER * once[c], 0.0)
                .of_channel(CHANNELS[c])
        };
        Ok((0..3).map(exact).collect())
    }

    /// The sum over lights of the radiance from each alone is the radiance from all.
    fn superposes(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Vec<Measure>, CheckError> {
        if scene.lights.len() < 2 {
            return Ok(Vec::new());
        }
        let alone: Vec<_> = (0..scene.lights.len()).map(|light| only(scene, light)).collect();
        let scale = self.mean(core, scene, self.ray, self.seed.child("scale"), SCALE_SAMPLES)?;
        let reports = self.judge(scale, &mut |seed, samples| {
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
    fn what_lights_make_of_each_other(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Option<&'static Cause>, CheckError> {
        let seed = self.seed.child("cause");
        let all = self.mean(core, scene, self.ray, seed, SCALE_SAMPLES)?;
        let alone = (0..scene.lights.len())
            .map(|light| self.mean(core, &only(scene, light), self.ray, seed, SCALE_SAMPLES))
            .collect::<Result<Vec<_>, _>>()?;
        let is_like = |predicted: [f64; 3]| {
            (0..3).all(|c| (all[c] - predicted[c]).abs() <= LIKE * predicted[c])
        };
        let count = alone.len() as f64;
        let mean: [f64; 3] =
            std::array::from_fn(|c| alone.iter().map(|part| part[c]).sum::<f64>() / count);
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

    /// Everything twice as large, and the ray starts twice as far away.
    fn ignores_size(
        &self,
        core: &mut dyn Core,
        scene: &SceneDescription,
    ) -> Result<Vec<Measure>, CheckError> {
        let large = enlarged(scene);
        let far = Ray { origin: LARGER * self.ray.origin, ..self.ray };
        let scale = self.mean(core, scene, self.ray, self.seed.child("scale"), SCALE_SAMPLES)?;
        let reports = self.judge(scale, &mut |seed, samples| {
            let one = self.mean(core, scene, self.ray, seed.child("one"), samples)?;
            let two = self.mean(core, &large, far, seed.child("two"), samples)?;
            Ok(std::array::from_fn(|c| two[c] - one[c]))
        })?;
        Ok(Measure::of_channels("twice as large minus as it is", &reports))
    }

    fn judge(
        &self,
        scale: [f64; 3],
        draw: &mut dyn FnMut(Seed, u64) -> Result<[f64; 3], CheckError>,
    ) -> Result<Vec<MeanReport>, CheckError> {
        let claims = scale.map(|scale| Claim::difference(scale, Band::RADIANCE));
        judge_means(&claims, &self.effort, &mut |step| {
            Ok(draw(step.seed(self.seed), step.samples)?.to_vec())
        })
    }
}

/// The scene with every light [`BRIGHTER`].
fn brightened(scene: &SceneDescription) -> SceneDescription {
    let mut scene = scene.clone();
    let brighter = |rgb: &mut [f64; 3]| rgb.iter_mut().for_each(|value| *value *= BRIGHTER);
    for emission in scene.materials.iter_mut().filter_map(|material| material.emission.as_mut()) {
        brighter(&mut emission.radiance);
    }
    for light in &mut scene.lights {
        match light {
            Light::Point { intensity, .. } => brighter(intensity),
            Light::Directional { irradiance, .. } => brighter(irradiance),
            Light::ConstantSky { radiance } => brighter(radiance),
            Light::GradientSky { horizon, zenith, .. } => {
                brighter(horizon);
                brighter(zenith);
            }
            Light::Area { .. } => {}
        }
    }
    scene
}

/// The scene with light number `kept` alone; the shapes of the others stay, dark.
fn only(scene: &SceneDescription, kept: usize) -> SceneDescription {
    let mut scene = scene.clone();
    let light = scene.lights[kept];
    let glowing = match light {
        Light::Area { shape } => Some(shape),
        _ => None,
    };
    for shape in 0..scene.shape_count() as u32 {
        if glowing != Some(shape) {
            darken(&mut scene, shape);
        }
    }
    scene.lights = if glowing.is_some() { Vec::new() } else { vec![light] };
    scene.with_area_lights()
}

/// Gives a shape a copy of its material that does not glow.
fn darken(scene: &mut SceneDescription, shape: u32) {
    let mut material = scene.material_of(shape).clone();
    if material.emission.take().is_none() {
        return;
    }
    let number = scene.materials.len() as u32;
    scene.materials.push(material);
    let shape = shape as usize;
    match shape.checked_sub(scene.meshes.len()) {
        None => scene.meshes[shape].material = number,
        Some(sphere) => scene.spheres[sphere].material = number,
    }
}

/// The scene [`LARGER`]; a point light needs that much squared to light it as before.
fn enlarged(scene: &SceneDescription) -> SceneDescription {
    let mut scene = scene.clone();
    for position in scene.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        *position *= LARGER;
    }
    for sphere in &mut scene.spheres {
        sphere.centre *= LARGER;
        sphere.radius *= LARGER;
    }
    for light in &mut scene.lights {
        if let Light::Point { position, intensity } = light {
            *position *= LARGER;
            intensity.iter_mut().for_each(|value| *value *= LARGER * LARGER);
        }
    }
    scene
}
