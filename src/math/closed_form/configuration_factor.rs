//! Configuration factors, the point-to-area form factors: the fraction of a patch's cosine-weighted
//! hemisphere that a shape fills, ∫ cos θ cos θ′ / (π r²) dA.
//! A Lambertian patch of albedo ρ, lit by a shape of radiance L, has radiance ρ L F.
//!
//! Sources: J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors" (numbers
//! B-3, B-4, B-12, B-13, B-43 there); J. H. Lambert, Photometria (1760), for polygons.

use glam::DVec3;
use std::f64::consts::PI;

/// A flat polygon, vertices relative to the patch, clipped at the horizon of the patch's unit
/// `normal`: Lambert's formula, half the sum over edges of the angle they subtend times the cosine
/// between normal and edge plane.
pub(crate) fn polygon(vertices: &[DVec3], normal: DVec3) -> f64 {
    let above = clipped(vertices, normal);
    let next = above.iter().cycle().skip(1);
    let sum: f64 = above.iter().zip(next).map(|(a, b)| edge(*a, *b, normal)).sum();
    sum.abs() / (2.0 * PI)
}

fn edge(a: DVec3, b: DVec3, normal: DVec3) -> f64 {
    let (a, b) = (a.normalize(), b.normalize());
    let across = a.cross(b);
    let sine = across.length();
    // An edge that is seen end on subtends nothing.
    if sine == 0.0 { 0.0 } else { sine.atan2(a.dot(b)) * across.dot(normal) / sine }
}

/// The part of a polygon above the horizon (Sutherland and Hodgman 1974).
fn clipped(vertices: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut above = Vec::with_capacity(vertices.len() + 1);
    for (i, &a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        let (height_a, height_b) = (a.dot(normal), b.dot(normal));
        if height_a >= 0.0 {
            above.push(a);
        }
        if height_a * height_b < 0.0 {
            above.push(a.lerp(b, height_a / (height_a - height_b)));
        }
    }
    above
}

/// A sphere whose centre is at `distance`, at the angle `theta` from the normal, wholly or partly
/// above the horizon (B-43).
pub(crate) fn sphere(radius: f64, distance: f64, theta: f64) -> f64 {
    let h = distance / radius;
    let half_angle = h.recip().acos();
    if theta <= half_angle {
        return theta.cos() / (h * h);
    }
    if theta >= PI - half_angle {
        return 0.0;
    }
    let x = (h * h - 1.0).sqrt();
    let y = -x / theta.tan();
    let chord = theta.sin() * (1.0 - y * y).max(0.0).sqrt();
    (theta.cos() * y.acos() - x * chord) / (PI * h * h) + (chord / x).atan() / PI
}

/// A sky of radiance a + b cos θ, and a below the horizon, over a patch whose normal is `tilt` from
/// the zenith, relative to a sky of radiance 1.
pub(crate) fn gradient_sky(a: f64, b: f64, tilt: f64) -> f64 {
    a + 2.0 * b / (3.0 * PI) * (tilt.sin() + (PI - tilt) * tilt.cos())
}

#[cfg(test)]
mod tests {
    use super::super::witness::{assert_close, kernel, over, over_unit_square};
    use super::*;
    use crate::math::frame::direction;
    use glam::DVec2;

    /// The defining integral over a triangle, through Duffy's map of the square.
    fn triangle(vertices: [DVec3; 3]) -> f64 {
        let [a, b, c] = vertices;
        let area = (b - a).cross(c - a);
        let facing = if area.dot(a) < 0.0 { area } else { -area };
        over_unit_square(|p| {
            let point = a + p.x * ((1.0 - p.y) * (b - a) + p.y * (c - a));
            p.x * kernel(DVec3::Z, point, facing)
        })
    }

    #[test]
    fn polygons_agree_with_quadrature_above_and_through_the_horizon() {
        let above = [(-0.3, 0.4, 1.1), (0.9, 0.1, 0.8), (0.2, 1.2, 1.4)];
        let through = [(-0.5, 0.6, 1.2), (0.8, 0.7, 0.6), (0.1, 0.9, -0.7)];
        for (vertices, allowed) in [(above, 1e-8), (through, 1e-6)] {
            let vertices = vertices.map(DVec3::from);
            assert_close(polygon(&vertices, DVec3::Z), triangle(vertices), allowed);
            let mut reversed = vertices;
            reversed.reverse();
            assert_close(polygon(&reversed, DVec3::Z), polygon(&vertices, DVec3::Z), 1e-12);
        }
        assert_eq!(polygon(&above.map(DVec3::from), -DVec3::Z), 0.0);
    }

    /// ∫ cos θ dω / π over the cone of directions that meet the sphere.
    fn sphere_by_quadrature(radius: f64, distance: f64, theta: f64) -> f64 {
        let axis = direction(theta, 0.0);
        let (tangent, bitangent) = axis.any_orthonormal_pair();
        let widest = (radius / distance).asin();
        over(DVec2::ZERO, DVec2::new(widest, 2.0 * PI), |p| {
            let local = direction(p.x, p.y);
            let world = local.x * tangent + local.y * bitangent + local.z * axis;
            world.z.max(0.0) * p.x.sin() / PI
        })
    }

    #[test]
    fn spheres_agree_with_quadrature_above_and_through_the_horizon() {
        for (degrees, expected, allowed) in [
            (35f64, 0.058_250_812_04, 1e-8),
            (80.0, 0.012_685_922_77, 1e-6),
            (90.0, 0.004_113_341_655, 1e-5),
            (97.0, 0.000_979_438_325_8, 1e-4),
        ] {
            let found = sphere(0.4, 1.5, degrees.to_radians());
            assert_close(found, expected, 1e-9);
            assert_close(found, sphere_by_quadrature(0.4, 1.5, degrees.to_radians()), allowed);
        }
        assert_eq!(sphere(0.4, 1.5, 120f64.to_radians()), 0.0);
    }

    #[test]
    fn skies_agree_with_quadrature() {
        for tilt in [0.0, 50f64.to_radians()] {
            let normal = direction(tilt, 0.0);
            let quadrature = over(DVec2::ZERO, DVec2::new(PI, 2.0 * PI), |p| {
                let from = direction(p.x, p.y);
                let radiance = 0.4 + 0.9 * from.z.max(0.0);
                radiance * from.dot(normal).max(0.0) * p.x.sin() / PI
            });
            assert_close(gradient_sky(0.4, 0.9, tilt), quadrature, 1e-6);
        }
    }
}
