//! Closed diffuse cavities: furnaces whose every bounce is known.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Radiance of one bounce in a closed cavity of uniform albedo and emission. Every point sees the
/// same radiance in every direction, so each bounce multiplies by the albedo.
pub fn furnace_bounce(emission: f64, albedo: f64, bounce: u32) -> f64 {
    emission * power(albedo, bounce)
}

/// Radiance of these bounces together: a piece of the geometric series.
pub fn furnace(emission: f64, albedo: f64, bounces: RangeInclusive<u32>) -> f64 {
    bounces.map(|bounce| furnace_bounce(emission, albedo, bounce)).sum()
}

/// Radiance of all bounces.
pub fn furnace_total(emission: f64, albedo: f64) -> f64 {
    emission / (1.0 - albedo)
}

/// The share of a sphere's area that a cap of this polar half angle covers.
pub fn cap_fraction(half_angle: f64) -> f64 {
    0.5 * (1.0 - half_angle.cos())
}

/// Radiance of one bounce in a spherical cavity that glows only on a cap, at any point outside the
/// cap.
///
/// Between two points inside a sphere of radius R, cos θ cos θ′ / (π r²) = 1 / (4πR²): light
/// spreads evenly over the whole sphere at the first bounce already. Bounce 0 is 0, the cap being
/// elsewhere.
pub fn cap_cavity_bounce(emission: f64, albedo: f64, half_angle: f64, bounce: u32) -> f64 {
    if bounce == 0 {
        return 0.0;
    }
    emission * cap_fraction(half_angle) * power(albedo, bounce)
}

/// Radiance of all bounces there.
pub fn cap_cavity_total(emission: f64, albedo: f64, half_angle: f64) -> f64 {
    emission * cap_fraction(half_angle) * albedo / (1.0 - albedo)
}

/// Two concentric spheres; the outer one, seen from inside, glows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConcentricSpheres {
    /// Radiance that the outer sphere emits.
    pub emission: f64,
    /// Radius of the inner over that of the outer sphere.
    pub radius_ratio: f64,
    /// Of the inner sphere.
    pub inner_albedo: f64,
    /// Of the outer sphere.
    pub outer_albedo: f64,
}

/// Radiance leaving both spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InnerAndOuter {
    /// Leaving the inner sphere.
    pub inner: f64,
    /// Leaving the outer sphere, emission included.
    pub outer: f64,
}

impl ConcentricSpheres {
    /// Form factor from the outer to the inner sphere: the ratio of areas, by reciprocity with F₁₂
    /// = 1.
    fn outer_to_inner(&self) -> f64 {
        self.radius_ratio * self.radius_ratio
    }

    /// One bounce more of a given radiance.
    fn scattered(&self, from: InnerAndOuter) -> InnerAndOuter {
        let to_inner = self.outer_to_inner();
        InnerAndOuter {
            inner: self.inner_albedo * from.outer,
            outer: self.outer_albedo * (to_inner * from.inner + (1.0 - to_inner) * from.outer),
        }
    }

    /// Radiance with bounces up to this one.
    pub fn up_to(&self, bounce: u32) -> InnerAndOuter {
        let emitted = InnerAndOuter { inner: 0.0, outer: self.emission };
        let (mut last, mut sum) = (emitted, emitted);
        for _ in 0..bounce {
            last = self.scattered(last);
            sum = InnerAndOuter { inner: sum.inner + last.inner, outer: sum.outer + last.outer };
        }
        sum
    }

    /// Radiance with all bounces: L₂ = Lₑ / (1 − ρ₂ (F₂₂ + F₂₁ ρ₁)), L₁ = ρ₁ L₂.
    pub fn total(&self) -> InnerAndOuter {
        let to_inner = self.outer_to_inner();
        let kept = self.outer_albedo * (1.0 - to_inner + to_inner * self.inner_albedo);
        let outer = self.emission / (1.0 - kept);
        InnerAndOuter { inner: self.inner_albedo * outer, outer }
    }
}

/// Mean over the unit square around its centre of the radiance of a Lambertian sphere that fills
/// it, lit by a directional light of irradiance `irradiance` (at normal incidence) at phase angle
/// `phase`.
///
/// The phase integral of a Lambertian sphere, 2/(3π) (sin g + (π − g) cos g) (Lambert 1760), times
/// ρE/π, over the disk that covers π/4 of the square.
pub fn lit_sphere_mean(irradiance: f64, albedo: f64, phase: f64) -> f64 {
    let phase_integral = 2.0 / (3.0 * PI) * (phase.sin() + (PI - phase) * phase.cos());
    albedo * irradiance / PI * phase_integral * PI / 4.0
}

fn power(albedo: f64, bounce: u32) -> f64 {
    // Bounces beyond i32 are as good as none.
    albedo.powi(i32::try_from(bounce).unwrap_or(i32::MAX))
}

#[cfg(test)]
mod tests {
    use super::super::witness::{assert_close, kernel, over};
    use super::*;
    use crate::math::frame::direction;
    use glam::{DVec2, DVec3};

    #[test]
    fn the_bounces_of_a_furnace_are_those_of_the_table() {
        for (bounce, expected) in [(0, 0.7), (1, 0.259), (2, 0.09583), (3, 0.0354571)] {
            assert_close(furnace_bounce(0.7, 0.37, bounce), expected, 1e-12);
        }
        assert_close(furnace(0.7, 0.37, 0..=3), 1.090_287_1, 1e-12);
        assert_close(furnace(0.7, 0.37, 0..=200), furnace_total(0.7, 0.37), 1e-12);
        assert_close(furnace_total(0.7, 0.37), 1.111_111_111_111, 1e-12);
    }

    /// Irradiance over π at a point of the sphere, from its cap around +z: the defining integral.
    fn from_cap(point: DVec3, half_angle: f64) -> f64 {
        over(DVec2::ZERO, DVec2::new(half_angle, 2.0 * PI), |p| {
            let on_cap = direction(p.x, p.y);
            kernel(-point, on_cap - point, -on_cap) * p.x.sin()
        })
    }

    #[test]
    fn a_cap_lights_every_point_of_its_sphere_equally() {
        let half_angle = 40f64.to_radians();
        for point in [direction(1.0, 0.3), direction(2.0, 4.0), direction(PI, 0.0)] {
            assert_close(from_cap(point, half_angle), cap_fraction(half_angle), 1e-8);
        }
    }

    #[test]
    fn the_bounces_of_a_cap_cavity_are_those_of_the_table() {
        let half_angle = 40f64.to_radians();
        let bounce = |m| cap_cavity_bounce(3.0, 0.6, half_angle, m);
        assert_eq!(bounce(0), 0.0);
        for (m, expected) in [(1, 0.210_560_001_2), (2, 0.126_336_000_7), (3, 0.075_801_600_43)] {
            assert_close(bounce(m), expected, 1e-9);
        }
        let series: f64 = (0..200).map(bounce).sum();
        assert_close(cap_cavity_total(3.0, 0.6, half_angle), series, 1e-12);
        assert_close(series, 0.526_400_003, 1e-9);
    }

    #[test]
    fn concentric_spheres_converge_to_their_total_and_match_the_table() {
        let spheres = ConcentricSpheres {
            emission: 1.0,
            radius_ratio: 0.5,
            inner_albedo: 0.7,
            outer_albedo: 0.4,
        };
        for (bounce, inner, outer) in [(1, 0.7, 1.3), (2, 0.91, 1.46), (3, 1.022, 1.529)] {
            assert_close(spheres.up_to(bounce).inner, inner, 1e-12);
            assert_close(spheres.up_to(bounce).outer, outer, 1e-12);
        }
        assert_close(spheres.up_to(200).inner, spheres.total().inner, 1e-12);
        assert_close(spheres.total().inner, 1.111_111_111_111, 1e-12);
        assert_close(spheres.total().outer, 1.587_301_587_302, 1e-12);
    }

    /// Over the disk of directions towards the viewer, +z; the sun stands in the x-z plane.
    fn lit_sphere_by_quadrature(phase: f64) -> f64 {
        let sun = DVec3::new(phase.sin(), 0.0, phase.cos());
        let disk = over(DVec2::ZERO, DVec2::new(0.5 * PI, 2.0 * PI), |p| {
            let normal = direction(p.x, p.y);
            normal.dot(sun).max(0.0) * normal.z * p.x.sin()
        });
        0.37 * 2.0 / PI * disk / 4.0
    }

    #[test]
    fn a_lit_sphere_agrees_with_quadrature_and_the_table() {
        for (degrees, expected) in [(30f64, 0.108_637_3), (90.0, 0.039_258_22)] {
            let phase = degrees.to_radians();
            let found = lit_sphere_mean(2.0, 0.37, phase);
            assert_close(found, expected, 1e-6);
            assert_close(found, lit_sphere_by_quadrature(phase), 1e-6);
        }
    }
}
