//! Part 4: paths of any number of bounces, for global illumination: direct and indirect lighting.
//!
//! Light of bounce k has been scattered exactly k times on its way to the viewer, mirror and glass included; bounce 0
//! is what is emitted where the ray arrives. At the k-th vertex of the path, the first being number 1, the light of
//! bounce k is sampled from the lights; so what is emitted where the path itself goes on is not added again. Mirror
//! and glass are the exception: no light can be sampled there, and the path alone can meet one.

use super::bsdf;
use super::direct::{one_bounce, zero_bounce};
use super::frame::Frame;
use super::random::Random;
use super::steps::Steps;
use super::vertex::{Vertex, View};
use super::world::World;
use crate::contract::{BsdfSample, IntegratorSettings, Ray, Roulette};
use crate::scene::Surface;
use glam::DVec3;
use std::ops::RangeInclusive;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Integrator<'a> {
    pub(crate) world: &'a World<'a>,
    /// How many bounces, by which estimator, with which roulette.
    pub(crate) settings: &'a IntegratorSettings,
    steps: &'a Steps,
}

/// How far a path has come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    /// The rays after the first, counted from 0.
    pub(crate) continuation: u32,
    /// The share of the light at its end that reaches the viewer.
    pub(crate) throughput: DVec3,
}

/// How a path goes on from a vertex.
pub(crate) struct Continuation {
    pub(crate) ray: Ray,
    /// f · |cos θ| / pdf, over the probability of going on at all.
    weight: DVec3,
}

impl<'a> Integrator<'a> {
    pub(crate) fn new(world: &'a World<'a>, settings: &'a IntegratorSettings) -> Self {
        Self { world, settings, steps: world.steps() }
    }

    /// One estimate of the radiance that arrives along `ray`.
    pub(crate) fn radiance(&self, ray: &Ray, random: &mut Random<'_>) -> DVec3 {
        self.steps.light_along(self, ray, random)
    }

    /// The same with other steps.
    pub(crate) fn by<'b>(&self, steps: &'b Steps) -> Integrator<'b>
    where
        'a: 'b,
    {
        Integrator { steps, ..*self }
    }

    pub(crate) const fn steps(&self) -> &'a Steps {
        self.steps
    }

    /// The light of bounces 1 and up. A loop in place of the course's recursion: a path between two
    /// perfect mirrors may have any length.
    fn at_least_one_bounce(&self, mut view: View<'a>, random: &mut Random<'_>) -> DVec3 {
        let mut radiance = DVec3::ZERO;
        let mut throughput = DVec3::ONE;
        let mut passed_delta = false;
        let last = self.last_bounce();
        for bounce in 1..=last {
            let View::Surface(vertex) = &view else { break };
            if self.wants(bounce) {
                radiance += throughput * self.steps.light_of_bounce(self, vertex, bounce, random);
            }
            if bounce == last && !bsdf::is_delta(vertex.surface) {
                break;
            }
            let path = Progress { continuation: bounce - 1, throughput };
            let Some(next) = self.continue_path(vertex, path, random) else { break };
            throughput = self.steps.next_throughput(throughput, next.weight);
            passed_delta |= bsdf::is_delta(vertex.surface);
            let is_last = bounce == last;
            let meets_light = self.steps.path_meets_light(vertex.surface, passed_delta, is_last);
            view = self.world.look(&next.ray);
            if meets_light && self.wants(bounce) {
                radiance += throughput * self.steps.light_met_by_path(self.world, &view);
            }
        }
        radiance
    }

    fn wants(&self, bounce: u32) -> bool {
        self.steps.counts(&self.bounces(), bounce)
    }

    fn bounces(&self) -> RangeInclusive<u32> {
        self.steps.first_bounce(&self.settings.bounces)..=self.last_bounce()
    }

    /// Beyond it nothing is followed but mirror and glass.
    pub(crate) fn last_bounce(&self) -> u32 {
        self.steps.last_bounce(&self.settings.bounces)
    }

    /// The ray after `vertex`. `None` where the path ends.
    pub(crate) fn continue_path(
        &self,
        vertex: &Vertex<'_>,
        path: Progress,
        random: &mut Random<'_>,
    ) -> Option<Continuation> {
        let Vertex { surface, wo, frame, .. } = *vertex;
        let roulette = self.settings.roulette;
        let survival = self.steps.survival_probability(roulette, surface, path);
        let (survives, point, lobe) = (random.number() < survival, random.point(), random.number());
        if !survives {
            return None;
        }
        let sample = bsdf::sample(surface, wo, point, lobe, self.steps)?;
        let f = self.steps.scattered(surface, sample.f);
        let weight = self.steps.bounce_weight(f, &sample, frame.to_world(sample.wi));
        let ray = self.steps.ray_from(vertex, self.steps.bounce_direction(&frame, sample.wi));
        let is_black = weight == DVec3::ZERO;
        let weight = weight / self.steps.survival_divisor(roulette, survival);
        (!is_black).then_some(Continuation { ray, weight })
    }
}

/// The light of the bounces that are asked for.
pub(crate) fn light_along(
    integrator: &Integrator<'_>,
    ray: &Ray,
    random: &mut Random<'_>,
) -> DVec3 {
    let Integrator { world, steps, .. } = *integrator;
    let view = world.look(ray);
    let shows_emission = integrator.wants(0) && steps.shows_emission(&integrator.bounces());
    let seen = if shows_emission { zero_bounce(world, &view) } else { DVec3::ZERO };
    seen + integrator.at_least_one_bounce(view, random)
}

/// The first bounce that is asked for: 0 where they are accumulated, the last one where it is isolated.
pub(crate) fn first_bounce(bounces: &RangeInclusive<u32>) -> u32 {
    *bounces.start()
}

pub(crate) fn last_bounce(bounces: &RangeInclusive<u32>) -> u32 {
    *bounces.end()
}

/// Whether the light of this bounce is part of the sum.
pub(crate) fn counts(bounces: &RangeInclusive<u32>, bounce: u32) -> bool {
    bounces.contains(&bounce)
}

/// Whether emission that the camera sees is, where bounce 0 counts.
pub(crate) fn shows_emission(_bounces: &RangeInclusive<u32>) -> bool {
    true
}

/// The light of this very bounce, from the lights.
pub(crate) fn light_of_bounce(
    integrator: &Integrator<'_>,
    vertex: &Vertex<'_>,
    _bounce: u32,
    random: &mut Random<'_>,
) -> DVec3 {
    one_bounce(integrator.world, integrator.settings, vertex, random)
}

/// Whether what is emitted at the end of the next segment is light of the bounce at this surface:
/// at mirror and glass it comes over the path, whatever surfaces that has passed before.
pub(crate) fn path_meets_light(surface: &Surface, _passed_delta: bool, _is_last: bool) -> bool {
    bsdf::is_delta(surface)
}

/// What a path sees that meets a light.
pub(crate) fn light_met_by_path(world: &World<'_>, view: &View<'_>) -> DVec3 {
    zero_bounce(world, view)
}

/// Out in the world.
pub(crate) fn bounce_direction(frame: &Frame, wi: DVec3) -> DVec3 {
    frame.to_world(wi)
}

/// f · |cos θ| / pdf of a sample, which leads in this `direction` of the world.
pub(crate) fn bounce_weight(f: DVec3, sample: &BsdfSample, _direction: DVec3) -> DVec3 {
    f * sample.wi.z.abs() / sample.pdf
}

/// The weights of all bounces so far multiply.
pub(crate) fn next_throughput(throughput: DVec3, weight: DVec3) -> DVec3 {
    throughput * weight
}

/// Roulette is played at each continuation but the first `guaranteed` ones. The light of bounce k needs k − 1
/// continuations where no mirror is in the way: with `guaranteed` = 1, bounces 1 and 2 never depend on roulette.
pub(crate) fn survival_probability(
    roulette: Option<Roulette>,
    _surface: &Surface,
    path: Progress,
) -> f64 {
    match roulette {
        Some(Roulette { stop, guaranteed }) if path.continuation >= guaranteed => 1.0 - stop,
        _ => 1.0,
    }
}

/// Whoever survives carries the light of those who do not.
pub(crate) fn survival_divisor(_roulette: Option<Roulette>, survival: f64) -> f64 {
    survival
}
