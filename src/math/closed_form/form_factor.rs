//! Form factors between two rectangles (area to area): the fraction of the light leaving one that arrives
//! at the other.
//!
//! Source: J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and
//! C-14.

use std::f64::consts::PI;

/// Between identical parallel rectangles whose sides are `x` and `y` times their distance (C-11).
pub(crate) fn parallel_rectangles(x: f64, y: f64) -> f64 {
    let (root_x, root_y) = (f64::hypot(1.0, x), f64::hypot(1.0, y));
    let diagonal = (1.0 + x * x + y * y).sqrt();
    let sum = (root_x * root_y / diagonal).ln()
        + x * root_y * (x / root_y).atan()
        + y * root_x * (y / root_x).atan()
        - x * x.atan()
        - y * y.atan();
    2.0 / (PI * x * y) * sum
}

/// From a rectangle to one at right angles to it along a common edge (C-14). `width` is how far the
/// source goes away from the edge and `height` how far the target does, both over the length of the
/// edge.
pub(crate) fn perpendicular_rectangles(width: f64, height: f64) -> f64 {
    let (w2, h2) = (width * width, height * height);
    let both = 1.0 + w2 + h2;
    let slant = (h2 + w2).sqrt();
    let logarithm = ((1.0 + w2) * (1.0 + h2) / both).ln()
        + w2 * (w2 * both / ((1.0 + w2) * (w2 + h2))).ln()
        + h2 * (h2 * both / ((1.0 + h2) * (h2 + w2))).ln();
    let angles = width * width.recip().atan() + height * height.recip().atan()
        - slant * slant.recip().atan();
    (angles + 0.25 * logarithm) / (PI * width)
}

#[cfg(test)]
mod tests {
    use super::super::configuration_factor::polygon;
    use super::super::witness::{assert_close, over_unit_square};
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn they_are_means_of_configuration_factors() {
        // Seen from a point of the square [0, 1]².
        let seen = |square: [DVec3; 4], p: DVec2| {
            polygon(&square.map(|corner| corner - p.extend(0.0)), DVec3::Z)
        };
        let above = [DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::ONE, DVec3::new(0.0, 1.0, 1.0)];
        let parallel = over_unit_square(|p| seen(above, p));
        assert_close(parallel_rectangles(1.0, 1.0), parallel, 1e-8);
        let beside = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, 1.0), DVec3::Z];
        let perpendicular = over_unit_square(|p| seen(beside, p));
        assert_close(perpendicular_rectangles(1.0, 1.0), perpendicular, 1e-6);
    }

    #[test]
    fn a_face_of_a_cube_sees_the_five_others_and_nothing_else() {
        let seen = 4.0 * perpendicular_rectangles(1.0, 1.0) + parallel_rectangles(1.0, 1.0);
        assert_close(seen, 1.0, 1e-12);
    }
}
