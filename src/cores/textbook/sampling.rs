//! Part 3: directions of the uniform and the cosine-weighted hemisphere around +z, with their pdfs.
//!
//! Both are smooth maps of the unit square, so that a harness can check |∂ω/∂u| · pdf = 1 at every point.

use super::steps::Steps;
use crate::contract::{DirectionSample, Sampler};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// One direction of `sampler`, with its pdf per steradian.
pub(crate) fn sample(sampler: Sampler, point: DVec2, steps: &Steps) -> DirectionSample {
    let direction = direction(sampler, point, steps);
    DirectionSample { direction, pdf: pdf(sampler, direction, steps) }
}

/// One direction of `sampler`.
pub(crate) fn direction(sampler: Sampler, point: DVec2, steps: &Steps) -> DVec3 {
    let height = match sampler {
        Sampler::UniformHemisphere => steps.uniform_height(point.x),
        Sampler::CosineHemisphere => steps.cosine_height(point.x),
    };
    direction_at(height, steps.turn(point))
}

/// The pdf per steradian with which `sampler` draws `direction`; 0 below the horizon.
pub(crate) fn pdf(sampler: Sampler, direction: DVec3, steps: &Steps) -> f64 {
    if steps.is_below_horizon(direction) {
        return 0.0;
    }
    match sampler {
        Sampler::UniformHemisphere => steps.uniform_hemisphere_pdf(),
        Sampler::CosineHemisphere => steps.cosine_hemisphere_pdf(direction),
    }
}

/// Where no sampler draws a direction.
pub(crate) fn is_below_horizon(direction: DVec3) -> bool {
    direction.z <= 0.0
}

/// Archimedes: the height of a uniform point of the sphere is itself uniform. 1 − u is never 0.
pub(crate) fn uniform_height(u: f64) -> f64 {
    1.0 - u
}

/// 1/2π.
pub(crate) fn uniform_hemisphere_pdf() -> f64 {
    FRAC_1_PI / 2.0
}

/// Malley: a uniform point of the disk, lifted to the hemisphere.
pub(crate) fn cosine_height(u: f64) -> f64 {
    (1.0 - u).sqrt()
}

/// cos θ/π.
pub(crate) fn cosine_hemisphere_pdf(direction: DVec3) -> f64 {
    direction.z * FRAC_1_PI
}

/// Share of a full turn.
pub(crate) fn turn(point: DVec2) -> f64 {
    point.y
}

/// Uniform over the whole sphere.
pub(crate) fn uniform_sphere(point: DVec2) -> DVec3 {
    direction_at(1.0 - 2.0 * point.x, point.y)
}

/// 1/4π.
pub(crate) fn uniform_sphere_pdf() -> f64 {
    FRAC_1_PI / 4.0
}

/// The unit vector with height `cosine` over the plane, at `turn` of a full turn.
pub(crate) fn direction_at(cosine: f64, turn: f64) -> DVec3 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (2.0 * PI * turn).sin_cos();
    DVec3::new(sine * cos_phi, sine * sin_phi, cosine)
}
