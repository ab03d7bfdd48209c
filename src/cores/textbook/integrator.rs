//! Part 4: paths of any number of bounces.
//!
//! Light of bounce k has been scattered exactly k times on its way to the viewer, mirror and glass
//! included; bounce 0 is what glows where the ray arrives. At the k-th vertex of the path, the first
//! being number 1, the light of bounce k is gathered from the lights; so what glows where the path
//! itself goes on is not added again. Mirror and glass are the exception: no light can be sampled
//! there, and the path alone can meet one.

use super::bsdf;
use super::direct::{one_bounce, zero_bounce};
use super::random::Random;
use super::vertex::{Vertex, View};
use super::world::World;
use crate::contract::{IntegratorSettings, Ray, Roulette};
use glam::DVec3;

/// Estimates radiance along rays.
#[derive(Clone, Copy, Debug)]
pub struct Integrator<'a> {
    world: &'a World,
    settings: &'a IntegratorSettings,
}

/// How a path goes on from a vertex.
struct Continuation {
    ray: Ray,
    /// f · |cos θ| / pdf, over the probability of going on at all.
    weight: DVec3,
}

impl<'a> Integrator<'a> {
    /// For rays into `world`, traced as `settings` say.
    pub fn new(world: &'a World, settings: &'a IntegratorSettings) -> Self {
        Self { world, settings }
    }

    /// One estimate of the radiance that arrives along `ray`.
    pub fn radiance(&self, ray: &Ray, random: &mut Random) -> DVec3 {
        let view = self.world.look(ray);
        let seen = if self.wants(0) { zero_bounce(self.world, &view) } else { DVec3::ZERO };
        seen + self.at_least_one_bounce(view, random)
    }

    /// The light of bounces 1 and up. A loop in place of the course's recursion: a path between two
    /// perfect mirrors may have any length.
    fn at_least_one_bounce(&self, mut view: View<'a>, random: &mut Random) -> DVec3 {
        let mut radiance = DVec3::ZERO;
        let mut throughput = DVec3::ONE;
        for bounce in 1..=*self.settings.bounces.end() {
            let View::Surface(vertex) = &view else { break };
            if self.wants(bounce) {
                radiance += throughput * one_bounce(self.world, self.settings, vertex, random);
            }
            if !self.needs_continuation(vertex, bounce) {
                break;
            }
            let Some(next) = self.continue_path(vertex, bounce - 1, random) else { break };
            throughput *= next.weight;
            let meets_light = bsdf::is_delta(vertex.surface) && self.wants(bounce);
            view = self.world.look(&next.ray);
            if meets_light {
                radiance += throughput * zero_bounce(self.world, &view);
            }
        }
        radiance
    }

    /// Whether the light of this bounce is asked for: accumulated from 0, or isolated.
    fn wants(&self, bounce: u32) -> bool {
        self.settings.bounces.contains(&bounce)
    }

    /// Light of this very bounce comes over the continued path at mirror and glass, from lights
    /// elsewhere.
    fn needs_continuation(&self, vertex: &Vertex<'_>, bounce: u32) -> bool {
        bounce < *self.settings.bounces.end() || bsdf::is_delta(vertex.surface)
    }

    /// The ray after `vertex`; `continuation` counts such rays from 0. `None` where the path ends.
    fn continue_path(
        &self,
        vertex: &Vertex<'_>,
        continuation: u32,
        random: &mut Random,
    ) -> Option<Continuation> {
        let survival = self.survival_probability(continuation);
        let (survives, point, lobe) = (random.number() < survival, random.point(), random.number());
        if !survives {
            return None;
        }
        let sample = bsdf::sample(vertex.surface, vertex.wo, point, lobe)?;
        let weight = DVec3::from(sample.f) * sample.wi.z.abs() / sample.pdf;
        let is_black = weight == DVec3::ZERO;
        let ray = vertex.ray(sample.wi);
        (!is_black).then_some(Continuation { ray, weight: weight / survival })
    }

    /// Roulette is played at each continuation but the first `guaranteed` ones. The light of bounce
    /// k needs k − 1 continuations where no mirror is in the way: with `guaranteed` = 1, bounces 1
    /// and 2 never depend on roulette.
    fn survival_probability(&self, continuation: u32) -> f64 {
        match self.settings.roulette {
            Some(Roulette { stop, guaranteed }) if continuation >= guaranteed => 1.0 - stop,
            _ => 1.0,
        }
    }
}
