//! Part 3: directions of the hemisphere around +z, with their densities.
//!
//! Both are smooth maps of the unit square, so that a harness can check |∂ω/∂u| · pdf = 1 at every
//! point.

use super::change::Change;
use crate::contract::{DirectionSample, Sampler};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// One direction of `sampler`, with its density per steradian.
pub fn sample(sampler: Sampler, point: DVec2, change: Change) -> DirectionSample {
    let direction = match sampler {
        Sampler::UniformHemisphere => uniform_hemisphere(point, change),
        Sampler::CosineHemisphere => cosine_hemisphere(point, change),
    };
    DirectionSample { direction, pdf: pdf(sampler, direction, change) }
}

/// The density per steradian with which `sampler` draws `direction`; 0 below the horizon.
pub fn pdf(sampler: Sampler, direction: DVec3, change: Change) -> f64 {
    if direction.z <= 0.0 && change != Change::PdfBelowHorizon {
        return 0.0;
    }
    match sampler {
        Sampler::UniformHemisphere => uniform_hemisphere_pdf(change),
        Sampler::CosineHemisphere => cosine_hemisphere_pdf(direction, change),
    }
}

/// Archimedes: the height of a uniform point of the sphere is itself uniform. 1 − u is never 0.
pub fn uniform_hemisphere(point: DVec2, change: Change) -> DVec3 {
    let height = match change {
        Change::ThetaUniform => (FRAC_PI_2 * point.x).cos(),
        _ => 1.0 - point.x,
    };
    direction_at(height, turn(point, change))
}

/// Share of a full turn.
fn turn(point: DVec2, change: Change) -> f64 {
    match change {
        Change::HalfAzimuths => point.y / 2.0,
        Change::NumberTwice => point.x,
        _ => point.y,
    }
}

/// 1/2π.
pub fn uniform_hemisphere_pdf(change: Change) -> f64 {
    match change {
        Change::UniformPdfDoubled | Change::UniformPdfDoubledTwice => FRAC_1_PI,
        _ => FRAC_1_PI / 2.0,
    }
}

/// Malley: a uniform point of the disk, lifted to the hemisphere.
pub fn cosine_hemisphere(point: DVec2, change: Change) -> DVec3 {
    let height = match change {
        Change::CosineWithoutRoot => 1.0 - point.x,
        _ => (1.0 - point.x).sqrt(),
    };
    direction_at(height, turn(point, change))
}

/// cos θ/π.
pub fn cosine_hemisphere_pdf(direction: DVec3, change: Change) -> f64 {
    match change {
        Change::CosinePdfWithoutPi => direction.z,
        Change::CosinePdfUniform => FRAC_1_PI / 2.0,
        Change::PdfBelowHorizon => direction.z.abs() * FRAC_1_PI,
        _ => direction.z * FRAC_1_PI,
    }
}

/// Uniform over the whole sphere.
pub fn uniform_sphere(point: DVec2) -> DVec3 {
    direction_at(1.0 - 2.0 * point.x, point.y)
}

/// 1/4π.
pub fn uniform_sphere_pdf() -> f64 {
    FRAC_1_PI / 4.0
}

/// The unit vector with height `cosine` over the plane, at `turn` of a full turn.
pub fn direction_at(cosine: f64, turn: f64) -> DVec3 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (2.0 * PI * turn).sin_cos();
    DVec3::new(sine * cos_phi, sine * sin_phi, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLERS: [Sampler; 2] = [Sampler::UniformHemisphere, Sampler::CosineHemisphere];

    #[test]
    fn density_times_area_of_the_map_is_one() {
        let h = 1e-5;
        for sampler in SAMPLERS {
            for (u, v) in [(0.2, 0.3), (0.5, 0.9), (0.83, 0.61)] {
                let at = |x, y| sample(sampler, DVec2::new(x, y), Change::None).direction;
                let along_u = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
                let along_v = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
                let jacobian = along_u.cross(along_v).length();
                let product = jacobian * sample(sampler, DVec2::new(u, v), Change::None).pdf;
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
                        sample(sampler, DVec2::new(u, v), Change::None);
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
                    pdf(sampler, direction_at(z, 0.4), Change::None) * 2.0 * PI / f64::from(heights)
                })
                .sum();
            assert!((total - 1.0).abs() < 1e-12, "{sampler:?}: {total}");
        }
    }
}
