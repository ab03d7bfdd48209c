//! The table of contents of the lesson: its steps, each an ordinary function of the file that the row names.
//!
//! `steps.half_size(x)` does what `camera::half_size(x)` says, unless the table has another
//! function in that place. Only `fault` and `different` put one there; the rest of the core asks the
//! table and knows no more. Tables add up: what replaces different steps can be on together.
//!
//! A step is small enough to be wrong in one line, and its answer is the business of one sentence
//! of the course. Where nothing is replaced, the compiler sees the lesson's own function and inlines
//! it: the plain core pays one foreseeable branch a step.
//!
//! Each step belongs to a component of a path tracer, a few to two. A copy that takes a component
//! from the bench goes back to the lesson's own functions there.

use super::adaptive::Tally;
use super::build::Builder;
use super::bvh::{Bvh, Primitive, Search};
use super::frame::Frame;
use super::ggx::Microfacets;
use super::integrator::{Integrator, Progress};
use super::intersect::{Crossing, Quadratic, Sphere, Triangle};
use super::random::Random;
use super::rough_glass::RoughGlass;
use super::split::Item;
use super::spread::Spread;
use super::vertex::{Vertex, View};
use super::world::World;
use crate::contract::{
    AdaptiveSettings, BsdfSample, BsdfValue, Components, DirectSampling, Hit, IntegratorSettings,
    LightSample, Randomness, Ray, RenderSettings, Roulette, Sampler, Split, TraversalStats,
};
use crate::scene::{Aabb, Camera, Rgb, Surface};
use glam::{DVec2, DVec3};
use std::ops::{Range, RangeInclusive};

/// The table without anything in a step's place: the lesson itself.
pub(crate) const LESSON: Steps = Steps::LESSON;

macro_rules! steps {
    ($($component:expr => {
        $($module:ident::$step:ident($($argument:ident: $type:ty),*) $(-> $answer:ty)?;)*
    })*) => {
        /// What stands in place of each step, if anything does.
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct Steps {
            $($(pub $step: Option<fn($($type),*) $(-> $answer)?>,)*)*
        }

        impl Steps {
            const LESSON: Self = Self { $($($step: None,)*)* };

            $($(
                #[inline]
                pub(crate) fn $step(&self, $($argument: $type),*) $(-> $answer)? {
                    match self.$step {
                        None => super::$module::$step($($argument),*),
                        Some(other) => other($($argument),*),
                    }
                }
            )*)*

            /// What either table replaces.
            ///
            /// # Errors
            /// With the first step that both replace.
            pub(crate) fn and(&self, other: &Self) -> Result<Self, &'static str> {
                let mut both = *self;
                $($(
                    if other.$step.is_some() {
                        if both.$step.is_some() {
                            return Err(stringify!($step));
                        }
                        both.$step = other.$step;
                    }
                )*)*
                Ok(both)
            }

            /// The same with the steps of `components` as `other` has them.
            pub(crate) fn taking(mut self, components: Components, other: &Self) -> Self {
                $(if components.intersects($component) {
                    $(self.$step = other.$step;)*
                })*
                self
            }

            /// The components that have a step replaced.
            pub(crate) fn components(&self) -> Components {
                let mut components = Components::empty();
                $(if $(self.$step.is_some())||* {
                    components |= $component;
                })*
                components
            }

            /// The steps that are replaced, and all there are.
            #[cfg(test)]
            pub(crate) fn replaced(&self) -> (Vec<&'static str>, usize) {
                let all = [$($((stringify!($step), self.$step.is_some()),)*)*];
                let replaced = all.iter().filter(|(_, is_replaced)| *is_replaced);
                (replaced.map(|(step, _)| *step).collect(), all.len())
            }
        }
    };
}

steps! {
    // Part 1: camera rays.
    Components::CAMERA => {
        camera::fields_of_view(camera: &Camera) -> [f64; 2];
        camera::half_size(field_of_view: f64) -> f64;
        camera::sensor_point(camera: &Camera, film: DVec2, half_size: DVec2) -> DVec3;
        camera::turned_to_world(camera: &Camera, direction: DVec3) -> DVec3;
        camera::unit(direction: DVec3) -> DVec3;
        camera::clip_distances(camera: &Camera, direction: DVec3) -> (f64, f64);
    }
    // Part 1: the samples of a pixel.
    Components::PIXEL => {
        render::pixel_point(random: &mut Random<'_>, seed: u64, pixel: usize, sample: u32) -> DVec2;
        render::stratum(sample: u32, side: u32, jitter: DVec2) -> DVec2;
        render::film_point(settings: &RenderSettings, pixel: usize, within: DVec2) -> DVec2;
        render::pixel_mean(total: DVec3, samples: f64) -> DVec3;
    }
    // Part 1: triangle, sphere, and what a hit says.
    Components::TRIANGLE_TEST => {
        intersect::weight_error(
            triangle: &Triangle, ray: &Ray, from_corner: DVec3, determinant: f64
        ) -> Option<f64>;
        intersect::triangle_reached(ray: &Ray, t: f64) -> bool;
        intersect::triangle_holds(u: f64, v: f64, error: f64) -> bool;
        intersect::end_at_triangle(ray: &Ray, t: f64) -> f64;
        world::interpolated_normal(normals: [DVec3; 3], uv: DVec2) -> Option<DVec3>;
    }
    Components::SPHERE_TEST => {
        intersect::roots(quadratic: Quadratic) -> (f64, f64);
        intersect::nearer_root(ray: &Ray, near: f64, far: f64) -> Option<f64>;
        intersect::normal_taken_at(sphere: &Sphere, ray: &Ray, t: f64) -> f64;
        intersect::outward_normal(sphere: &Sphere, point: DVec3) -> DVec3;
    }
    Components::TRIANGLE_TEST.union(Components::SPHERE_TEST) => {
        world::hit(ray: &Ray, crossing: Crossing, numbers: [u32; 2], normals: [DVec3; 2]) -> Hit;
    }
    // Part 2: the box.
    Components::BOX_TEST => {
        slab::slab(bounds: &Aabb, ray: &Ray, axis: usize) -> Option<(f64, f64)>;
        slab::slabs_overlap(enter: f64, exit: f64, ray: &Ray) -> bool;
    }
    // Part 2: dividing and building.
    Components::TRAVERSAL => {
        split::rule(asked: Split) -> Split;
        split::longest_axis(extent: DVec3) -> usize;
        split::compared_axes(extent: DVec3) -> Range<usize>;
        build::divide(builder: &Builder<'_>, items: &mut [Item], depth: usize) -> Option<usize>;
        build::node_bounds(items: &[Item]) -> Aabb;
        build::leaf(first: usize, count: usize) -> Range<usize>;
        bvh::in_leaf_order(primitives: &[Primitive], order: &[usize]) -> Vec<Primitive>;
        // Part 2: the nearest hit.
        bvh::enter(search: &mut Search<'_>, bounds: &Aabb) -> Option<f64>;
        bvh::right_is_nearer(left: Option<f64>, right: Option<f64>) -> bool;
        bvh::is_worth_a_visit(search: &Search<'_>, enter: f64) -> bool;
        bvh::tested_for_leaf(leaf: &Range<usize>, primitives: usize) -> Range<usize>;
        bvh::closest_among(bvh: &Bvh<'_>, range: Range<usize>, search: &mut Search<'_>);
        bvh::keep(search: &mut Search<'_>, primitive: usize, crossing: Crossing);
        // Part 2: any hit.
        bvh::any(bvh: &Bvh<'_>, ray: &Ray, stats: &mut TraversalStats) -> bool;
        bvh::any_in_leaf(
            bvh: &Bvh<'_>, leaf: &Range<usize>, ray: &Ray, stats: &mut TraversalStats
        ) -> bool;
        bvh::any_below_children(
            bvh: &Bvh<'_>, children: [usize; 2], ray: &Ray, stats: &mut TraversalStats
        ) -> bool;
    }
    // Part 3: directions.
    Components::DIRECTION_SAMPLING => {
        sampling::is_below_horizon(direction: DVec3) -> bool;
        sampling::uniform_height(u: f64) -> f64;
        sampling::cosine_height(u: f64) -> f64;
        sampling::turn(point: DVec2) -> f64;
        sampling::uniform_hemisphere_pdf() -> f64;
        sampling::cosine_hemisphere_pdf(direction: DVec3) -> f64;
    }
    // Part 3: surfaces.
    Components::BSDF => {
        bsdf::scatters_light_from(wi: DVec3) -> bool;
        bsdf::diffuse(reflectance: Rgb, wi: DVec3) -> Rgb;
        bsdf::diffuse_sampler() -> Sampler;
        bsdf::diffuse_pdf_sampler() -> Sampler;
        bsdf::sampled(wi: DVec3, value: BsdfValue) -> BsdfSample;
        bsdf::mirror(wo: DVec3, reflectance: Rgb) -> Option<BsdfSample>;
        bsdf::scattered(surface: &Surface, f: Rgb) -> DVec3;
        // Part 4: metal and glass.
        ggx::alpha(roughness: f64) -> f64;
        ggx::metal_f(microfacets: &Microfacets) -> f64;
        ggx::metal_pdf(microfacets: &Microfacets) -> f64;
        glass::relative_index(index: f64, wo: DVec3) -> f64;
        glass::fresnel(cosine: f64, ratio: f64) -> f64;
        glass::reflects(lobe: f64, fresnel: f64) -> bool;
        glass::shares(fresnel: f64) -> (f64, f64);
        glass::radiance_scale(ratio: f64) -> f64;
        rough_glass::fresnel_cosine(wo: DVec3, microfacet: DVec3) -> f64;
        rough_glass::refraction_microfacet(glass: &RoughGlass, wo: DVec3, wi: DVec3) -> DVec3;
        rough_glass::refraction_jacobian(ratio: f64, i_m: f64, denominator: f64) -> f64;
        rough_glass::lobe_probability(share: f64) -> f64;
        rough_glass::masking_over_cosines(roughness: f64, wo: DVec3, wi: DVec3) -> f64;
        rough_glass::rough_radiance_scale(ratio: f64) -> f64;
    }
    // Part 3: lights.
    Components::LIGHT_SAMPLING => {
        light::point_light_radiance(intensity: Rgb, distance: f64) -> Rgb;
        light::towards_directional(direction: DVec3) -> DVec3;
        light::sky_pdf() -> f64;
        area_light::triangle_point(point: DVec2) -> DVec2;
        area_light::cosine_at_light(to_light: DVec3, normal: DVec3) -> f64;
        area_light::area_per_steradian(distance_squared: f64, cosine: f64) -> f64;
        area_light::mesh_pdf(area_per_steradian: f64, area: f64, triangles: usize) -> f64;
        area_light::cone_pdf(height: f64) -> f64;
        area_light::mesh_radiance(radiance: Rgb, to_light: DVec3, normal: DVec3) -> Rgb;
    }
    Components::EMISSION => {
        world::emits_towards(normal: DVec3, to_viewer: DVec3) -> bool;
    }
    // Part 3: direct light.
    Components::DIRECT_LIGHTING => {
        direct::direct_sampling(settings: &IntegratorSettings) -> DirectSampling;
        direct::hemisphere_samples(per_light: u32, lights: u32) -> u32;
        direct::hemisphere_direction(frame: &Frame, wi: DVec3) -> DVec3;
        direct::hemisphere_estimate(light: DVec3, pdf: f64) -> DVec3;
        direct::hemisphere_mean(total: DVec3, samples: u32) -> DVec3;
        direct::light_point(random: &mut Random<'_>, number: u32, of: u32) -> DVec2;
        direct::combines(surface: &Surface) -> bool;
        direct::mis_light_weight(light_pdf: f64, surface_pdf: f64) -> f64;
        direct::mis_surface_weight(surface_pdf: f64, light_pdf: f64) -> f64;
        direct::lit_direction(wi: DVec3, wo: DVec3) -> DVec3;
        direct::light_cosine(local: DVec3, world: DVec3) -> f64;
        direct::light_estimate(light: DVec3, pdf: f64) -> DVec3;
        direct::light_mean(total: DVec3, drawn: u32, asked_for: u32) -> DVec3;
        direct::sum_over_lights(each: &mut dyn Iterator<Item = DVec3>, samples: u32) -> DVec3;
        vertex::shadow_ray(vertex: &Vertex<'_>, sample: &LightSample) -> Ray;
    }
    Components::DIRECT_LIGHTING.union(Components::PATH) => {
        vertex::frame_normal(surface: &Surface, hit: &Hit, to_viewer: DVec3) -> DVec3;
        vertex::clearance(longest: f64) -> f64;
        vertex::ray_from(vertex: &Vertex<'_>, direction: DVec3) -> Ray;
    }
    // Part 4: bounces.
    Components::PATH => {
        integrator::light_along(integrator: &Integrator<'_>, ray: &Ray, random: &mut Random<'_>) -> DVec3;
        integrator::first_bounce(bounces: &RangeInclusive<u32>) -> u32;
        integrator::last_bounce(bounces: &RangeInclusive<u32>) -> u32;
        integrator::counts(bounces: &RangeInclusive<u32>, bounce: u32) -> bool;
        integrator::shows_emission(bounces: &RangeInclusive<u32>) -> bool;
        integrator::light_of_bounce(
            integrator: &Integrator<'_>, vertex: &Vertex<'_>, bounce: u32, random: &mut Random<'_>
        ) -> DVec3;
        integrator::path_meets_light(surface: &Surface, passed_delta: bool, is_last: bool) -> bool;
        integrator::light_met_by_path(world: &World<'_>, view: &View<'_>) -> DVec3;
        integrator::bounce_direction(frame: &Frame, wi: DVec3) -> DVec3;
        integrator::bounce_weight(f: DVec3, sample: &BsdfSample, direction: DVec3) -> DVec3;
        integrator::next_throughput(throughput: DVec3, weight: DVec3) -> DVec3;
        // Part 4: roulette.
        integrator::survival_probability(
            roulette: Option<Roulette>, surface: &Surface, path: Progress
        ) -> f64;
        integrator::survival_divisor(roulette: Option<Roulette>, survival: f64) -> f64;
    }
    // Part 5: when a pixel has enough samples.
    Components::PIXEL => {
        adaptive::batch_size(settings: AdaptiveSettings) -> u32;
        adaptive::sample_limit(cap: u32, batch: u32) -> u32;
        adaptive::count_in(tally: &mut Tally, luminance: f64);
        adaptive::variance(tally: &Tally) -> f64;
        adaptive::half_width(variance: f64, n: f64) -> f64;
        adaptive::tolerance(max_tolerance: f64, mean: f64) -> f64;
        // Part 5: what a pixel says of itself.
        adaptive::divisor(count: u32, cap: u32) -> f64;
        adaptive::reported_count(count: u32, cap: u32, batch: Option<u32>) -> u32;
        render::adaptive_settings(settings: &RenderSettings) -> Option<AdaptiveSettings>;
        spread::add(spread: &mut Spread, radiance: DVec3);
        spread::variance_of_mean(squared_deviations: DVec3, n: f64) -> DVec3;
    }
    // Part 5: random numbers.
    Components::RANDOM_NUMBERS => {
        random::seed(given: u64) -> u64;
        random::sample_stream(seed: u64, pixel: usize, sample: u32) -> Random<'static>;
        random::number(random: &mut Random<'_>) -> f64;
        random::callers_numbers(random: &Randomness<'_>, index: usize) -> (DVec2, f64);
    }
}
