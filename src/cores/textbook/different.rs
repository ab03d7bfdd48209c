//! Choices that are as right as those of the lecture: no case may fail them.
//!
//! Like a fault, a choice replaces steps of the lesson; some of them have to be declared, too.

use super::ggx::Microfacets;
use super::glass::refracted_cosine;
use super::integrator::{Progress, survival_probability};
use super::random::{self, Random, scramble};
use super::steps::{LESSON, Steps};
use super::{area_light, bsdf, vertex};
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

/// A table of choices: `"name": "what it does", parts [OF THE COURSE] declares what it has to say, STEP = what stands in
/// its place;`.
macro_rules! different {
    ($(
        $name:literal: $summary:literal, parts $parts:tt $(declares $declares:expr)?
        $(, $step:ident = $other:expr)*;
    )*) => {
        pub(crate) const DIFFERENT: &[Different] = &[$(Different {
            name: $name,
            summary: $summary,
            parts: &$parts,
            steps: Steps { $($step: Some($other),)* ..LESSON },
            declares: different!(declares $($declares)?),
        }),*];
    };
    (declares) => { NOTHING };
    (declares $declares:expr) => { $declares };
}
different! {
    "uniform-bounces": "the diffuse surface draws uniform directions, with their pdf",
        parts [3, 4, 5],
        diffuse_sampler = || Sampler::UniformHemisphere,
        diffuse_pdf_sampler = || Sampler::UniformHemisphere;
    "other-roulette": "dark paths are cut short by roulette of the core's own",
        parts [4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        survival_probability = survival_of_own_roulette;
    "hashed-seeds": "seeds are hashed before they are used",
        parts [1, 3, 4, 5],
        seed = scramble;
    "other-azimuth": "directions are turned the other way round, from another axis",
        parts [3, 4, 5],
        turn = |point| 0.75 - point.y;
    "cosine-of-root": "the cosine of a direction is the root of the number, and not of 1 less it",
        parts [3, 4, 5],
        cosine_height = f64::sqrt;
    "swapped-numbers": "points on lights use the second number first",
        parts [3, 4, 5],
        triangle_point = |point| area_light::triangle_point(DVec2::new(point.y, point.x));
    "larger-offset": "rays keep clear of surfaces by 1e-6 in place of 1e-10",
        parts [3, 4, 5],
        clearance = |longest| 1e4 * vertex::CLEARANCE * longest;
    "stratified-pixels": "the samples of a pixel fill it evenly",
        parts [1, 4, 5],
        pixel_point = evenly_in_pixel;
    "stratified-lights": "the samples of a light are stratified",
        parts [3, 4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        light_point = |random, number, of| {
            let point = random.point();
            point.with_x((f64::from(number) + point.x) / f64::from(of))
        };
    "median-split": "nodes are halved, whatever rule is asked for",
        parts [2],
        rule = |_| Split::Median;
    "reversed-leaves": "the primitives of a leaf are tested from the last to the first",
        parts [2],
        closest_among = |bvh, range, search| {
            range.rev().for_each(|primitive| bvh.test(primitive, search))
        };
    "single-precision": "every answer is rounded to f32, and the core says so",
        parts [1, 2, 3, 4, 5] declares |info| info.precision = Precision::Single;
    "schlick-glass": "Schlick's approximation of the view's cosine, declared",
        parts [3, 4] declares |info| info.conventions.glass_fresnel = GlassFresnel::Schlick,
        fresnel = |cosine, ratio| schlick_reflectance(cosine, cosine, ratio);
    "schlick-glass-outside": "Schlick's approximation of the cosine on the side of lower index, declared",
        parts [3, 4] declares |info| info.conventions.glass_fresnel = GlassFresnel::SchlickOutside,
        fresnel = schlick_outside;
    "correlated-smith": "the height-correlated Smith term, declared",
        parts [3, 4] declares |info| info.conventions.smith_term = SmithTerm::HeightCorrelated,
        metal_f = |Microfacets { distribution, roughness, wo, wi, .. }| {
            distribution * height_correlated_masking(*roughness, *wo, *wi) / (4.0 * wo.z * wi.z)
        },
        masking_over_cosines = |roughness, wo, wi| {
            height_correlated_masking(roughness, wo, wi) / (wo.z * wi.z)
        };
    "two-sided-emission": "emitters emit on both sides when they are seen, declared",
        parts [1, 3, 4] declares |info| info.conventions.emission = EmissionSides::Both,
        emits_towards = |_, _| true;
    "no-falloff": "point lights do not weaken with distance, declared",
        parts [3, 4] declares |info| info.conventions.point_light_falloff = Falloff::None,
        point_light_radiance = |intensity, _| intensity;
    "unscaled-glass": "radiance crosses glass unchanged, declared",
        parts [3, 4] declares |info| info.conventions.glass_radiance = GlassRadiance::Unscaled,
        radiance_scale = |_| 1.0,
        rough_radiance_scale = |ratio| ratio * ratio;
    "own-numbers": "the core draws its own random numbers, and says so",
        parts [3] declares |info| info.capabilities -= Capabilities::CALLERS_RANDOMNESS,
        callers_numbers = |given, index| {
            let mut own = Random::for_ray(given.seed, index);
            (own.point(), own.number())
        };
    "other-generator": "random numbers come from another generator",
        parts [1, 3, 4, 5],
        number = |random| {
            random.name = random.name.wrapping_add(1);
            (scramble(random.name) >> 11) as f64 * 0.5 * f64::EPSILON
        };
    "extra-dimensions": "every second random number is thrown away",
        parts [1, 3, 4, 5],
        number = |random| {
            random::number(random);
            random::number(random)
        };
}

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

/// Schlick's approximation of some cosine, for light that arrives at `cosine`; total reflection stays total.
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
