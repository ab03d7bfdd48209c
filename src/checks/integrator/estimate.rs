//! What the checks of radiance share: the words of their `[expect]`, and means over seeded runs.

use crate::checks;
use crate::contract::{
    BuiltScene, Capabilities, DirectSampling, IntegratorSettings, Ray, Result, Roulette,
};
use crate::math::rng::{Seed, Stream, uniform};
use crate::stats::{Band, Claim, Effort, MeanReport, judge_means};
use crate::text::{Arrow, Between, Chance, Vector};
use serde::Deserialize;

/// Rays asked in one call: enough to keep threads busy, little enough for any memory.
const RAYS_PER_CALL: u64 = 1 << 16;

/// `{ from = […], toward = […] }`: a ray by its origin and its direction (of any length).
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RayEntry {
    from: Vector,
    toward: Arrow,
}

impl RayEntry {
    pub(crate) fn ray(self) -> Ray {
        Ray::new(self.from.0, self.toward.0.normalize())
    }
}

/// `{ from = […], corner = […], edges = [[…], […]] }`: rays from a point to points that are uniform over a
/// parallelogram. Their mean is the mean of the radiance that leaves it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PatchEntry {
    from: Vector,
    corner: Vector,
    edges: [Arrow; 2],
}

impl PatchEntry {
    fn ray(self, stream: &mut Stream) -> Ray {
        let [u, v] = self.edges.map(|edge| uniform(stream) * edge.0);
        let from = self.from.0;
        Ray::new(from, (self.corner.0 + u + v - from).normalize())
    }
}

/// Where estimates are asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Aim {
    Ray(Ray),
    /// At random points of a surface.
    Patch(PatchEntry),
}

impl From<Ray> for Aim {
    fn from(ray: Ray) -> Self {
        Self::Ray(ray)
    }
}

impl Aim {
    fn rays(self, seed: Seed, count: usize) -> Vec<Ray> {
        match self {
            Self::Ray(ray) => vec![ray; count],
            Self::Patch(patch) => {
                let mut stream = seed.stream();
                (0..count).map(|_| patch.ray(&mut stream)).collect()
            }
        }
    }
}

/// `{ stop = 0.35, guaranteed = 1 }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RouletteEntry {
    /// Probability of stopping at each bounce.
    pub(crate) stop: Chance,
    /// Bounces that are always traced.
    #[serde(default)]
    pub(crate) guaranteed: u32,
}

impl From<RouletteEntry> for Roulette {
    fn from(entry: RouletteEntry) -> Self {
        Self { stop: entry.stop.0, guaranteed: entry.guaranteed }
    }
}

/// Settings for bounces `first..=last`.
pub(crate) fn settings(bounces: [u32; 2], direct: DirectSampling) -> IntegratorSettings {
    IntegratorSettings { bounces: bounces[0]..=bounces[1], direct, ..Default::default() }
}

/// For `#[serde(default)]`.
pub(crate) const fn one() -> Between<1, 4096> {
    Between(1)
}

/// What a core needs to sample direct light so.
pub(crate) const fn needs_direct(direct: DirectSampling) -> Capabilities {
    match direct {
        DirectSampling::Lights => Capabilities::empty(),
        DirectSampling::Hemisphere => Capabilities::HEMISPHERE_SAMPLING,
    }
}

/// What a core needs for these settings.
pub(crate) fn needs(settings: &IntegratorSettings) -> Capabilities {
    let mut needs =
        Capabilities::BUILD_SCENE | Capabilities::RADIANCE | needs_direct(settings.direct);
    if *settings.bounces.start() > 0 {
        needs |= Capabilities::ISOLATED_BOUNCES;
    }
    if settings.by_depth {
        needs |= Capabilities::DEPTH_LIMIT;
    }
    if settings.roulette.is_some() {
        needs |= Capabilities::ROULETTE;
    }
    needs
}

/// Draws `samples` independent estimates and hands them over, some at a time.
pub(crate) fn draw_estimates(
    scene: &mut dyn BuiltScene,
    aim: impl Into<Aim>,
    settings: &IntegratorSettings,
    seed: Seed,
    samples: u64,
    take: &mut dyn FnMut(&[[f64; 3]]),
) -> Result<()> {
    let aim = aim.into();
    let mut left = samples;
    for part in 0.. {
        let count = left.min(RAYS_PER_CALL);
        let seed = seed.child(part);
        let settings = IntegratorSettings { seed: seed.0, ..settings.clone() };
        let rays = aim.rays(seed.child("aim"), usize::try_from(count).unwrap_or(usize::MAX));
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

/// Mean and largest channel value, of either sign, of `samples` estimates along `ray`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Estimate {
    pub(crate) mean: [f64; 3],
    pub(crate) largest: [f64; 3],
    /// How many are 0 in every channel.
    pub(crate) dark: u64,
}

/// One seeded run: `samples` independent estimates.
pub(crate) fn estimate(
    scene: &mut dyn BuiltScene,
    aim: impl Into<Aim>,
    settings: &IntegratorSettings,
    seed: Seed,
    samples: u64,
) -> Result<Estimate> {
    let mut sum = [0.0; 3];
    let mut largest = [0.0_f64; 3];
    let mut dark = 0;
    draw_estimates(scene, aim, settings, seed, samples, &mut |radiance| {
        for value in radiance {
            dark += u64::from(*value == [0.0; 3]);
            for channel in 0..3 {
                sum[channel] += value[channel];
                largest[channel] = largest[channel].max(value[channel].abs());
            }
        }
    })?;
    Ok(Estimate { mean: sum.map(|sum| sum / samples as f64), largest, dark })
}

/// Whether a difference of means is 0, to an error that is relative to `scale`.
pub(crate) fn judge_difference(
    scale: [f64; 3],
    effort: &Effort,
    seed: Seed,
    draw: &mut dyn FnMut(Seed, u64) -> checks::Result<[f64; 3]>,
) -> checks::Result<Vec<MeanReport>> {
    let claims = scale.map(|scale| Claim::difference(scale, Band::RADIANCE));
    judge_means(&claims, effort, &mut |step| Ok(draw(step.seed(seed), step.samples)?.to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn rays_over_a_patch_meet_all_of_it_alike() {
        let patch = PatchEntry {
            from: Vector(DVec3::new(2.0, 0.5, 3.0)),
            corner: Vector(DVec3::Z),
            edges: [Arrow(DVec3::X), Arrow(DVec3::Y)],
        };
        let mut quarters = [0; 4];
        for ray in Aim::Patch(patch).rays(Seed(1), 4000) {
            let point = ray.at((1.0 - ray.origin.z) / ray.direction.z);
            assert!((0.0..=1.0).contains(&point.x) && (0.0..=1.0).contains(&point.y), "{point}");
            quarters[2 * usize::from(point.x > 0.5) + usize::from(point.y > 0.5)] += 1;
        }
        // 1000 ± 27 each.
        assert!(quarters.iter().all(|count| (840..1160).contains(count)), "{quarters:?}");
    }
}
