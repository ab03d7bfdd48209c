//! Direct lighting: light sampling (next event estimation) with shadow rays, or hemisphere sampling.

use super::integrator::Integrator;
use super::light::Light;
use super::mis::power_heuristic;
use super::reach::Reach;
use super::scatter::rgb;
use super::scatter::warp;
use super::vertex::Vertex;
use crate::contract::{DirectSampling, LightSample};
use glam::Vec3;

impl Integrator<'_> {
    /// An estimate of the radiance that the vertex scatters towards its viewer from all lights, without what
    /// the directions of a glossy surface find for themselves.
    pub(super) fn direct_light(&mut self, vertex: &Vertex<'_>) -> Vec3 {
        let by_hemisphere = self.settings.direct == DirectSampling::Hemisphere;
        let world = self.caster.world;
        let mut radiance = Vec3::ZERO;
        for light in &world.lights {
            if light.is_delta() || !by_hemisphere {
                radiance += self.sample_light(vertex, light);
            }
        }
        if by_hemisphere { radiance + self.sample_hemisphere(vertex) } else { radiance }
    }

    /// The mean over the samples that the light gets: one for a delta light.
    fn sample_light(&mut self, vertex: &Vertex<'_>, light: &Light) -> Vec3 {
        let samples = if light.is_delta() { 1 } else { self.settings.samples_per_light };
        let sum: Vec3 = (0..samples).map(|_| self.light_sample(vertex, light)).sum();
        sum / samples.max(1) as f32
    }

    fn light_sample(&mut self, vertex: &Vertex<'_>, light: &Light) -> Vec3 {
        let (point, lobe) = (self.stream.point(), self.stream.unit());
        let aim = light.aim_from_surface(vertex.position, vertex.light_reach(), point, lobe);
        let unoccluded = self.weigh(vertex, light, &aim.sample);
        if unoccluded == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let shadow_ray = match aim.target {
            Some(target) => vertex.reach(aim.sample.wi, target),
            None => vertex.leave(aim.sample.wi),
        };
        if self.caster.is_blocked(&shadow_ray) { Vec3::ZERO } else { unoccluded }
    }

    /// Scattered radiance of a light sample, if its shadow ray is not occluded.
    fn weigh(&self, vertex: &Vertex<'_>, light: &Light, sample: &LightSample) -> Vec3 {
        if sample.is_valid == 0 || sample.radiance == [0.0; 3] {
            return Vec3::ZERO;
        }
        let local = vertex.to_local(sample.wi);
        if !vertex.is_consistent(sample.wi, local) {
            return Vec3::ZERO;
        }
        let (f, pdf) = vertex.bsdf.evaluate(vertex.wo, local);
        // In double precision, because nearby points on a sphere see each other at grazing angles.
        let cosine = vertex.cosine(sample.wi);
        let share = if vertex.bsdf.is_glossy() && !light.is_delta() && self.combines() {
            power_heuristic(self.light_pdf(sample.pdf), f64::from(pdf))
        } else {
            1.0
        };
        let irradiance = sample.radiance.map(|channel| channel * (share * cosine / sample.pdf));
        f * rgb(irradiance)
    }

    /// Hemisphere sampling: uniform directions over the hemisphere, or the sphere, and the emission that they hit.
    fn sample_hemisphere(&mut self, vertex: &Vertex<'_>) -> Vec3 {
        let reachable = self.caster.world.lights.iter().filter(|light| !light.is_delta()).count();
        let samples = (self.settings.samples_per_light * reachable as u32).max(1);
        let sum: Vec3 = (0..samples).map(|_| self.hemisphere_sample(vertex)).sum();
        sum / samples as f32
    }

    fn hemisphere_sample(&mut self, vertex: &Vertex<'_>) -> Vec3 {
        let above = warp::uniform_hemisphere(warp::narrow_point(self.stream.point()));
        let (local, pdf) = match vertex.light_reach() {
            Reach::Above(_) => (above, warp::UNIFORM_PDF),
            Reach::Everywhere if self.stream.unit() < 0.5 => (above, 0.5 * warp::UNIFORM_PDF),
            Reach::Everywhere => (-above, 0.5 * warp::UNIFORM_PDF),
        };
        let wi = vertex.to_world(local);
        if !vertex.is_consistent(wi, local) {
            return Vec3::ZERO;
        }
        let (f, _) = vertex.bsdf.evaluate(vertex.wo, local);
        if f == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let seen = match self.caster.nearest(&vertex.leave(wi)) {
            Some(surface) => self.caster.world.emitted(&surface, -wi),
            None => self.caster.world.sky(wi),
        };
        f * seen * (local.z.abs() / pdf)
    }

    /// Whether light and BSDF samples are combined by multiple importance sampling.
    pub(super) fn combines(&self) -> bool {
        self.settings.direct == DirectSampling::Lights
    }

    /// The pdf of all samples of a light together.
    pub(super) fn light_pdf(&self, pdf: f64) -> f64 {
        pdf * f64::from(self.settings.samples_per_light)
    }
}
