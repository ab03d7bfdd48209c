//! Closed diffuse cavities (white furnace, radiosity): every bounce is known.

use std::ops::RangeInclusive;

/// Radiance of these bounces in a closed cavity of uniform albedo and emission: a piece of the
/// geometric series. Every point sees the same radiance in every direction, so each bounce
/// multiplies by the albedo.
pub(crate) fn furnace(emission: f64, albedo: f64, bounces: RangeInclusive<u32>) -> f64 {
    bounces.map(|bounce| emission * power(albedo, bounce)).sum()
}

/// The share of a sphere's area that a cap of this polar half angle covers.
fn cap_fraction(half_angle: f64) -> f64 {
    0.5 * (1.0 - half_angle.cos())
}

/// Radiance of these bounces in a spherical cavity that emits only on a cap, at any point outside
/// the cap.
///
/// Between two points inside a sphere of radius R, cos θ cos θ′ / (π r²) = 1 / (4πR²): light
/// spreads evenly over the whole sphere at the first bounce already. Bounce 0 is 0, the cap being
/// elsewhere.
pub(crate) fn cap_cavity(
    emission: f64,
    albedo: f64,
    half_angle: f64,
    bounces: RangeInclusive<u32>,
) -> f64 {
    let light = |bounce| emission * cap_fraction(half_angle) * power(albedo, bounce);
    bounces.filter(|bounce| *bounce > 0).map(light).sum()
}

/// Two concentric spheres; the outer one, seen from inside, emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ConcentricSpheres {
    /// Radiance that the outer sphere emits.
    pub(crate) emission: f64,
    /// Radius of the inner over that of the outer sphere.
    pub(crate) radius_ratio: f64,
    pub(crate) inner_albedo: f64,
    pub(crate) outer_albedo: f64,
}

/// Radiance leaving both spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InnerAndOuter {
    pub(crate) inner: f64,
    /// Leaving the outer sphere, emission included.
    pub(crate) outer: f64,
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
    pub(crate) fn up_to(&self, bounce: u32) -> InnerAndOuter {
        let emitted = InnerAndOuter { inner: 0.0, outer: self.emission };
        let (mut last, mut sum) = (emitted, emitted);
        for _ in 0..bounce {
            last = self.scattered(last);
            sum = InnerAndOuter { inner: sum.inner + last.inner, outer: sum.outer + last.outer };
        }
        sum
    }
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
    use std::f64::consts::PI;

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
    fn concentric_spheres_come_to_rest_where_radiosity_says() {
        let (radius_ratio, inner_albedo, outer_albedo) = (0.5, 0.7, 0.4);
        let spheres = ConcentricSpheres { emission: 1.0, radius_ratio, inner_albedo, outer_albedo };
        // L₂ = Lₑ / (1 − ρ₂ (F₂₂ + F₂₁ ρ₁)), L₁ = ρ₁ L₂.
        let outer = 1.0 / (1.0 - 0.4 * (0.75 + 0.25 * 0.7));
        assert_close(spheres.up_to(200).outer, outer, 1e-12);
        assert_close(spheres.up_to(200).inner, 0.7 * outer, 1e-12);
    }
}
