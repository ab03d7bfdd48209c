//! What share of the light a small patch would get from all around comes from one shape: ∫ cos θ
//! cos θ′ / (π r²) dA. A Lambertian patch of albedo ρ, lit by a shape of radiance L, has radiance ρ
//! L F.
//!
//! Sources: J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors" (numbers
//! B-3, B-4, B-12, B-13, B-43 there); J. H. Lambert, Photometria (1760), for polygons.

use glam::DVec3;
use std::f64::consts::PI;

/// A rectangle `a` by `b`, parallel to the patch at distance `c`, one corner above the patch (B-3).
pub fn rectangle_parallel_corner(a: f64, b: f64, c: f64) -> f64 {
    let (a, b) = (a / c, b / c);
    let (root_a, root_b) = (f64::hypot(1.0, a), f64::hypot(1.0, b));
    (a / root_a * (b / root_a).atan() + b / root_b * (a / root_b).atan()) / (2.0 * PI)
}

/// The rectangle with x in `x` and y in `y`, parallel to the patch at the origin at distance `c`:
/// corner rectangles, added and subtracted.
pub fn rectangle_parallel(x: [f64; 2], y: [f64; 2], c: f64) -> f64 {
    let corner = |x: f64, y: f64| (x * y).signum() * rectangle_parallel_corner(x.abs(), y.abs(), c);
    corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0])
}

/// A rectangle at right angles to the patch, in the plane at distance `c`: `a` wide from above the
/// patch to one side, `b` high from the plane of the patch up (B-4).
pub fn rectangle_perpendicular(a: f64, b: f64, c: f64) -> f64 {
    let slant = f64::hypot(c, b);
    ((a / c).atan() - c / slant * (a / slant).atan()) / (2.0 * PI)
}

/// A flat polygon, vertices relative to the patch, clipped at the horizon of the patch's unit
/// `normal`: Lambert's formula, half the sum over edges of the angle they subtend times the cosine
/// between normal and edge plane.
pub fn polygon(vertices: &[DVec3], normal: DVec3) -> f64 {
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

/// A parallel disk of this radius at height `h`, its axis through the patch (B-12).
pub fn disk_coaxial(radius: f64, h: f64) -> f64 {
    radius * radius / (radius * radius + h * h)
}

/// A parallel disk at height `h`, its axis at `offset` > 0 from the patch (B-13).
pub fn disk_offset(radius: f64, h: f64, offset: f64) -> f64 {
    let (height, radius) = (h / offset, radius / offset);
    let z = 1.0 + height * height + radius * radius;
    let root = (z * z - 4.0 * radius * radius).sqrt();
    0.5 * (1.0 - (z - 2.0 * radius * radius) / root)
}

/// A coaxial disk light partly hidden by a coaxial disk between it and the patch. Both are (radius,
/// height).
pub fn disk_behind_disk(light: (f64, f64), occluder: (f64, f64)) -> f64 {
    (disk_coaxial(light.0, light.1) - disk_coaxial(occluder.0, occluder.1)).max(0.0)
}

/// A sphere whose centre is at `distance`, at the angle `theta` from the normal, wholly or partly
/// above the horizon (B-43).
pub fn sphere(radius: f64, distance: f64, theta: f64) -> f64 {
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

/// A uniform sky over a black plain, for a patch whose normal is `tilt` from the zenith.
pub fn sky_over_plain(tilt: f64) -> f64 {
    0.5 * (1.0 + tilt.cos())
}

/// A sky of radiance a + b cos θ over a patch that lies flat, relative to a sky of radiance 1: a +
/// 2b/3.
pub fn gradient_sky(a: f64, b: f64) -> f64 {
    a + 2.0 / 3.0 * b
}

#[cfg(test)]
mod tests {
    use super::super::witness::{assert_close, kernel, over, over_unit_square};
    use super::*;
    use crate::math::frame::{Frame, direction};
    use glam::DVec2;

    /// The defining integral over the parallelogram `corner + u·side + v·other`.
    fn parallelogram(corner: DVec3, side: DVec3, other: DVec3) -> f64 {
        let area = side.cross(other);
        let facing = if area.dot(corner + 0.5 * (side + other)) < 0.0 { area } else { -area };
        over_unit_square(|p| kernel(DVec3::Z, corner + p.x * side + p.y * other, facing))
    }

    #[test]
    fn parallel_rectangles_agree_with_quadrature_and_the_table() {
        for (x, y, expected) in [
            ([-0.6, 0.6], [-0.4, 0.4], 0.117_882_642_3),
            ([0.3, 1.5], [-0.2, 0.6], 0.071_565_981_71),
        ] {
            let found = rectangle_parallel(x, y, 1.5);
            let corner = DVec3::new(x[0], y[0], 1.5);
            let sides = (DVec3::X * (x[1] - x[0]), DVec3::Y * (y[1] - y[0]));
            assert_close(found, parallelogram(corner, sides.0, sides.1), 1e-8);
            assert_close(found, expected, 1e-9);
        }
    }

    #[test]
    fn a_perpendicular_rectangle_agrees_with_quadrature_and_the_table() {
        let found = rectangle_perpendicular(1.1, 0.9, 0.7);
        let corner = DVec3::new(0.0, 0.7, 0.0);
        assert_close(found, parallelogram(corner, 1.1 * DVec3::X, 0.9 * DVec3::Z), 1e-8);
        assert_close(found, 0.084_811_845_63, 1e-9);
    }

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

    #[test]
    fn a_rectangle_is_a_polygon() {
        let corners = [(-0.6, -0.4), (0.6, -0.4), (0.6, 0.4), (-0.6, 0.4)];
        let corners = corners.map(|(x, y)| DVec3::new(x, y, 1.5));
        let expected = rectangle_parallel([-0.6, 0.6], [-0.4, 0.4], 1.5);
        assert_close(polygon(&corners, DVec3::Z), expected, 1e-12);
    }

    fn disk(radius: f64, h: f64, offset: f64) -> f64 {
        over(DVec2::ZERO, DVec2::new(radius, 2.0 * PI), |p| {
            let point = DVec3::new(offset + p.x * p.y.cos(), p.x * p.y.sin(), h);
            p.x * kernel(DVec3::Z, point, -DVec3::Z)
        })
    }

    #[test]
    fn disks_agree_with_quadrature_and_the_table() {
        assert_close(disk_coaxial(0.5, 1.2), disk(0.5, 1.2, 0.0), 1e-8);
        assert_close(disk_coaxial(0.5, 1.2), 0.147_928_994_1, 1e-9);
        assert_close(disk_offset(0.5, 1.2, 0.8), disk(0.5, 1.2, 0.8), 1e-8);
        assert_close(disk_offset(0.5, 1.2, 0.8), 0.081_877_816_31, 1e-9);
        assert_close(disk_behind_disk((0.8, 2.0), (0.2, 1.0)), 0.099_469_496_02, 1e-9);
        assert_eq!(disk_behind_disk((0.2, 2.0), (0.8, 1.0)), 0.0);
    }

    /// ∫ cos θ dω / π over the cone of directions that meet the sphere.
    fn sphere_by_quadrature(radius: f64, distance: f64, theta: f64) -> f64 {
        let frame = Frame::around(direction(theta, 0.0));
        let widest = (radius / distance).asin();
        over(DVec2::ZERO, DVec2::new(widest, 2.0 * PI), |p| {
            frame.to_world(direction(p.x, p.y)).z.max(0.0) * p.x.sin() / PI
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
        let tilt = 50f64.to_radians();
        let normal = direction(tilt, 0.0);
        let hemisphere = DVec2::new(0.5 * PI, 2.0 * PI);
        let tilted = over(DVec2::ZERO, hemisphere, |p| {
            direction(p.x, p.y).dot(normal).max(0.0) * p.x.sin() / PI
        });
        assert_close(sky_over_plain(tilt), tilted, 1e-6);
        assert_close(sky_over_plain(tilt), 0.821_393_804_8, 1e-9);
        let gradient =
            over(DVec2::ZERO, hemisphere, |p| (0.4 + 0.9 * p.x.cos()) * p.x.cos() * p.x.sin() / PI);
        assert_close(gradient_sky(0.4, 0.9), gradient, 1e-9);
    }
}
