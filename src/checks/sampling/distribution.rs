//! Anything that draws directions with a pdf: the samplers of a course, and BSDFs seen from a direction.

use crate::checks::numbers::Numbers;
use crate::checks::surface::{SurfaceEntry, evaluated, kink, lets_pass, sampled, seen_from};
use crate::contract::{
    BsdfQuery, BsdfSample, Capabilities, Core, DirectionSample, Randomness, Result, Sampler,
};
use crate::math::rng::Seed;
use crate::scene::Material;
use crate::text::Polar;
use crate::text::number::degrees;
use glam::DVec3;
use serde::Deserialize;

/// Samples asked for in one call.
const BATCH: u64 = 1 << 16;

/// Either `{ sampler = "cosine-hemisphere" }` or `{ surface = { … }, seen-from = ["5 deg", "85 deg"] }`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct DistributionEntry {
    sampler: Option<SamplerEntry>,
    surface: Option<SurfaceEntry>,
    #[serde(default)]
    seen_from: Vec<Polar>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SamplerEntry {
    UniformHemisphere,
    CosineHemisphere,
}

impl SamplerEntry {
    const fn sampler(self) -> Sampler {
        match self {
            Self::UniformHemisphere => Sampler::UniformHemisphere,
            Self::CosineHemisphere => Sampler::CosineHemisphere,
        }
    }
}

impl DistributionEntry {
    /// What is wrong with it.
    pub(crate) fn validate(&self) -> std::result::Result<(), String> {
        match (self.sampler, self.surface) {
            (Some(_), None) => Ok(()),
            (None, Some(surface)) if surface.is_delta() => {
                Err(format!("{surface} has no pdf: its directions are certain"))
            }
            (None, Some(_)) if self.seen_from.is_empty() => {
                Err("`seen-from` is missing: from where is the surface seen?".to_owned())
            }
            (None, Some(_)) => Ok(()),
            _ => Err("give either a `sampler` or a `surface`".to_owned()),
        }
    }

    /// One for a sampler, one for each direction a surface is seen from.
    pub(crate) fn distributions(&self) -> Vec<Distribution> {
        let sampler = self.sampler.map(|sampler| Distribution::Sampler(sampler.sampler()));
        let views = self.surface.iter().flat_map(|surface| {
            let material = surface.material();
            self.seen_from.iter().map(move |angle| Distribution::Bsdf {
                material: material.clone(),
                wo: seen_from(angle.0),
                angle: *angle,
            })
        });
        sampler.into_iter().chain(views).collect()
    }

    /// What a core has to be able to do.
    pub(crate) fn needs(&self) -> Capabilities {
        let of_bsdf = Capabilities::SAMPLE_BSDF | Capabilities::EVAL_BSDF;
        match self.surface {
            None => Capabilities::SAMPLE_DIRECTION,
            Some(surface) => of_bsdf | surface.needs(),
        }
    }
}

/// Something that draws directions.
#[derive(Clone, Debug)]
pub(crate) enum Distribution {
    /// Around +z.
    Sampler(Sampler),
    /// Seen from `wo`.
    Bsdf {
        /// What is sampled.
        material: Material,
        /// Towards the viewer, local frame.
        wo: DVec3,
        /// Of `wo` from the normal.
        angle: Polar,
    },
}

/// A sample, and the pdf that came with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    /// `None`: sampling failed.
    pub(crate) direction: Option<DVec3>,
    /// Per steradian, as returned with the sample.
    pub(crate) pdf: f64,
}

impl Distribution {
    /// `the cosine hemisphere`, `a conductor of roughness 0.3 seen from 45°`
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Sampler(Sampler::UniformHemisphere) => "the uniform hemisphere".to_owned(),
            Self::Sampler(Sampler::CosineHemisphere) => "the cosine hemisphere".to_owned(),
            Self::Bsdf { material, angle, .. } => {
                format!("{} seen from {}", material.name, degrees(angle.0))
            }
        }
    }

    /// Whether a sample may fail: samplers of the whole hemisphere may not.
    pub(crate) const fn may_fail(&self) -> bool {
        matches!(self, Self::Bsdf { .. })
    }

    /// Whether samples may lie anywhere on the sphere, and not above the horizon only.
    pub(crate) const fn is_of_sphere(&self) -> bool {
        matches!(self, Self::Bsdf { material, .. } if lets_pass(&material.surface))
    }

    /// The height at which the pdf may jump.
    pub(crate) fn kink(&self) -> Option<f64> {
        match self {
            Self::Sampler(_) => None,
            Self::Bsdf { material, angle, .. } => kink(&material.surface, angle.0),
        }
    }

    /// The pdf at each direction, as evaluated.
    pub(crate) fn pdf(
        &self,
        core: &mut dyn Core,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        match self {
            Self::Sampler(sampler) => core.direction_pdf(*sampler, directions, pdf),
            Self::Bsdf { material, wo, .. } => {
                let query = |wi: &DVec3| BsdfQuery { wo: *wo, wi: *wi };
                let queries: Vec<_> = directions.iter().map(query).collect();
                let values = evaluated(core, material, &queries)?;
                pdf.iter_mut().zip(&values).for_each(|(pdf, value)| *pdf = value.pdf);
                Ok(())
            }
        }
    }

    /// One sample for each element of `random`.
    pub(crate) fn sample(&self, core: &mut dyn Core, random: Randomness<'_>) -> Result<Vec<Drawn>> {
        match self {
            Self::Sampler(sampler) => {
                let blank = DirectionSample { direction: DVec3::ZERO, pdf: 0.0 };
                let mut samples = vec![blank; random.points.len()];
                core.sample_direction(*sampler, random, &mut samples)?;
                let drawn =
                    |s: &DirectionSample| Drawn { direction: Some(s.direction), pdf: s.pdf };
                Ok(samples.iter().map(drawn).collect())
            }
            Self::Bsdf { material, wo, .. } => {
                let samples = sampled(core, material, &vec![*wo; random.points.len()], random)?;
                let drawn = |sample: &BsdfSample| Drawn {
                    direction: (sample.is_valid == 1).then_some(sample.wi),
                    pdf: sample.pdf,
                };
                Ok(samples.iter().map(drawn).collect())
            }
        }
    }

    /// Means of some functions of a sample and its pdf over one run; a failed sample counts as zero.
    pub(crate) fn means<const N: usize>(
        &self,
        core: &mut dyn Core,
        seed: Seed,
        samples: u64,
        values: impl Fn(DVec3, f64) -> [f64; N],
    ) -> Result<Vec<f64>> {
        let mut sums = [0.0; N];
        self.draw(core, seed, samples, |drawn| {
            for (direction, pdf) in drawn.iter().filter_map(|one| Some((one.direction?, one.pdf))) {
                sums.iter_mut().zip(values(direction, pdf)).for_each(|(sum, value)| *sum += value);
            }
        })?;
        Ok(sums.map(|sum| sum / samples as f64).to_vec())
    }

    /// Draws `count` samples in batches and hands each batch to `take`.
    pub(crate) fn draw(
        &self,
        core: &mut dyn Core,
        seed: Seed,
        count: u64,
        mut take: impl FnMut(&[Drawn]),
    ) -> Result<()> {
        for batch in 0..count.div_ceil(BATCH) {
            let seed = seed.child(batch);
            let size = usize::try_from(BATCH.min(count - batch * BATCH)).unwrap_or(usize::MAX);
            take(&self.sample(core, Numbers::new(seed, size).randomness())?);
        }
        Ok(())
    }
}
