//! Part 3: light that is scattered once, at a point that is given.
//!
//! Two estimators of one integral: uniform directions over the hemisphere, and points on the
//! lights. Not here: paths (`integrator`). Mirror and glass gather nothing here: what they show is
//! met by following the path.

use super::bsdf;
use super::change::Change;
use super::light::Lamp;
use super::random::Random;
use super::sampling;
use super::vertex::{Vertex, View};
use super::world::World;
use crate::contract::{DirectSampling, IntegratorSettings, LightSample, Ray, TraversalStats};
use crate::scene::Surface;
use glam::DVec3;

/// Radiance that leaves `vertex` along the path after being scattered there, and only there.
pub fn one_bounce(
    world: &World,
    settings: &IntegratorSettings,
    vertex: &Vertex<'_>,
    random: &mut Random,
) -> DVec3 {
    if bsdf::is_delta(vertex.surface) {
        return DVec3::ZERO;
    }
    let change = world.change();
    let scatter = Scatter { world, samples: settings.samples_per_light.max(1), vertex, change };
    let direct = match change {
        Change::HemisphereIgnored => DirectSampling::Lights,
        _ => settings.direct,
    };
    match direct {
        DirectSampling::Hemisphere => {
            scatter.by_hemisphere(random) + scatter.by_lights(random, Lamp::is_delta)
        }
        DirectSampling::Lights if is_glossy(vertex.surface) => {
            scatter.by_lights(random, |_| true) + scatter.by_surface(random)
        }
        DirectSampling::Lights => scatter.by_lights(random, |_| true),
    }
}

/// Whether light sampling alone would miss the narrow lobe of the surface. There it is combined
/// with directions that the surface itself samples.
fn is_glossy(surface: &Surface) -> bool {
    matches!(surface, Surface::Conductor { .. } | Surface::RoughGlass { .. })
}

/// One point of one path, gathering light.
struct Scatter<'a> {
    world: &'a World,
    /// Samples of each light that is not a delta light.
    samples: u32,
    vertex: &'a Vertex<'a>,
    change: Change,
}

impl Scatter<'_> {
    /// Mean over uniform directions of what glows where they arrive.
    fn by_hemisphere(&self, random: &mut Random) -> DVec3 {
        let lights = self.world.lights().iter().filter(|light| !light.is_delta()).count() as u32;
        let samples = match self.change {
            Change::HemisphereWithoutLights => self.samples * lights,
            _ => (self.samples * lights).max(1),
        };
        let total: DVec3 = (0..samples).map(|_| self.hemisphere_sample(random)).sum();
        match self.change {
            Change::HemisphereNotDivided => total,
            _ => total / f64::from(samples),
        }
    }

    fn hemisphere_sample(&self, random: &mut Random) -> DVec3 {
        let (wi, pdf) = self.uniform_direction(random);
        let arriving = self.glow_along(wi);
        let light = arriving * self.f_cosine(wi) / pdf;
        match self.change {
            Change::UniformPdfDoubledTwice => 2.0 * light,
            _ => light,
        }
    }

    /// From where the surface scatters light to the viewer: its side, or both where light passes.
    fn uniform_direction(&self, random: &mut Random) -> (DVec3, f64) {
        let point = random.point();
        if bsdf::is_interface(self.vertex.surface) {
            return (sampling::uniform_sphere(point), sampling::uniform_sphere_pdf());
        }
        let above = sampling::uniform_hemisphere(point, self.change);
        let wi = if self.vertex.wo.z < 0.0 { -above } else { above };
        (wi, sampling::uniform_hemisphere_pdf(self.change))
    }

    /// Radiance of the first thing in direction `wi` (local).
    fn glow_along(&self, wi: DVec3) -> DVec3 {
        let ray = match self.change {
            Change::HemisphereWorldDirection => Ray { direction: wi, ..self.vertex.ray(wi) },
            _ => self.vertex.ray(wi),
        };
        zero_bounce(self.world, &self.world.look(&ray))
    }

    /// f · |cos θ| for the local direction `wi`.
    fn f_cosine(&self, wi: DVec3) -> DVec3 {
        self.f(wi) * wi.z.abs()
    }

    /// For the local direction `wi`.
    fn f(&self, wi: DVec3) -> DVec3 {
        let value = bsdf::evaluate(self.vertex.surface, self.vertex.wo, wi, self.change);
        bsdf::corrected(self.vertex.surface, value.f, self.change)
    }

    /// Sum over the `wanted` lights of the mean over samples of each.
    fn by_lights(&self, random: &mut Random, wanted: impl Fn(&Lamp) -> bool) -> DVec3 {
        let lights = self.world.lights().iter().filter(|light| wanted(light));
        let count = lights.clone().count() as f64;
        let radiances = lights.map(|light| self.by_light(light, random));
        match self.change {
            Change::DividedInLoop => radiances
                .fold(DVec3::ZERO, |total, radiance| total / f64::from(self.samples) + radiance),
            Change::DividedByLights => radiances.sum::<DVec3>() / count.max(1.0),
            Change::LastLightOnly => radiances.last().unwrap_or(DVec3::ZERO),
            _ => radiances.sum(),
        }
    }

    /// A delta light is one direction: it needs no second sample.
    fn by_light(&self, light: &Lamp, random: &mut Random) -> DVec3 {
        let samples = if light.is_delta() { 1 } else { self.samples };
        let total: DVec3 =
            (0..samples).map(|number| self.light_sample(light, number, samples, random)).sum();
        match self.change {
            Change::DeltaDivided => total / f64::from(self.samples),
            _ => total / f64::from(samples),
        }
    }

    /// Sample number `number` of so many of a light.
    fn light_sample(&self, light: &Lamp, number: u32, of: u32, random: &mut Random) -> DVec3 {
        let (point, lobe) = (random.point(), random.number());
        let point = match self.change {
            Change::StratifiedLights => point.with_x((f64::from(number) + point.x) / f64::from(of)),
            _ => point,
        };
        let Some(sample) = light.sample(self.vertex.point, point, lobe, self.change) else {
            return DVec3::ZERO;
        };
        let wi = self.vertex.frame.to_local(sample.wi);
        let f_cosine = match self.change {
            Change::WorldCosine => self.f(wi) * sample.wi.z.abs(),
            _ => self.f_cosine(wi),
        };
        if f_cosine == DVec3::ZERO || self.is_shadowed(&sample) {
            return DVec3::ZERO;
        }
        let weight = self.light_weight(&sample);
        let light = weight * DVec3::from(sample.radiance) * f_cosine;
        match self.change {
            Change::LightTimesPdf => light * sample.pdf,
            _ => light / sample.pdf,
        }
    }

    fn is_shadowed(&self, sample: &LightSample) -> bool {
        if self.change == Change::NoShadows {
            return false;
        }
        let ray = self.vertex.shadow_ray(sample.wi, sample.distance);
        let ray = match self.change {
            Change::ShadowWithoutEnd if sample.is_delta == 1 => Ray { t_max: f64::INFINITY, ..ray },
            _ => ray,
        };
        self.world.any_hit(&ray, &mut TraversalStats::default())
    }

    /// What share of the light along a light sample is left to light sampling.
    fn light_weight(&self, sample: &LightSample) -> f64 {
        if sample.is_delta == 1 || !is_glossy(self.vertex.surface) {
            return 1.0;
        }
        let wi = self.vertex.frame.to_local(sample.wi);
        let value = bsdf::evaluate(self.vertex.surface, self.vertex.wo, wi, self.change);
        power_heuristic(sample.pdf, value.pdf)
    }

    /// The rest of the light on a glossy surface: along directions that the surface samples.
    fn by_surface(&self, random: &mut Random) -> DVec3 {
        let total: DVec3 = (0..self.samples).map(|_| self.surface_sample(random)).sum();
        total / f64::from(self.samples)
    }

    fn surface_sample(&self, random: &mut Random) -> DVec3 {
        let (point, lobe) = (random.point(), random.number());
        let (surface, wo) = (self.vertex.surface, self.vertex.wo);
        let Some(sample) = bsdf::sample(surface, wo, point, lobe, self.change) else {
            return DVec3::ZERO;
        };
        let arriving = match self.world.look(&self.vertex.ray(sample.wi)) {
            View::Surface(seen) => self.weighted_emission(&seen, sample.pdf),
            View::Sky(direction) => self.weighted_sky(direction, sample.pdf),
        };
        arriving * DVec3::from(sample.f) * sample.wi.z.abs() / sample.pdf
    }

    fn weighted_emission(&self, seen: &Vertex<'_>, surface_pdf: f64) -> DVec3 {
        let light_pdf = seen
            .light
            .map_or(0.0, |light| light.area_pdf(self.vertex.point, seen.point, seen.normal));
        power_heuristic(surface_pdf, light_pdf) * seen.emitted
    }

    fn weighted_sky(&self, direction: DVec3, surface_pdf: f64) -> DVec3 {
        let of_light = |light: &Lamp| {
            power_heuristic(surface_pdf, light.sky_pdf(self.change))
                * DVec3::from(light.sky_radiance(direction))
        };
        self.world.lights().iter().map(of_light).sum()
    }
}

/// Weight of a sample drawn with density `own` where another technique with as many samples has
/// density `other` (Veach 1997, section 9.2.4).
fn power_heuristic(own: f64, other: f64) -> f64 {
    own * own / (own * own + other * other)
}

/// Radiance that a view shows without any scattering: what glows, or the sky.
pub fn zero_bounce(world: &World, view: &View<'_>) -> DVec3 {
    match view {
        View::Surface(vertex) => vertex.emitted,
        View::Sky(direction) => world.sky_radiance(*direction),
    }
}
