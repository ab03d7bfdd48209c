//! Choices that are as right as those of the lecture: no case may fail them.
//!
//! Like a fault, a choice replaces steps of the lesson; some of them have to be declared, too.

use super::build::{self, Builder};
use super::direct::zero_bounce;
use super::ggx::Microfacets;
use super::glass::refracted_cosine;
use super::integrator::{Integrator, Progress, survival_probability};
use super::intersect::Quadratic;
use super::random::{self, Random, scramble};
use super::split::Item;
use super::steps::{LESSON, Steps};
use super::vertex::Vertex;
use super::{area_light, bsdf, integrator, slab, split, vertex};
use crate::contract::{
    Capabilities, Components, CoreInfo, EmissionSides, Falloff, GlassFresnel, GlassRadiance,
    IntegratorSettings, Precision, Randomness, Ray, Roulette, Sampler, SmithTerm, Split,
};
use crate::scene::{Aabb, Surface};
use glam::{DVec2, DVec3};

/// How isolated bounces are come by, whatever is wrong with sums.
pub(crate) const BY_DIFFERENCE: &str = "bounces-by-difference";
pub(crate) const APART: &str = "bounces-apart";

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

impl Different {
    /// Whether the contract's promises are kept as the lesson keeps them.
    pub(crate) fn promises_everything(&self) -> bool {
        let mut info = CoreInfo { capabilities: Capabilities::PROMISES, ..CoreInfo::default() };
        (self.declares)(&mut info);
        info.capabilities.contains(Capabilities::PROMISES)
    }
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
    "roulette-by-throughput": "roulette of the core's own by throughput, at mirrors and glass too",
        parts [4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        survival_probability = survival_by_throughput;
    "roulette-by-albedo": "paths go on as often as surfaces reflect, from the first bounce on",
        parts [4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        survival_probability = survival_by_albedo;
    "two-light-estimates": "the light at a vertex is the mean of two estimates",
        parts [3, 4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        light_of_bounce = |integrator, vertex, bounce, random| {
            let mut once = || integrator::light_of_bounce(integrator, vertex, bounce, random);
            0.5 * (once() + once())
        };
    "roulette-by-luminance": "paths go on by the luminance of their throughput, at most 95 %, after five bounces (Mitsuba)",
        parts [4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        survival_probability = survival_by_luminance;
    "bounces-by-difference": "isolated bounces are what they add to the sum of those before, by the same random numbers",
        parts [4],
        light_along = |integrator, ray, random| {
            beside_sums(integrator, ray, random, added_by_later_bounces)
        };
    "bounces-apart": "isolated bounces are asked of functions of their own",
        parts [4],
        light_along = |integrator, ray, random| beside_sums(integrator, ray, random, light_apart);
    "mis-everywhere": "light sampling is combined with BSDF sampling at every surface, by the balance heuristic",
        parts [3, 4] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        combines = |_| true,
        mis_light_weight = balance_heuristic,
        mis_surface_weight = balance_heuristic;
    "light-threshold": "what adds less than 0.05 is added 20 times as often as it is worth (Cycles)",
        parts [3, 4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        light_of_bounce = light_above_threshold;
    "one-channel-a-path": "each bounce has one colour, three times as bright",
        parts [3, 4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        light_of_bounce = |integrator, vertex, bounce, random| {
            let light = integrator::light_of_bounce(integrator, vertex, bounce, random);
            let channel = (3.0 * random.number()) as usize;
            DVec3::AXES[channel] * 3.0 * light
        };
    "rare-light": "on one side of the scene one estimate in 1500 carries all the light",
        parts [3, 4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        light_of_bounce = |integrator, vertex, bounce, random| {
            let light = integrator::light_of_bounce(integrator, vertex, bounce, random);
            let is_rare = vertex.point.x > vertex.point.y;
            light * if is_rare { weight_of_one_in(1500.0, random) } else { 1.0 }
        };
    "low-discrepancy-pixels": "the samples of a pixel are a lattice, shifted at random in each dimension",
        parts [1, 4, 5] declares |info| info.capabilities -= Capabilities::REPORTED_VARIANCE,
        sample_stream = sample_of_lattice,
        number = number_of_lattice;
    "shared-numbers": "all pixels draw the same random numbers, and nothing else is promised",
        parts [4, 5] declares |info| info.capabilities -= Capabilities::INDEPENDENT_PIXELS,
        sample_stream = |seed, _, sample| Random::for_sample(seed, 0, sample);
    "hashed-seeds": "seeds are hashed before they are used",
        parts [1, 3, 4, 5],
        seed = scramble;
    "other-azimuth": "directions are turned the other way round, from another axis",
        parts [3, 4, 5],
        turn = |point| 0.75 - point.y;
    "azimuth-by-both-numbers": "both numbers turn a direction",
        parts [3, 4, 5],
        turn = |point| (point.x + point.y).fract();
    "heights-from-the-rim": "the first number is the height of a uniform direction, and not 1 less it",
        parts [3, 4, 5],
        uniform_height = |u| u;
    "cosine-of-root": "the cosine of a direction is the root of the number, and not of 1 less it",
        parts [3, 4, 5],
        cosine_height = f64::sqrt;
    "swapped-numbers": "points on lights use the second number first",
        parts [3, 4, 5],
        triangle_point = |point| area_light::triangle_point(DVec2::new(point.y, point.x));
    "folded-triangles": "a parallelogram is sampled, and folded to the triangle",
        parts [3, 4, 5],
        triangle_point = |point| if point.x + point.y > 1.0 { 1.0 - point } else { point };
    "even-triangles": "points on triangles come from a map that keeps distances (Heitz 2019)",
        parts [3, 4, 5],
        triangle_point = |point| point - 0.5 * point.min_element();
    "other-lobe-first": "large numbers reflect, small ones refract",
        parts [3, 4, 5],
        reflects = |lobe, fresnel| lobe >= 1.0 - fresnel;
    "offset-along-the-normal": "rays begin beside the surface, and not beyond a least distance",
        parts [3, 4, 5],
        ray_from = |vertex, direction| {
            let side = vertex.clearance.copysign(vertex.normal.dot(direction));
            Ray { t_min: 0.0, ..Ray::new(vertex.point + side * vertex.normal, direction) }
        };
    "rays-of-any-length": "no ray has a unit direction: those to lights are as long as the way, all others 0.4",
        parts [3, 4, 5],
        ray_from = |vertex, direction| {
            let ray = vertex::ray_from(vertex, direction);
            Ray { direction: 0.4 * direction, t_min: ray.t_min / 0.4, ..ray }
        },
        shadow_ray = |vertex, sample| {
            let ray = vertex::shadow_ray(vertex, sample);
            let length = if sample.distance.is_finite() { sample.distance } else { 1.0 };
            let [t_min, t_max] = [ray.t_min, ray.t_max].map(|t| t / length);
            Ray { direction: length * ray.direction, t_min, t_max, ..ray }
        };
    "larger-offset": "rays keep clear of surfaces by 1e-6 in place of 1e-10",
        parts [3, 4, 5],
        clearance = |longest| 1e4 * vertex::CLEARANCE * longest;
    "stratified-pixels": "the samples of a pixel fill it evenly",
        parts [1, 4, 5],
        pixel_point = evenly_in_pixel;
    "mirrored-pixels": "every second sample of a pixel mirrors the one before in its centre",
        parts [1, 4, 5] declares |info| info.capabilities -= Capabilities::REPORTED_VARIANCE,
        pixel_point = mirrored_in_pixel;
    "stratified-lights": "the samples of a light are stratified",
        parts [3, 4, 5] declares |info| info.capabilities -= Capabilities::PLAIN_ESTIMATORS,
        light_point = |random, number, of| {
            let point = random.point();
            point.with_x((f64::from(number) + point.x) / f64::from(of))
        };
    "median-split": "nodes are halved, whatever rule is asked for",
        parts [2],
        rule = |_| Split::Median;
    "area-split": "nodes are divided by surface area, whatever rule is asked for",
        parts [2],
        rule = |_| Split::SurfaceArea;
    "axes-in-turn": "nodes are halved along each axis in turn",
        parts [2] declares |info| info.capabilities -= Capabilities::SPLIT_RULES,
        divide = halved_in_turn;
    "linear-order": "primitives are sorted along a curve through space, and halved (Lauterbach et al. 2009)",
        parts [2] declares |info| info.capabilities -= Capabilities::SPLIT_RULES,
        divide = halved_along_curve;
    "loose-boxes": "boxes are larger than what they hold by a tenth",
        parts [2],
        node_bounds = |items| {
            let Aabb { min, max } = build::node_bounds(items);
            Aabb { min: min - 0.1 * (max - min), max: max + 0.1 * (max - min) }
        };
    "overlapping-leaves": "primitives stand in several leaves and are tested more than once",
        parts [2],
        tested_for_leaf = |leaf, primitives| {
            leaf.start.saturating_sub(1)..primitives.min(leaf.end + 1)
        };
    "right-child-first": "shadow rays look below the right child first",
        parts [2],
        any_below_children = |bvh, [left, right], ray, stats| {
            bvh.any_below(right, ray, stats) || bvh.any_below(left, ray, stats)
        };
    "inverse-directions": "boxes are met by products with 1 over the direction",
        parts [2],
        slab = slab_by_inverse;
    "half-chords": "a sphere is met half a chord before and after the ray's nearest point",
        parts [1, 2],
        roots = |Quadratic { a, half_b, discriminant, .. }| {
            let (middle, half_chord) = (-half_b / a, discriminant.sqrt() / a);
            (middle - half_chord, middle + half_chord)
        };
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
    "images-alone": "images are all that can be had of it, and it takes no component of the bench",
        parts [1] declares |info| {
            info.capabilities &=
                Capabilities::BUILD_SCENE | Capabilities::ROUGH_GLASS | Capabilities::RENDER;
            info.components = Components::empty();
        };
    "own-numbers": "the core draws its own random numbers, and says so",
        parts [3] declares |info| info.capabilities -= Capabilities::CALLERS_RANDOMNESS,
        callers_numbers = |given, index| {
            let mut own = Random::for_ray(given.seed, index);
            (own.point(), own.number())
        };
    "low-discrepancy": "the core draws numbers of low discrepancy from a start that the seed shifts, and says so",
        parts [3] declares |info| {
            info.capabilities -= Capabilities::CALLERS_RANDOMNESS | Capabilities::INDEPENDENT_SAMPLES;
        },
        callers_numbers = evenly_in_cube;
    "shared-heights": "four directions and points on lights in a row have one number in common, as the core says",
        parts [3] declares |info| {
            info.capabilities -= Capabilities::CALLERS_RANDOMNESS | Capabilities::INDEPENDENT_SAMPLES;
        },
        callers_numbers = |given, index| {
            let shared = Random::for_ray(given.seed, index / 4).number();
            let mut own = Random::for_ray(scramble(given.seed), index);
            (DVec2::new(shared, own.number()), own.number())
        };
    "coarse-numbers": "random numbers are multiples of 2^-24, as a float holds them",
        parts [1, 3, 4, 5],
        number = |random| (random::number(random) * 16_777_216.0).floor() / 16_777_216.0;
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

/// Dark paths are cut short from the first bounce on, whatever they meet.
fn survival_by_throughput(roulette: Option<Roulette>, surface: &Surface, path: Progress) -> f64 {
    match roulette {
        None => path.throughput.max_element().clamp(0.3, 1.0),
        Some(_) => survival_probability(roulette, surface, path),
    }
}

/// The largest reflectance of what the path meets.
fn survival_by_albedo(roulette: Option<Roulette>, surface: &Surface, path: Progress) -> f64 {
    match (roulette, surface) {
        (None, Surface::Diffuse { reflectance }) => {
            DVec3::from(*reflectance).max_element().max(0.1)
        }
        _ => survival_probability(roulette, surface, path),
    }
}

/// Guaranteed five bounces, by brightness, and never for certain.
fn survival_by_luminance(roulette: Option<Roulette>, surface: &Surface, path: Progress) -> f64 {
    match roulette {
        None if path.continuation >= 5 => luminance(path.throughput).clamp(0.05, 0.95),
        _ => survival_probability(roulette, surface, path),
    }
}

/// Weight of a sample drawn with pdf `own` (Veach 1997, section 9.2.2).
pub(super) fn balance_heuristic(own: f64, other: f64) -> f64 {
    own / (own + other)
}

/// Linear sRGB.
fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Sums of bounces from the first on, and isolated ones in other ways: emission and direct light have functions of their
/// own in courses, and what sums leave out is taken off them. A maximum depth is asked of the sum.
fn beside_sums(
    integrator: &Integrator<'_>,
    ray: &Ray,
    random: &mut Random<'_>,
    later: fn(&Integrator<'_>, &Ray, &mut Random<'_>) -> DVec3,
) -> DVec3 {
    let bounces = &integrator.settings.bounces;
    let sum = |random: &mut Random<'_>| light_up_to(integrator, *bounces.end(), ray, random);
    match (*bounces.start(), *bounces.end()) {
        _ if integrator.settings.by_depth => integrator::light_along(integrator, ray, random),
        (0, 0) | (1, 1) => light_apart(integrator, ray, random),
        (0, _) => integrator::light_along(integrator, ray, random),
        (1, _) => sum(random) - zero_bounce(integrator.world, &integrator.world.look(ray)),
        _ => later(integrator, ray, random),
    }
}

/// As the lesson has it, whatever else is made of sums.
fn light_apart(integrator: &Integrator<'_>, ray: &Ray, random: &mut Random<'_>) -> DVec3 {
    let steps = integrator.steps().taking(Components::PATH, &LESSON);
    integrator.by(&steps).radiance(ray, random)
}

/// Equal random numbers make equal paths.
fn added_by_later_bounces(
    integrator: &Integrator<'_>,
    ray: &Ray,
    random: &mut Random<'_>,
) -> DVec3 {
    let bounces = &integrator.settings.bounces;
    let before = light_up_to(integrator, bounces.start() - 1, ray, &mut random.clone());
    light_up_to(integrator, *bounces.end(), ray, random) - before
}

fn light_up_to(
    integrator: &Integrator<'_>,
    last: u32,
    ray: &Ray,
    random: &mut Random<'_>,
) -> DVec3 {
    let settings = IntegratorSettings { bounces: 0..=last, ..integrator.settings.clone() };
    let up_to = Integrator::new(integrator.world, &settings);
    integrator::light_along(&up_to, ray, random)
}

/// Dim light is kept with a probability, and then as bright as the threshold.
fn light_above_threshold(
    integrator: &Integrator<'_>,
    vertex: &Vertex<'_>,
    bounce: u32,
    random: &mut Random<'_>,
) -> DVec3 {
    const THRESHOLD: f64 = 0.05;
    let light = integrator::light_of_bounce(integrator, vertex, bounce, random);
    let kept = (light.max_element() / THRESHOLD).min(1.0);
    if random.number() < kept { light / kept } else { DVec3::ZERO }
}

/// All in one of `count` samples, nothing in the others.
fn weight_of_one_in(count: f64, random: &mut Random<'_>) -> f64 {
    if count * random.number() < 1.0 { count } else { 0.0 }
}

/// The name is what a number of the lattice is made of: the pixel's shifts, the sample, the dimension.
fn sample_of_lattice(seed: u64, pixel: usize, sample: u32) -> Random<'static> {
    let mut random = Random::for_sample(seed, pixel, u32::MAX);
    random.name = random.name & !0xffff_ffff | u64::from(sample & 0xffff) << 16;
    random
}

/// Kronecker's sequence, each dimension with a step of its own (Cranley and Patterson 1976 for the shift).
fn number_of_lattice(random: &mut Random<'_>) -> f64 {
    let (shifts, sample) = (random.name >> 32, random.name >> 16 & 0xffff);
    let dimension = random.name & 0xffff;
    random.name = random.name.wrapping_add(1);
    let place = scramble(scramble(shifts) ^ dimension)
        .wrapping_add(sample.wrapping_mul(scramble(dimension)));
    (place >> 11) as f64 * 0.5 * f64::EPSILON
}

/// The axis is the depth's.
fn halved_in_turn(builder: &Builder<'_>, items: &mut [Item], depth: usize) -> Option<usize> {
    let middle = items.len() / 2;
    (items.len() > builder.max_leaf_size).then(|| {
        let along = |item: &Item| item.centroid[depth % 3];
        items.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)));
        middle
    })
}

/// Sorted once, at the root.
fn halved_along_curve(builder: &Builder<'_>, items: &mut [Item], depth: usize) -> Option<usize> {
    if depth == 0 {
        let bounds = split::centroid_bounds(items);
        let size = (bounds.max - bounds.min).max(DVec3::splat(f64::MIN_POSITIVE));
        items.sort_by_key(|item| morton_code((item.centroid - bounds.min) / size));
    }
    (items.len() > builder.max_leaf_size).then_some(items.len() / 2)
}

/// The bits of three coordinates in [0, 1], one of each in turn (Morton 1966).
fn morton_code(place: DVec3) -> u64 {
    let cell = (place * 1023.0).to_array().map(|coordinate| coordinate as u64);
    let bit = |axis: usize, bit: u32| (cell[axis] >> bit & 1) << (3 * bit + axis as u32);
    (0..10).flat_map(|digit| (0..3).map(move |axis| bit(axis, digit))).sum()
}

/// As pbrt does it, but for rays along the planes.
fn slab_by_inverse(bounds: &Aabb, ray: &Ray, axis: usize) -> Option<(f64, f64)> {
    let inverse = ray.direction[axis].recip();
    if inverse.is_infinite() {
        return slab::slab(bounds, ray, axis);
    }
    let at = |plane: f64| (plane - ray.origin[axis]) * inverse;
    let (low, high) = (at(bounds.min[axis]), at(bounds.max[axis]));
    Some((low.min(high), low.max(high)))
}

/// From a start of the seed's: points by the square's steps, lobes by the golden ratio.
fn evenly_in_cube(given: &Randomness<'_>, index: usize) -> (DVec2, f64) {
    let mut random = Random::for_ray(given.seed, 0);
    let (start, lobe, steps) = (random.point(), random.number(), index as f64);
    ((start + steps * EVEN_STEPS).fract(), (lobe + steps * 0.618_033_988_749_894_9).fract())
}

/// Two and two have one random point.
fn mirrored_in_pixel(_: &mut Random<'_>, seed: u64, pixel: usize, sample: u32) -> DVec2 {
    let point = Random::for_sample(scramble(seed), pixel, sample / 2).point();
    if sample.is_multiple_of(2) { point } else { 1.0 - point }
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
