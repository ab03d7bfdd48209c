//! Choices that are as right as those of the lecture: no case may fail them.
//!
//! Like a fault, a choice replaces steps of the lesson; some of them have to be declared, too.

use super::ggx::Facets;
use super::glass::refracted_cosine;
use super::integrator::{Progress, survival_probability};
use super::random::{self, Random, scramble};
use super::steps::{LESSON, Steps};
use super::{bsdf, vertex};
use crate::contract::{
    Capabilities, CoreInfo, EmissionSides, Falloff, GlassFresnel, GlassRadiance, Precision,
    Roulette, Sampler, SmithTerm, Split,
};
use crate::scene::Surface;
use glam::{DVec2, DVec3};

/// A core that is right, and not the same.
#[derive(Debug)]
pub struct Different {
    /// Kebab-case, unique: `textbook:NAME` is the core that chooses it.
    pub name: &'static str,
    /// What it does, in one line.
    pub summary: &'static str,
    /// The parts of the course whose answers it changes.
    pub parts: &'static [u32],
    /// What it puts in place of steps of the lesson.
    pub(super) steps: Steps,
    /// What the core has to say of it.
    pub(super) declares: fn(&mut CoreInfo),
}

/// For choices that are free.
pub(super) const NOTHING: fn(&mut CoreInfo) = |_| ();

/// Every choice.
pub(crate) const DIFFERENT: &[Different] = &[
    Different {
        name: "uniform-bounces",
        summary: "the diffuse surface draws uniform directions, with their density",
        parts: &[3, 4, 5],
        steps: Steps {
            diffuse_sampler: Some(|| Sampler::UniformHemisphere),
            diffuse_density: Some(|| Sampler::UniformHemisphere),
            ..LESSON
        },
        declares: NOTHING,
    },
    Different {
        name: "other-roulette",
        summary: "dark paths are cut short by roulette of the core's own",
        parts: &[4, 5],
        steps: Steps { survival_probability: Some(survival_of_own_roulette), ..LESSON },
        declares: NOTHING,
    },
    Different {
        name: "larger-offset",
        summary: "rays keep clear of surfaces by 1e-6 in place of 1e-10",
        parts: &[3, 4, 5],
        steps: Steps { clearance: Some(|longest| 1e4 * vertex::CLEARANCE * longest), ..LESSON },
        declares: NOTHING,
    },
    Different {
        name: "stratified-pixels",
        summary: "the samples of a pixel fill it evenly",
        parts: &[1, 4, 5],
        steps: Steps { pixel_point: Some(evenly_in_pixel), ..LESSON },
        declares: NOTHING,
    },
    Different {
        name: "stratified-lights",
        summary: "the samples of a light are stratified",
        parts: &[3, 4, 5],
        steps: Steps {
            light_point: Some(|random, number, of| {
                let point = random.point();
                point.with_x((f64::from(number) + point.x) / f64::from(of))
            }),
            ..LESSON
        },
        declares: NOTHING,
    },
    Different {
        name: "median-split",
        summary: "nodes are halved, whatever rule is asked for",
        parts: &[2],
        steps: Steps { rule: Some(|_| Split::Median), ..LESSON },
        declares: NOTHING,
    },
    Different {
        name: "reversed-leaves",
        summary: "the primitives of a leaf are tested from the last to the first",
        parts: &[2],
        steps: Steps {
            closest_among: Some(|bvh, range, search| {
                range.rev().for_each(|primitive| bvh.test(primitive, search))
            }),
            ..LESSON
        },
        declares: NOTHING,
    },
    Different {
        name: "single-precision",
        summary: "every answer is rounded to f32, and the core says so",
        parts: &[1, 2, 3, 4, 5],
        steps: LESSON,
        declares: |info| info.precision = Precision::Single,
    },
    Different {
        name: "schlick-glass",
        summary: "Schlick's approximation of the view's cosine, declared",
        parts: &[3, 4],
        steps: Steps {
            fresnel: Some(|cosine, ratio| schlick_reflectance(cosine, cosine, ratio)),
            ..LESSON
        },
        declares: |info| info.conventions.glass_fresnel = GlassFresnel::Schlick,
    },
    Different {
        name: "schlick-glass-outside",
        summary: "Schlick's approximation of the cosine on the thin side, declared",
        parts: &[3, 4],
        steps: Steps { fresnel: Some(schlick_outside), ..LESSON },
        declares: |info| info.conventions.glass_fresnel = GlassFresnel::SchlickOutside,
    },
    Different {
        name: "correlated-smith",
        summary: "the height-correlated Smith term, declared",
        parts: &[3, 4],
        steps: Steps {
            metal_f: Some(|Facets { density, roughness, wo, wi, .. }| {
                density * height_correlated_masking(*roughness, *wo, *wi) / (4.0 * wo.z * wi.z)
            }),
            masking_over_cosines: Some(|roughness, wo, wi| {
                height_correlated_masking(roughness, wo, wi) / (wo.z * wi.z)
            }),
            ..LESSON
        },
        declares: |info| info.conventions.smith_term = SmithTerm::HeightCorrelated,
    },
    Different {
        name: "two-sided-emission",
        summary: "lamps glow on both sides when they are seen, declared",
        parts: &[1, 3, 4],
        steps: Steps { emits_towards: Some(|_, _| true), ..LESSON },
        declares: |info| info.conventions.emission = EmissionSides::Both,
    },
    Different {
        name: "no-falloff",
        summary: "point lights do not weaken with distance, declared",
        parts: &[3, 4],
        steps: Steps { point_light_radiance: Some(|intensity, _| intensity), ..LESSON },
        declares: |info| info.conventions.point_light_falloff = Falloff::None,
    },
    Different {
        name: "unscaled-glass",
        summary: "radiance crosses glass unchanged, declared",
        parts: &[3, 4],
        steps: Steps {
            radiance_scale: Some(|_| 1.0),
            rough_radiance_scale: Some(|ratio| ratio * ratio),
            ..LESSON
        },
        declares: |info| info.conventions.glass_radiance = GlassRadiance::Unscaled,
    },
    Different {
        name: "own-numbers",
        summary: "the core draws its own random numbers, and says so",
        parts: &[3],
        steps: Steps {
            callers_numbers: Some(|given, index| {
                let mut own = Random::for_ray(given.seed, index);
                (own.point(), own.number())
            }),
            ..LESSON
        },
        declares: |info| info.capabilities -= Capabilities::CALLERS_RANDOMNESS,
    },
    Different {
        name: "other-generator",
        summary: "random numbers come from another generator",
        parts: &[1, 3, 4, 5],
        steps: Steps {
            number: Some(|random| {
                random.name = random.name.wrapping_add(1);
                (scramble(random.name) >> 11) as f64 * 0.5 * f64::EPSILON
            }),
            ..LESSON
        },
        declares: NOTHING,
    },
    Different {
        name: "extra-dimensions",
        summary: "every second random number is thrown away",
        parts: &[1, 3, 4, 5],
        steps: Steps {
            number: Some(|random| {
                random::number(random);
                random::number(random)
            }),
            ..LESSON
        },
        declares: NOTHING,
    },
];

/// Where none is asked for, dark paths are cut short.
fn survival_of_own_roulette(roulette: Option<Roulette>, surface: &Surface, path: Progress) -> f64 {
    if roulette.is_none() && path.continuation >= 2 && !bsdf::is_delta(surface) {
        path.throughput.max_element().clamp(0.3, 1.0)
    } else {
        survival_probability(roulette, surface, path)
    }
}

/// Steps that fill the unit square evenly (Roberts 2018, the R2 sequence).
const EVEN_STEPS: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_2);

/// From a random start, as nobody's random numbers would.
fn evenly_in_pixel(random: &mut Random<'_>, seed: u64, pixel: usize, sample: u32) -> DVec2 {
    random.point();
    let start = Random::for_sample(seed, pixel, u32::MAX).point();
    (start + f64::from(sample) * EVEN_STEPS).fract()
}

/// Schlick's approximation of the cosine on the side of lower index.
pub(super) fn schlick_outside(cosine: f64, ratio: f64) -> f64 {
    let beyond = refracted_cosine(cosine, ratio).unwrap_or(cosine);
    schlick_reflectance(cosine, if ratio < 1.0 { beyond } else { cosine }, ratio)
}

/// Schlick's approximation of some cosine, for light that arrives at `cosine`; total reflection
/// stays total.
fn schlick_reflectance(cosine: f64, of: f64, ratio: f64) -> f64 {
    if refracted_cosine(cosine, ratio).is_none() {
        return 1.0;
    }
    let at_normal = ((1.0 - ratio) / (1.0 + ratio)).powi(2);
    at_normal + (1.0 - at_normal) * (1.0 - of).powi(5)
}

/// 1/(1 + Λ(wo) + Λ(wi)), with Λ = (√(1 + α² tan² θ) − 1)/2.
fn height_correlated_masking(roughness: f64, wo: DVec3, wi: DVec3) -> f64 {
    let lambda = |w: DVec3| {
        let tangent_squared = (w.x * w.x + w.y * w.y) / (w.z * w.z);
        ((1.0 + roughness * roughness * tangent_squared).sqrt() - 1.0) / 2.0
    };
    1.0 / (1.0 + lambda(wo) + lambda(wi))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::{rough_glass::RoughGlass, sampling};

    #[test]
    fn radiance_that_is_not_scaled_is_the_index_squared_brighter() {
        let unscaled = DIFFERENT.iter().find(|core| core.name == "unscaled-glass").expect("there");
        let (reflectance, transmittance) = ([1.0; 3], [1.0; 3]);
        let glass = RoughGlass { index: 1.5, roughness: 0.5, reflectance, transmittance };
        let mut random = Random::for_ray(1, 0);
        for _ in 0..1000 {
            let mut direction = || sampling::uniform_sphere(random.point());
            let (wo, wi) = (direction(), direction());
            let value = |steps| glass.evaluate(wo, wi, steps).f[0];
            let scale = match (wo.z * wi.z < 0.0, wo.z > 0.0) {
                (false, _) => 1.0,
                (true, true) => 2.25,
                (true, false) => 1.0 / 2.25,
            };
            let (plain, unscaled) = (value(&LESSON), value(&unscaled.steps));
            assert!((unscaled - scale * plain).abs() <= 1e-12 * unscaled, "{wo} {wi}");
        }
    }
}
