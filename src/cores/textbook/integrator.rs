//! Part 4: paths of any number of bounces.
//!
//! Light of bounce k has been scattered exactly k times on its way to the viewer, mirror and glass
//! included; bounce 0 is what glows where the ray arrives. At the k-th vertex of the path, the first
//! being number 1, the light of bounce k is gathered from the lights; so what glows where the path
//! itself goes on is not added again. Mirror and glass are the exception: no light can be sampled
//! there, and the path alone can meet one.

use super::bsdf;
use super::change::Change;
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
    change: Change,
}

/// The bounces of [`Change::DepthIgnored`], which a student's recursion would not end.
const DEPTH_IGNORED: u32 = 24;

/// How a path goes on from a vertex.
struct Continuation {
    ray: Ray,
    /// f · |cos θ| / pdf, over the probability of going on at all.
    weight: DVec3,
}

impl<'a> Integrator<'a> {
    /// For rays into `world`, traced as `settings` say.
    pub fn new(world: &'a World, settings: &'a IntegratorSettings) -> Self {
        Self { world, settings, change: world.change() }
    }

    /// One estimate of the radiance that arrives along `ray`.
    pub fn radiance(&self, ray: &Ray, random: &mut Random) -> DVec3 {
        let view = self.world.look(ray);
        let is_lost = self.change == Change::EmissionForgotten && self.last_bounce() > 0;
        let seen =
            if self.wants(0) && !is_lost { zero_bounce(self.world, &view) } else { DVec3::ZERO };
        seen + self.at_least_one_bounce(view, random)
    }

    /// The light of bounces 1 and up. A loop in place of the course's recursion: a path between two
    /// perfect mirrors may have any length.
    fn at_least_one_bounce(&self, mut view: View<'a>, random: &mut Random) -> DVec3 {
        let mut radiance = DVec3::ZERO;
        let mut throughput = DVec3::ONE;
        for bounce in 1..=self.last_bounce() {
            let View::Surface(vertex) = &view else { break };
            let mut direct = DVec3::ZERO;
            if self.wants(bounce) && !self.stops_early(bounce - 1, random) {
                direct = throughput * one_bounce(self.world, self.settings, vertex, random);
            }
            if self.change != Change::DirectOnlyWithBounce || bounce == self.last_bounce() {
                radiance += direct;
            }
            if !self.needs_continuation(vertex, bounce) {
                break;
            }
            let Some(next) = self.continue_path(vertex, bounce - 1, throughput, random) else {
                break;
            };
            throughput = match self.change {
                Change::ThroughputReplaced => next.weight,
                _ => throughput * next.weight,
            };
            let meets_light = self.adds_emission(vertex, bounce) && self.wants(bounce);
            view = self.world.look(&next.ray);
            if self.change == Change::DirectOnlyWithBounce
                && bounce < self.last_bounce()
                && matches!(view, View::Surface(_))
            {
                radiance += direct;
            }
            if meets_light {
                radiance += throughput * zero_bounce(self.world, &view);
            }
        }
        radiance
    }

    /// Whether the light of this bounce is asked for: accumulated from 0, or isolated.
    fn wants(&self, bounce: u32) -> bool {
        match self.change {
            Change::IsolationIgnored => bounce <= *self.settings.bounces.end(),
            Change::DepthIgnored => *self.settings.bounces.start() <= bounce,
            Change::ZeroDepthLit if bounce == 1 => self.settings.bounces.start() <= &1,
            _ => self.settings.bounces.contains(&bounce),
        }
    }

    fn last_bounce(&self) -> u32 {
        let last = *self.settings.bounces.end();
        match self.change {
            Change::DepthOffByOne if last > 1 => last - 1,
            Change::DepthIgnored if last > 0 => last.max(DEPTH_IGNORED),
            Change::FirstBounceOnly => last.min(1),
            Change::ZeroDepthLit => last.max(1),
            _ => last,
        }
    }

    /// Whether what glows at the end of the next segment is light of the bounce at `vertex`.
    fn adds_emission(&self, vertex: &Vertex<'_>, bounce: u32) -> bool {
        match self.change {
            Change::EmissionEveryBounce if bounce < self.last_bounce() => true,
            Change::EmissionMissedInMirror => false,
            _ => bsdf::is_delta(vertex.surface),
        }
    }

    /// [`Change::RouletteStopsDirect`]: roulette before the light of the vertex is gathered.
    fn stops_early(&self, continuation: u32, random: &mut Random) -> bool {
        self.change == Change::RouletteStopsDirect
            && random.number() >= self.survival_probability(continuation)
    }

    /// Light of this very bounce comes over the continued path at mirror and glass, from lights
    /// elsewhere.
    fn needs_continuation(&self, vertex: &Vertex<'_>, bounce: u32) -> bool {
        bounce < self.last_bounce() || bsdf::is_delta(vertex.surface)
    }

    /// The ray after `vertex`; `continuation` counts such rays from 0. `None` where the path ends.
    fn continue_path(
        &self,
        vertex: &Vertex<'_>,
        continuation: u32,
        throughput: DVec3,
        random: &mut Random,
    ) -> Option<Continuation> {
        let survival = match self.change {
            Change::OtherRoulette => {
                self.own_survival_probability(vertex, continuation, throughput)
            }
            _ => self.survival_probability(continuation),
        };
        let (survives, point, lobe) = (random.number() < survival, random.point(), random.number());
        if !survives {
            return None;
        }
        let sample = bsdf::sample(vertex.surface, vertex.wo, point, lobe, self.change)?;
        let ray = vertex.ray(sample.wi);
        let f = bsdf::corrected(vertex.surface, sample.f, self.change);
        let weight = match self.change {
            Change::BounceTimesPdf => f * sample.wi.z.abs() * sample.pdf,
            Change::BounceWithoutCosine => f / sample.pdf,
            Change::BounceWorldCosine => f * ray.direction.z.abs() / sample.pdf,
            _ => f * sample.wi.z.abs() / sample.pdf,
        };
        let weight = match self.change {
            Change::ThroughputGrey => DVec3::splat(weight.element_sum() / 3.0),
            _ => weight,
        };
        let ray = match self.change {
            Change::BounceLocalDirection => Ray { direction: sample.wi, ..ray },
            _ => ray,
        };
        let is_black = weight == DVec3::ZERO;
        let weight = weight / self.divisor(survival);
        (!is_black).then_some(Continuation { ray, weight })
    }

    /// Whoever survives carries the light of those who do not.
    fn divisor(&self, survival: f64) -> f64 {
        let roulette = self.settings.roulette;
        match (self.change, roulette) {
            (Change::RouletteNotDivided, _) => 1.0,
            (Change::RouletteDividedByStop, Some(Roulette { stop, .. })) if survival < 1.0 => stop,
            (Change::RouletteDividedAlways, Some(Roulette { stop, .. })) => 1.0 - stop,
            _ => survival,
        }
    }

    /// [`Change::OtherRoulette`]: where none is asked for, dark paths are cut short.
    fn own_survival_probability(
        &self,
        vertex: &Vertex<'_>,
        continuation: u32,
        throughput: DVec3,
    ) -> f64 {
        let plays = self.settings.roulette.is_none()
            && continuation >= 2
            && !bsdf::is_delta(vertex.surface);
        if plays {
            throughput.max_element().clamp(0.3, 1.0)
        } else {
            self.survival_probability(continuation)
        }
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
