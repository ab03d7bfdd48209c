//! Part 3: light that is scattered once, at a point that is given.
//!
//! Two estimators of one integral: uniform hemisphere sampling, and light sampling (next event estimation). Not here:
//! paths (`integrator`). Mirror and glass take no light samples here: what they show is met by following the path.

use super::bsdf;
use super::frame::Frame;
use super::light::Emitter;
use super::random::Random;
use super::sampling;
use super::steps::Steps;
use super::vertex::{Vertex, View};
use super::world::World;
use crate::contract::{DirectSampling, IntegratorSettings, LightSample, Sampler, TraversalStats};
use crate::scene::Surface;
use glam::{DVec2, DVec3};

/// Radiance that leaves `vertex` along the path after being scattered there, and only there.
pub(crate) fn one_bounce(
    world: &World<'_>,
    settings: &IntegratorSettings,
    vertex: &Vertex<'_>,
    random: &mut Random<'_>,
) -> DVec3 {
    if bsdf::is_delta(vertex.surface) {
        return DVec3::ZERO;
    }
    let steps = world.steps();
    let scatter = Scatter { world, samples: settings.samples_per_light.max(1), vertex, steps };
    match steps.direct_sampling(settings) {
        DirectSampling::Hemisphere => {
            scatter.by_hemisphere(random) + scatter.by_lights(random, Emitter::is_delta)
        }
        DirectSampling::Lights if steps.combines(vertex.surface) => {
            scatter.by_lights(random, |_| true) + scatter.by_surface(random)
        }
        DirectSampling::Lights => scatter.by_lights(random, |_| true),
    }
}

/// Which of the two estimators is asked for.
pub(crate) fn direct_sampling(settings: &IntegratorSettings) -> DirectSampling {
    settings.direct
}

/// Whether light sampling is combined with directions that the surface itself samples: alone it would miss a narrow lobe.
pub(crate) fn combines(surface: &Surface) -> bool {
    matches!(surface, Surface::Conductor { .. } | Surface::RoughGlass { .. })
}

/// One point of one path, where light is sampled.
struct Scatter<'a> {
    world: &'a World<'a>,
    /// Samples of each light that is not a delta light.
    samples: u32,
    vertex: &'a Vertex<'a>,
    steps: &'a Steps,
}

impl Scatter<'_> {
    /// Mean over uniform directions of what is emitted where they arrive.
    fn by_hemisphere(&self, random: &mut Random<'_>) -> DVec3 {
        let lights = self.world.lights().iter().filter(|light| !light.is_delta()).count() as u32;
        let samples = self.steps.hemisphere_samples(self.samples, lights);
        let total = (0..samples).map(|_| self.hemisphere_sample(random)).sum();
        self.steps.hemisphere_mean(total, samples)
    }

    fn hemisphere_sample(&self, random: &mut Random<'_>) -> DVec3 {
        let (wi, pdf) = self.uniform_direction(random.point());
        let direction = self.steps.hemisphere_direction(&self.vertex.frame, wi);
        let seen = self.world.look(&self.steps.ray_from(self.vertex, direction));
        self.steps.hemisphere_estimate(zero_bounce(self.world, &seen) * self.f_cosine(wi), pdf)
    }

    /// From where the surface scatters light to the viewer: its side, or both where light passes.
    fn uniform_direction(&self, point: DVec2) -> (DVec3, f64) {
        if bsdf::is_interface(self.vertex.surface) {
            return (sampling::uniform_sphere(point), sampling::uniform_sphere_pdf());
        }
        let above = sampling::direction(Sampler::UniformHemisphere, point, self.steps);
        let wi = if self.vertex.wo.z < 0.0 { -above } else { above };
        (wi, self.steps.uniform_hemisphere_pdf())
    }

    /// f · |cos θ| for the local direction `wi`.
    fn f_cosine(&self, wi: DVec3) -> DVec3 {
        self.f(wi) * wi.z.abs()
    }

    /// For the local direction `wi`.
    fn f(&self, wi: DVec3) -> DVec3 {
        let Vertex { surface, wo, .. } = *self.vertex;
        self.steps.scattered(surface, bsdf::evaluate(surface, wo, wi, self.steps).f)
    }

    /// Sum over the `wanted` lights of the mean over samples of each.
    fn by_lights(&self, random: &mut Random<'_>, wanted: impl Fn(&Emitter) -> bool) -> DVec3 {
        let lights = self.world.lights().iter().filter(|light| wanted(light));
        let mut radiances = lights.map(|light| self.by_light(light, random));
        self.steps.sum_over_lights(&mut radiances, self.samples)
    }

    /// A delta light is one direction: it needs no second sample.
    fn by_light(&self, light: &Emitter, random: &mut Random<'_>) -> DVec3 {
        let samples = if light.is_delta() { 1 } else { self.samples };
        let sample = |number| self.light_sample(light, number, samples, random);
        self.steps.light_mean((0..samples).map(sample).sum(), samples, self.samples)
    }

    /// Sample number `number` of so many of a light.
    fn light_sample(
        &self,
        light: &Emitter,
        number: u32,
        of: u32,
        random: &mut Random<'_>,
    ) -> DVec3 {
        let (point, lobe) = (self.steps.light_point(random, number, of), random.number());
        let Some(sample) = light.sample(self.vertex.point, point, lobe, self.steps) else {
            return DVec3::ZERO;
        };
        let wi = self.vertex.frame.to_local(sample.wi);
        let f = self.f(self.steps.lit_direction(wi, self.vertex.wo));
        let f_cosine = f * self.steps.light_cosine(wi, sample.wi);
        if f_cosine == DVec3::ZERO || self.is_shadowed(&sample) {
            return DVec3::ZERO;
        }
        let light = self.light_weight(&sample) * DVec3::from(sample.radiance) * f_cosine;
        self.steps.light_estimate(light, sample.pdf)
    }

    fn is_shadowed(&self, sample: &LightSample) -> bool {
        let ray = self.steps.shadow_ray(self.vertex, sample);
        self.world.any_hit(&ray, &mut TraversalStats::default())
    }

    /// What share of the light along a light sample is left to light sampling.
    fn light_weight(&self, sample: &LightSample) -> f64 {
        if sample.is_delta == 1 || !self.steps.combines(self.vertex.surface) {
            return 1.0;
        }
        let wi = self.vertex.frame.to_local(sample.wi);
        let value = bsdf::evaluate(self.vertex.surface, self.vertex.wo, wi, self.steps);
        self.steps.mis_light_weight(sample.pdf, value.pdf)
    }

    /// The rest of the light: along directions that the surface samples.
    fn by_surface(&self, random: &mut Random<'_>) -> DVec3 {
        let total: DVec3 = (0..self.samples).map(|_| self.surface_sample(random)).sum();
        total / f64::from(self.samples)
    }

    fn surface_sample(&self, random: &mut Random<'_>) -> DVec3 {
        let (point, lobe) = (random.point(), random.number());
        let Vertex { surface, wo, frame, .. } = *self.vertex;
        let Some(sample) = bsdf::sample(surface, wo, point, lobe, self.steps) else {
            return DVec3::ZERO;
        };
        let ray = self.steps.ray_from(self.vertex, frame.to_world(sample.wi));
        let arriving = match self.world.look(&ray) {
            View::Surface(seen) => self.weighted_emission(&seen, sample.pdf),
            View::Sky(direction) => self.weighted_sky(direction, sample.pdf),
        };
        arriving * DVec3::from(sample.f) * sample.wi.z.abs() / sample.pdf
    }

    fn weighted_emission(&self, seen: &Vertex<'_>, surface_pdf: f64) -> DVec3 {
        let pdf_of = |light: &Emitter| {
            light.area_pdf(self.vertex.point, seen.point, seen.normal, self.steps)
        };
        self.steps.mis_surface_weight(surface_pdf, seen.light.map_or(0.0, pdf_of)) * seen.emitted
    }

    fn weighted_sky(&self, direction: DVec3, surface_pdf: f64) -> DVec3 {
        let of_light = |light: &Emitter| {
            self.steps.mis_surface_weight(surface_pdf, light.sky_pdf(self.steps))
                * DVec3::from(light.sky_radiance(direction))
        };
        self.world.lights().iter().map(of_light).sum()
    }
}

/// As many directions as light sampling would draw points.
pub(crate) fn hemisphere_samples(per_light: u32, lights: u32) -> u32 {
    (per_light * lights).max(1)
}

/// Out in the world.
pub(crate) fn hemisphere_direction(frame: &Frame, wi: DVec3) -> DVec3 {
    frame.to_world(wi)
}

/// `light` is what arrives, times f · |cos θ|.
pub(crate) fn hemisphere_estimate(light: DVec3, pdf: f64) -> DVec3 {
    light / pdf
}

/// Over the directions.
pub(crate) fn hemisphere_mean(total: DVec3, samples: u32) -> DVec3 {
    total / f64::from(samples)
}

/// The numbers for sample `number` of so many of one light.
pub(crate) fn light_point(random: &mut Random<'_>, _number: u32, _of: u32) -> DVec2 {
    random.point()
}

/// The direction for which f is evaluated, for a light sample from `wi`.
pub(crate) fn lit_direction(wi: DVec3, _wo: DVec3) -> DVec3 {
    wi
}

/// |cos θ| at the surface, of a direction that is known in both frames.
pub(crate) fn light_cosine(local: DVec3, _world: DVec3) -> f64 {
    local.z.abs()
}

/// `light` is the light's radiance, times f · |cos θ|.
pub(crate) fn light_estimate(light: DVec3, pdf: f64) -> DVec3 {
    light / pdf
}

/// Over the samples of one light that were drawn; of a delta light that is one, whatever was asked for.
pub(crate) fn light_mean(total: DVec3, drawn: u32, _asked_for: u32) -> DVec3 {
    total / f64::from(drawn)
}

/// Light adds up. `each` are the means of the lights, of so many samples.
pub(crate) fn sum_over_lights(each: &mut dyn Iterator<Item = DVec3>, _samples: u32) -> DVec3 {
    each.sum()
}

/// MIS weight of a light sample, beside as many samples of the surface.
pub(crate) fn mis_light_weight(light_pdf: f64, surface_pdf: f64) -> f64 {
    power_heuristic(light_pdf, surface_pdf)
}

/// MIS weight of light that a direction sampled by the surface has met, beside as many light samples.
pub(crate) fn mis_surface_weight(surface_pdf: f64, light_pdf: f64) -> f64 {
    power_heuristic(surface_pdf, light_pdf)
}

/// Weight of a sample drawn with pdf `own` where another technique with as many samples has
/// pdf `other` (Veach 1997, section 9.2.4).
fn power_heuristic(own: f64, other: f64) -> f64 {
    own * own / (own * own + other * other)
}

/// Radiance that a view shows without any scattering: what is emitted there, or the sky.
pub(crate) fn zero_bounce(world: &World<'_>, view: &View<'_>) -> DVec3 {
    match view {
        View::Surface(vertex) => vertex.emitted,
        View::Sky(direction) => world.sky_radiance(*direction),
    }
}
