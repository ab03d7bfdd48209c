//! The fraction of a pinhole image that a shape covers. Angles are the full fields of view, radians.

use std::f64::consts::PI;

/// A rectangle that faces the camera at this depth, with x and y relative to the axis; cut off at
/// the image's border.
pub(crate) fn rectangle(x: [f64; 2], y: [f64; 2], depth: f64, fields_of_view: [f64; 2]) -> f64 {
    let covered = |[low, high]: [f64; 2], field: f64| {
        let half = depth * (0.5 * field).tan();
        (high.min(half) - low.max(-half)).max(0.0) / (2.0 * half)
    };
    covered(x, fields_of_view[0]) * covered(y, fields_of_view[1])
}

/// A sphere on the axis, wholly within the image: its cone meets the image plane in a disk.
pub(crate) fn sphere_on_axis(radius: f64, distance: f64, fields_of_view: [f64; 2]) -> f64 {
    let [horizontal, vertical] = fields_of_view.map(|field| (0.5 * field).tan());
    let edge = (radius / distance).asin().tan();
    PI * edge * edge / (4.0 * horizontal * vertical)
}

#[cfg(test)]
mod tests {
    use super::super::witness::assert_close;
    use super::*;
    use glam::{DVec2, DVec3};

    const SIDE: u32 = 1000;

    /// The share of a grid of camera rays, directions with z = 1, that `hits`.
    fn share(fields_of_view: [f64; 2], hits: impl Fn(DVec3) -> bool) -> f64 {
        let half = DVec2::from(fields_of_view.map(|field| (0.5 * field).tan()));
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE) * 2.0 - 1.0;
        let rays = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| DVec2::new(at(x), at(y))));
        let seen = rays.filter(|film| hits((half * *film).extend(1.0))).count();
        seen as f64 / f64::from(SIDE * SIDE)
    }

    fn views(horizontal: f64, vertical: f64) -> [f64; 2] {
        [horizontal.to_radians(), vertical.to_radians()]
    }

    #[test]
    fn a_rectangle_agrees_with_counting_rays_inside_and_beyond_the_border() {
        for (x, y) in [([-0.9, 0.5], [-0.3, 0.8]), ([-0.9, 9.0], [-0.3, 9.0])] {
            let counted = share(views(50.0, 35.0), |ray| {
                let hit = 4.0 * ray;
                (x[0]..x[1]).contains(&hit.x) && (y[0]..y[1]).contains(&hit.y)
            });
            assert_close(rectangle(x, y, 4.0, views(50.0, 35.0)), counted, 5e-3);
        }
        let found = rectangle([-0.9, 0.5], [-0.3, 0.8], 4.0, views(50.0, 35.0));
        assert_close(found, 0.163_661_262_3, 1e-9);
    }

    #[test]
    fn a_sphere_agrees_with_counting_rays() {
        let counted = share(views(50.0, 35.0), |ray| {
            let closest = ray * ray.z * 3.0 / ray.length_squared();
            closest.distance(3.0 * DVec3::Z) < 0.6
        });
        assert_close(sphere_on_axis(0.6, 3.0, views(50.0, 35.0)), counted, 2e-3);
        assert_close(sphere_on_axis(0.6, 3.0, views(50.0, 35.0)), 0.222_578_796_2, 1e-9);
    }
}
