//! Part 4: paths of many bounces.

use super::faults;
use crate::cause::integrator;
use crate::contract::Roulette;
use crate::cores::textbook as lesson;
use glam::DVec3;
use lesson::direct::zero_bounce;
use lesson::integrator::{
    Integrator, Progress, bounce_weight, light_of_bounce, survival_probability,
};
use lesson::random::Random;
use lesson::vertex::{Vertex, View};
use std::f64::consts::TAU;

const FURNACE: &str = "integrator/furnace-matches-geometric-series";
const ROULETTE: &str = "integrator/russian-roulette-leaves-the-mean-unchanged";

faults! { part 4;
    "depth-off-by-one": "-m N shows N − 1 bounces",
        fails FURNACE, told integrator::ONE_BOUNCE_SHORT,
        last_bounce = |bounces| match *bounces.end() {
            last @ (0 | 1) => last,
            last => last - 1,
        };
    "depth-ignored": "`depth − 1` of an unsigned 0: the limit is never met (24 bounces here)",
        fails FURNACE, told integrator::DEPTH_IGNORED,
        last_bounce = |bounces| match *bounces.end() {
            0 => 0,
            last => last.max(DEPTH_IGNORED),
        };
    "depth-not-counted": "the depth of a ray is never counted down: a limit of two bounces or more is none (48 here)",
        fails FURNACE, told integrator::DEPTH_IGNORED,
        last_bounce = |bounces| match *bounces.end() {
            last @ (0 | 1) => last,
            last => last.max(NOT_COUNTED),
        };
    "first-bounce-only": "est_radiance calls one_bounce only",
        fails FURNACE, told integrator::NO_INDIRECT,
        last_bounce = |bounces| *bounces.end().min(&1);
    "zero-depth-lit": "-m 0 shows direct light",
        fails FURNACE, told integrator::ZERO_DEPTH_LIT,
        last_bounce = |bounces| *bounces.end().max(&1);
    "emission-forgotten": "with bounces, the emission that the camera sees is left out",
        fails FURNACE, told integrator::EMISSION_LOST,
        shows_emission = |bounces| *bounces.end() == 0;
    "emission-every-bounce": "zero_bounce in the recursion, on top of light sampling",
        fails FURNACE, told integrator::EMISSION_AGAIN,
        path_meets_light = |surface, _, is_last| !is_last || lesson::bsdf::is_delta(surface);
    "light-met-for-ever-after-a-mirror":
        "the flag of a mirror is never taken back: light met behind it counts beside light sampling",
        fails "integrator/direct-light-in-a-mirror-is-counted-once",
        told integrator::SPECULAR_FLAG_KEPT,
        path_meets_light = |_, passed_delta, _| passed_delta;
    "mirror-shows-no-sky": "what leaves the scene after a mirror or glass is black",
        fails "integrator/smooth-mirror-reflects-by-its-shading-normals",
        told integrator::NO_ENVIRONMENT_AFTER_SPECULAR,
        light_met_by_path = |world, view| match view {
            View::Sky(_) => DVec3::ZERO,
            View::Surface(_) => zero_bounce(world, view),
        };
    "mirror-shows-no-light": "emission is not added after a mirror",
        fails "integrator/three-mirrors-multiply-their-reflectance",
        told integrator::NO_EMISSION_AFTER_SPECULAR,
        path_meets_light = |_, _, _| false;
    "isolation-ignored": "-o 0 has no effect: bounces before the one asked for remain",
        fails FURNACE, told integrator::ISOLATION_IGNORED,
        first_bounce = |_| 0;
    "direct-only-with-bounce": "direct light is added only if the bounce hits something",
        fails "integrator/plane-under-environment-has-one-bounce",
        told integrator::DIRECT_ONLY_WITH_BOUNCE,
        light_of_bounce = light_if_the_bounce_hits;
    "throughput-replaced": "throughput = weight, not *=",
        fails FURNACE, told integrator::WEIGHT_REPLACED,
        next_throughput = |_, weight| weight;
    "throughput-grey": "the weight of a bounce is averaged over the channels",
        fails FURNACE, told integrator::GREY_THROUGHPUT,
        bounce_weight = |f, sample, direction| {
            DVec3::splat(bounce_weight(f, sample, direction).element_sum() / 3.0)
        };
    "bounce-times-pdf": "a bounce is weighted with f cos θ · pdf",
        fails FURNACE, told integrator::BOUNCE_TIMES_PDF,
        bounce_weight = |f, sample, _| f * sample.wi.z.abs() * sample.pdf;
    "bounce-without-cosine": "a bounce is weighted with f/pdf",
        fails FURNACE, told integrator::BOUNCE_WITHOUT_COSINE,
        bounce_weight = |f, sample, _| f / sample.pdf;
    // Behind diffuse surfaces its weight |wz| / cos θ has no finite variance, and leaves open what it makes of the mean.
    "bounce-world-cosine": "the cosine of a bounce is wi.z in the world",
        fails "integrator/smooth-mirror-reflects-by-its-shading-normals",
        told integrator::BOUNCE_WORLD_COSINE,
        bounce_weight = |f, sample, direction| f * direction.z.abs() / sample.pdf;
    "bounce-local-direction": "the bounce is traced in its local direction: o2w is forgotten",
        fails "integrator/emissive-cap-matches-closed-form", told integrator::BOUNCE_DIRECTIONS,
        bounce_direction = |_, wi| wi;
    "roulette-not-divided": "who survives roulette is not divided by the probability",
        fails ROULETTE, told integrator::ROULETTE_NOT_DIVIDED,
        survival_divisor = |_, _| 1.0;
    "roulette-divided-by-stop": "who survives is divided by the probability of stopping",
        fails ROULETTE, told integrator::ROULETTE_DIVIDED_BY_STOP,
        survival_divisor = |roulette, survival| match roulette {
            Some(Roulette { stop, .. }) if survival < 1.0 => stop,
            _ => survival,
        };
    "roulette-divided-always": "the forced first bounce is divided too",
        fails ROULETTE, told integrator::ROULETTE_DIVIDED_WHEN_GUARANTEED,
        survival_divisor = |roulette, survival| {
            roulette.map_or(survival, |roulette| 1.0 - roulette.stop)
        };
    "roulette-not-played": "every path goes on to the last bounce",
        fails "integrator/russian-roulette-path-lengths-are-geometric",
        told integrator::ROULETTE_NOT_PLAYED,
        survival_probability = |_, _, _| 1.0;
    "roulette-stops-direct": "roulette is played before direct light is added",
        fails ROULETTE, told integrator::ROULETTE_STOPS_DIRECT,
        light_of_bounce = light_if_the_path_survives;
    "depth-one-more": "-m N shows N + 1 bounces",
        fails FURNACE, told integrator::ONE_BOUNCE_LONG,
        last_bounce = |bounces| match *bounces.end() {
            0 => 0,
            last => last + 1,
        };
    "albedo-twice": "the weight of a bounce is multiplied in again in the recursion",
        fails FURNACE, told integrator::ALBEDO_TWICE,
        next_throughput = |throughput, weight| throughput * weight * weight;
    "throughput-kept": "the throughput is never multiplied by the weight",
        fails FURNACE, told integrator::ALBEDO_FORGOTTEN,
        next_throughput = |throughput, _| throughput;
    "bounce-pdf-uniform": "bounces are sampled by the cosine and divided by 1/2π",
        fails FURNACE, told integrator::INDIRECT_FOUR_THIRDS,
        bounce_weight = |f, sample, direction| match sample.is_delta {
            1 => bounce_weight(f, sample, direction),
            _ => f * sample.wi.z.abs() * TAU,
        };
    "first-bounce-left-out": "with more bounces, direct light of the first vertex is left out",
        fails FURNACE, told integrator::BOUNCE_MISSING,
        counts = |bounces, bounce| bounces.contains(&bounce) && (bounce != 1 || *bounces.end() < 2);
    "last-bounce-only": "`L =` in place of `L +=`",
        fails FURNACE, told integrator::LAST_BOUNCE_ONLY,
        counts = |bounces, bounce| bounce == *bounces.end();
}

/// The bounces that are followed where a student's recursion would not end.
const DEPTH_IGNORED: u32 = 24;
/// The same where roulette ends it: of the furnace with an albedo of 0.9 half a percent is missing.
const NOT_COUNTED: u32 = 48;

/// Direct light counts if this is the last bounce, or if the next ray of the path finds a surface:
/// it is sent ahead, with the numbers that the path will go on with.
fn light_if_the_bounce_hits(
    integrator: &Integrator<'_>,
    vertex: &Vertex<'_>,
    bounce: u32,
    random: &mut Random<'_>,
) -> DVec3 {
    let direct = light_of_bounce(integrator, vertex, bounce, random);
    let next = integrator.continue_path(vertex, up_to(bounce), &mut random.clone());
    let hits = || next.is_some_and(|next| is_surface(&integrator.world.look(&next.ray)));
    if bounce == integrator.last_bounce() || hits() { direct } else { DVec3::ZERO }
}

/// Roulette before the light of the vertex is sampled.
fn light_if_the_path_survives(
    integrator: &Integrator<'_>,
    vertex: &Vertex<'_>,
    bounce: u32,
    random: &mut Random<'_>,
) -> DVec3 {
    let roulette = integrator.settings.roulette;
    if random.number() < survival_probability(roulette, vertex.surface, up_to(bounce)) {
        light_of_bounce(integrator, vertex, bounce, random)
    } else {
        DVec3::ZERO
    }
}

fn up_to(bounce: u32) -> Progress {
    Progress { continuation: bounce - 1, throughput: DVec3::ONE }
}

fn is_surface(view: &View<'_>) -> bool {
    matches!(view, View::Surface(_))
}
