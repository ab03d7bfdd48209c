//! Paths: one estimate of the radiance along a ray.
//!
//! Bounce k is light that was scattered k times. At a diffuse or rough vertex, light sampling (next event
//! estimation, `direct.rs`) adds the next bounce, and the path continues in a direction sampled from the BSDF; the
//! emission that it hits has been counted already. Delta lobes (mirror, smooth glass) allow no light sampling, so
//! there that emission is added. On rough conductors and dielectrics both are combined by multiple importance
//! sampling with the power heuristic, because either alone is noisy.

use super::mis::{GlossyDirection, power_heuristic};
use super::random::Stream;
use super::scatter::warp;
use super::trace::Surface;
use super::vertex::Vertex;
use super::world::{RayCaster, World};
use crate::contract::{IntegratorSettings, Ray};
use glam::{DVec3, Vec3};

pub(crate) struct Integrator<'a> {
    pub(super) caster: RayCaster<'a>,
    pub(super) settings: &'a IntegratorSettings,
    pub(super) stream: Stream,
}

/// What counts of the light that a ray of the path meets.
enum Sight {
    /// All of it: the camera's ray, and rays from mirrors and glass.
    All,
    /// Nothing: the vertex has sampled the lights.
    Nothing,
    /// Its weight by multiple importance sampling.
    Share(GlossyDirection),
}

struct Path {
    ray: Ray,
    /// Back along the ray, unit.
    wo: DVec3,
    /// The throughput: what radiance at the end of `ray` is worth at the camera.
    throughput: Vec3,
    sight: Sight,
}

impl<'a> Integrator<'a> {
    pub(crate) fn new(world: &'a World, settings: &'a IntegratorSettings) -> Self {
        Self { caster: RayCaster::new(world), settings, stream: Stream::new(settings.seed, 0, 0) }
    }

    /// One estimate of the radiance along `ray`, by the numbers of `stream`.
    pub(crate) fn radiance(&mut self, ray: &Ray, stream: Stream) -> Vec3 {
        self.stream = stream;
        let (first, last) = (*self.settings.bounces.start(), *self.settings.bounces.end());
        let wo = -ray.direction.normalize();
        let mut path = Path { ray: *ray, wo, throughput: Vec3::ONE, sight: Sight::All };
        let mut radiance = Vec3::ZERO;
        for bounce in 0..=last {
            let surface = self.caster.nearest(&path.ray);
            if bounce >= first {
                radiance += path.throughput * self.emission_seen(surface.as_ref(), &path);
            }
            let (Some(surface), true) = (&surface, bounce < last) else { break };
            let world = self.caster.world;
            let vertex = Vertex::new(surface, world.bsdf(surface), path.wo);
            if bounce + 1 >= first && !vertex.bsdf.is_delta() {
                radiance += path.throughput * self.direct_light(&vertex);
            }
            let Some(next) = self.go_on(path.throughput, &vertex, bounce + 1) else { break };
            path = next;
        }
        radiance
    }

    /// What counts of the light that the end of the path emits: a surface, or the environment if there is none.
    fn emission_seen(&self, surface: Option<&Surface>, path: &Path) -> Vec3 {
        let (world, wo) = (self.caster.world, path.wo);
        match (&path.sight, surface) {
            (Sight::Nothing, _) => Vec3::ZERO,
            (Sight::All, Some(surface)) => world.emitted(surface, wo),
            (Sight::All, None) => world.sky(-wo),
            (Sight::Share(direction), Some(surface)) => {
                let share = world.light_of(surface).map_or(1.0, |light| {
                    let pdf = light.pdf(direction.from, direction.reach, -wo, Some(surface));
                    power_heuristic(direction.pdf, self.light_pdf(pdf))
                });
                world.emitted(surface, wo) * share as f32
            }
            (Sight::Share(direction), None) => {
                let pdf = direction.reach.sky_pdf(-wo);
                world.sky(-wo) * power_heuristic(direction.pdf, self.light_pdf(pdf)) as f32
            }
        }
    }

    /// The path beyond a vertex where the light of `bounce` is scattered, if it is wanted and survives.
    fn go_on(&mut self, throughput: Vec3, vertex: &Vertex<'_>, bounce: u32) -> Option<Path> {
        let (first, last) = (*self.settings.bounces.start(), *self.settings.bounces.end());
        let carries_further = bounce < last || vertex.bsdf.is_delta();
        let shares = vertex.bsdf.is_glossy() && self.combines() && bounce >= first;
        if !(carries_further || shares) {
            return None;
        }
        let survival = if carries_further { self.play_roulette(bounce)? } else { 1.0 };
        let (point, lobe) = (self.stream.point(), self.stream.unit());
        let scattering =
            vertex.bsdf.sample(vertex.wo, warp::narrow_point(point), warp::narrow(lobe))?;
        let wi = vertex.to_world(scattering.wi);
        let throughput = throughput * scattering.weight / survival;
        if !vertex.is_consistent(wi, scattering.wi) || throughput == Vec3::ZERO {
            return None;
        }
        let sight = if vertex.bsdf.is_delta() {
            Sight::All
        } else if shares {
            let (from, reach) = (vertex.position, vertex.light_reach());
            Sight::Share(GlossyDirection { from, reach, pdf: f64::from(scattering.pdf) })
        } else {
            Sight::Nothing
        };
        Some(Path { ray: vertex.leave(wi), wo: -wi, throughput, sight })
    }

    /// The survival probability of Russian roulette at the `continuation`-th vertex, if the path survived.
    fn play_roulette(&mut self, continuation: u32) -> Option<f32> {
        match self.settings.roulette {
            Some(roulette) if continuation > roulette.guaranteed => {
                let survives = self.stream.unit() >= roulette.stop;
                survives.then_some((1.0 - roulette.stop) as f32)
            }
            _ => Some(1.0),
        }
    }
}
