//! What the checks of radiance share: the words of their `[expect]`, and means over seeded runs.

use crate::contract::{
    BuiltScene, Capabilities, DirectSampling, IntegratorSettings, Ray, Result, Roulette,
};
use crate::math::rng::Seed;
use crate::stats::{Allowance, Effort};
use crate::text::{Count, Percent};
use glam::DVec3;
use serde::Deserialize;

/// Names of the channels, in their order.
pub const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// Rays asked in one call: enough to keep threads busy, little enough for any memory.
const RAYS_PER_CALL: u64 = 1 << 16;

/// `{ from = […], toward = […] }`: a ray by its origin and its direction (of any length).
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RayEntry {
    from: [f64; 3],
    toward: [f64; 3],
}

impl RayEntry {
    /// The ray, with a unit direction.
    pub fn ray(self) -> Ray {
        Ray::new(DVec3::from_array(self.from), DVec3::from_array(self.toward).normalize())
    }

    /// What is wrong with it.
    pub fn validate(self) -> std::result::Result<(), String> {
        if DVec3::from_array(self.toward).length() > 0.0 {
            Ok(())
        } else {
            Err("`toward` has no length; it is a direction".to_owned())
        }
    }
}

/// How small an error must be seen, and what it may cost: the effort under an allowance.
pub fn effort(detects: Percent, at_most: Count, allowance: Allowance) -> Effort {
    allowance.scale(Effort::new(detects.0).with_most_samples(at_most.0))
}

/// `{ stop = 0.35, guaranteed = 1 }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RouletteEntry {
    /// Probability of stopping at each bounce.
    pub stop: f64,
    /// Bounces that are always traced.
    #[serde(default)]
    pub guaranteed: u32,
}

impl From<RouletteEntry> for Roulette {
    fn from(entry: RouletteEntry) -> Self {
        Self { stop: entry.stop, guaranteed: entry.guaranteed }
    }
}

/// Settings for bounces `first..=last`.
pub fn settings(bounces: [u32; 2], direct: DirectSampling) -> IntegratorSettings {
    IntegratorSettings { bounces: bounces[0]..=bounces[1], direct, ..Default::default() }
}

/// What a core needs for these settings.
pub fn needs(settings: &IntegratorSettings) -> Capabilities {
    let mut needs = Capabilities::BUILD_SCENE | Capabilities::RADIANCE;
    if *settings.bounces.start() > 0 {
        needs |= Capabilities::ISOLATED_BOUNCES;
    }
    if settings.direct == DirectSampling::Hemisphere {
        needs |= Capabilities::HEMISPHERE_SAMPLING;
    }
    if settings.roulette.is_some() {
        needs |= Capabilities::ROULETTE;
    }
    needs
}

/// Draws `samples` independent estimates along `ray` and hands them over, some at a time.
pub fn draw_estimates(
    scene: &mut dyn BuiltScene,
    ray: Ray,
    settings: &IntegratorSettings,
    seed: Seed,
    samples: u64,
    take: &mut dyn FnMut(&[[f64; 3]]),
) -> Result<()> {
    let mut left = samples;
    for part in 0.. {
        let count = left.min(RAYS_PER_CALL);
        let settings = IntegratorSettings { seed: seed.child(part).0, ..settings.clone() };
        let rays = vec![ray; usize::try_from(count).unwrap_or(usize::MAX)];
        let mut radiance = vec![[0.0; 3]; rays.len()];
        scene.radiance(&rays, &settings, &mut radiance)?;
        take(&radiance);
        left -= count;
        if left == 0 {
            break;
        }
    }
    Ok(())
}

/// Mean and largest channel value of `samples` estimates along `ray`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Estimate {
    /// Mean radiance of each channel.
    pub mean: [f64; 3],
    /// The largest single estimate of each channel.
    pub largest: [f64; 3],
}

/// One seeded run: `samples` independent estimates along `ray`.
pub fn estimate(
    scene: &mut dyn BuiltScene,
    ray: Ray,
    settings: &IntegratorSettings,
    seed: Seed,
    samples: u64,
) -> Result<Estimate> {
    let mut sum = [0.0; 3];
    let mut largest = [0.0_f64; 3];
    draw_estimates(scene, ray, settings, seed, samples, &mut |radiance| {
        for value in radiance {
            for channel in 0..3 {
                sum[channel] += value[channel];
                largest[channel] = largest[channel].max(value[channel]);
            }
        }
    })?;
    Ok(Estimate { mean: sum.map(|sum| sum / samples as f64), largest })
}
