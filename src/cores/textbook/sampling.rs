//! Part 3: directions of the hemisphere around +z, with their densities.
//!
//! Both are smooth maps of the unit square, so that a harness can check |∂ω/∂u| · pdf = 1 at every point.

use super::steps::Steps;
use crate::contract::{DirectionSample, Sampler};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// One direction of `sampler`, with its density per steradian.
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

/// The density per steradian with which `sampler` draws `direction`; 0 below the horizon.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;

    const SAMPLERS: [Sampler; 2] = [Sampler::UniformHemisphere, Sampler::CosineHemisphere];

    #[test]
    fn density_times_area_of_the_map_is_one() {
        let h = 1e-5;
        for sampler in SAMPLERS {
            for (u, v) in [(0.2, 0.3), (0.5, 0.9), (0.83, 0.61)] {
                let at = |x, y| sample(sampler, DVec2::new(x, y), &LESSON).direction;
                let along_u = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
                let along_v = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
                let jacobian = along_u.cross(along_v).length();
                let product = jacobian * sample(sampler, DVec2::new(u, v), &LESSON).pdf;
                assert!((product - 1.0).abs() < 1e-7, "{sampler:?} at {u}, {v}: {product}");
            }
        }
    }

    #[test]
    fn extreme_numbers_give_unit_directions_above_the_horizon() {
        let almost_one = 1.0 - f64::EPSILON / 2.0;
        for sampler in SAMPLERS {
            for u in [0.0, f64::MIN_POSITIVE / 4.0, 0.5, almost_one] {
                for v in [0.0, almost_one] {
                    let DirectionSample { direction, pdf } =
                        sample(sampler, DVec2::new(u, v), &LESSON);
                    assert!((direction.length() - 1.0).abs() < 1e-15, "{sampler:?} {u} {v}");
                    assert!(direction.z > 0.0 && pdf > 0.0, "{sampler:?} {u} {v}: {pdf}");
                }
            }
        }
    }

    #[test]
    fn densities_integrate_to_one() {
        // The midpoint rule is exact for densities that are at most linear in the height.
        for sampler in SAMPLERS {
            let heights = 100;
            let total: f64 = (0..heights)
                .map(|i| (f64::from(i) + 0.5) / f64::from(heights))
                .map(|z| {
                    pdf(sampler, direction_at(z, 0.4), &LESSON) * 2.0 * PI / f64::from(heights)
                })
                .sum();
            assert!((total - 1.0).abs() < 1e-12, "{sampler:?}: {total}");
        }
    }
}
