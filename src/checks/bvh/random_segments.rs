//! Random boxes, segments around them, and how they stand to each other.

use crate::contract::Ray;
use crate::math::rng::{Seed, Stream, in_cube, uniform};
use crate::math::sphere::on_sphere;
use crate::scene::Aabb;
use glam::DVec3;

pub(super) const RAYS_EACH: usize = 1000;

pub(super) struct Trial {
    pub(super) bounds: Aabb,
    pub(super) rays: Vec<Ray>,
}

impl Trial {
    /// Numbers that single precision holds, so that every core sees the same box.
    pub(super) fn random(seed: Seed) -> Self {
        let stream = &mut seed.stream();
        let size = 2f64.powi((uniform(stream) * 21.0) as i32 - 10);
        let corner = |stream: &mut Stream| size * (4.0 * in_cube(stream) - 2.0);
        let (a, b) = (single(corner(stream)), single(corner(stream)));
        let bounds = Aabb { min: a.min(b), max: a.max(b) };
        let rays = (0..RAYS_EACH).map(|_| segment(bounds, size, stream)).collect();
        Self { bounds, rays }
    }
}

fn single(vector: DVec3) -> DVec3 {
    vector.as_vec3().as_dvec3()
}

/// From anywhere around the box, towards a point of a box twice as large; every fourth runs in a
/// plane of two axes or along one.
fn segment(bounds: Aabb, size: f64, stream: &mut Stream) -> Ray {
    let middle = 0.5 * (bounds.min + bounds.max);
    let target = middle + 2.0 * (in_cube(stream) - 0.5) * (bounds.max - bounds.min);
    let reach = size * 8.0 * uniform(stream);
    let origin = single(target + reach * on_sphere(stream));
    let mut direction = (target - origin).normalize_or(DVec3::X);
    for axis in 0..3 {
        if uniform(stream) < 0.1 {
            direction[axis] = if uniform(stream) < 0.5 { 0.0 } else { -0.0 };
        }
    }
    let direction = single(direction.normalize_or(DVec3::Y));
    let ends = [uniform(stream), uniform(stream)].map(|end| f64::from((4.0 * size * end) as f32));
    let [t_min, t_max] = match (uniform(stream) * 4.0) as u32 {
        0 => [ends[0].min(ends[1]), ends[0].max(ends[1])],
        1 => [0.0, ends[0]],
        _ => [0.0, f64::INFINITY],
    };
    Ray { origin, t_min, direction, t_max }
}

/// How a segment and a box stand to each other, to rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Truth {
    /// They share a part that is long against rounding.
    Meet,
    /// There is room between them that is.
    Pass,
    /// Rounding may decide.
    Touch,
}

impl Truth {
    pub(super) fn of(bounds: &Aabb, ray: &Ray, margin: f64) -> Self {
        let (mut enters, mut exits) = (ray.t_min, ray.t_max);
        let mut touches = false;
        for axis in 0..3 {
            let [low, high, from, direction] =
                [bounds.min[axis], bounds.max[axis], ray.origin[axis], ray.direction[axis]];
            if direction == 0.0 {
                if from < low || from > high {
                    return Self::Pass;
                }
                touches |= from == low || from == high;
                continue;
            }
            let [a, b] = [(low - from) / direction, (high - from) / direction];
            enters = enters.max(a.min(b));
            exits = exits.min(a.max(b));
        }
        let size = if exits.is_finite() { enters.abs().max(exits.abs()) } else { enters.abs() };
        let overlap = exits - enters;
        if overlap < -margin * size {
            Self::Pass
        } else if overlap > margin * size && !touches {
            Self::Meet
        } else {
            Self::Touch
        }
    }
}
