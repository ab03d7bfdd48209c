//! Part 2: one ray against one box, by its three pairs of planes.

use super::steps::Steps;
use crate::contract::Ray;
use crate::scene::Aabb;

/// Where the line of `ray` enters and leaves the closed box, if the box meets the closed segment.
pub(crate) fn intersect_box(bounds: &Aabb, ray: &Ray, steps: &Steps) -> Option<(f64, f64)> {
    let (x_enter, x_exit) = steps.slab(bounds, ray, 0)?;
    let (y_enter, y_exit) = steps.slab(bounds, ray, 1)?;
    let (z_enter, z_exit) = steps.slab(bounds, ray, 2)?;
    let enter = x_enter.max(y_enter).max(z_enter);
    let exit = x_exit.min(y_exit).min(z_exit);
    steps.slabs_overlap(enter, exit, ray).then_some((enter, exit))
}

/// Where the line lies between the two planes of one axis.
///
/// A ray along the planes is inside for ever or never; dividing by its zero would give 0/0 on a
/// plane, and the wrong infinity for a direction of −0.
pub(crate) fn slab(bounds: &Aabb, ray: &Ray, axis: usize) -> Option<(f64, f64)> {
    let (low, high) = (bounds.min[axis], bounds.max[axis]);
    let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
    if direction == 0.0 {
        let inside = low <= origin && origin <= high;
        return inside.then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (at_low, at_high) = ((low - origin) / direction, (high - origin) / direction);
    Some(if direction > 0.0 { (at_low, at_high) } else { (at_high, at_low) })
}

/// Whether the three slabs have a common stretch, and the segment a part in it.
pub(crate) fn slabs_overlap(enter: f64, exit: f64, ray: &Ray) -> bool {
    enter <= exit && enter <= ray.t_max && exit >= ray.t_min
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;
    use glam::DVec3;

    const INF: f64 = f64::INFINITY;
    const BOX: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]];
    const FLAT: [[f64; 3]; 2] = [[0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    const POINT: [[f64; 3]; 2] = [[1.0; 3]; 2];
    const FAR: [[f64; 3]; 2] = [[1e15, 0.0, 0.0], [2e15, 1.0, 1.0]];

    type BoxRow = (&'static str, [[f64; 3]; 2], [f64; 3], [f64; 3], [f64; 2], bool);

    /// The catalogue's rows for X1; what is expected was computed with rational numbers.
    #[rustfmt::skip]
    const BOX_ROWS: [BoxRow; 28] = [
        ("through, +x", BOX, [-1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("through, -x", BOX, [2.0, 1.0, 1.0], [-1.0, 0.0, 0.0], [0.0, INF], true),
        ("parallel, outside", BOX, [-1.0, 5.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], false),
        ("parallel, outside, -0", BOX, [-1.0, 5.0, 1.0], [1.0, -0.0, -0.0], [0.0, INF], false),
        ("origin inside", BOX, [0.5, 0.5, 0.5], [0.3, -0.2, 0.7], [0.0, INF], true),
        ("behind", BOX, [2.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], false),
        ("behind, oblique", BOX, [3.0, 4.0, 5.0], [1.0, 1.1, 1.2], [0.0, INF], false),
        ("beyond t_max", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 4.5], false),
        ("t_max at the entry", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 5.0], true),
        ("before t_min", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [6.5, INF], false),
        ("t_min inside", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [5.5, INF], true),
        ("in a face", BOX, [-1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("in the upper face", BOX, [-1.0, 2.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("in a face, -0", BOX, [-1.0, 0.0, 1.0], [1.0, -0.0, -0.0], [0.0, INF], true),
        ("in an edge", BOX, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("in an edge, -0", BOX, [-1.0, 2.0, 3.0], [1.0, -0.0, -0.0], [0.0, INF], true),
        ("flat", FLAT, [0.5, 0.0, 0.5], [0.0, 1.0, 0.0], [0.0, INF], true),
        ("flat, oblique", FLAT, [0.2, 0.0, 0.3], [0.1, 1.0, 0.2], [0.0, INF], true),
        ("flat, in its plane", FLAT, [-1.0, 1.0, 0.5], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("point", POINT, [0.0; 3], [1.0; 3], [0.0, INF], true),
        ("diagonal", BOX, [-1.0; 3], [1.0; 3], [0.0, INF], true),
        ("past a corner", BOX, [-1.0, 1.5, 1.0], [1.0, 1.0, 0.0], [0.0, INF], false),
        ("past in z alone", BOX, [-1.0, 0.5, 4.0], [1.0, 0.1, 0.01], [0.0, INF], false),
        ("long direction", BOX, [-10.0, 1.0, 1.0], [1000.0, 0.0, 0.0], [0.0, INF], true),
        ("tiny component", BOX, [-1.0, 1.0, 1.0], [1.0, 1e-300, 0.0], [0.0, INF], true),
        ("huge", FAR, [0.0, 0.5, 0.5], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("away", BOX, [-1.0; 3], [-1.0; 3], [0.0, INF], false),
        ("inside, short", BOX, [0.5; 3], [1.0; 3], [0.0, 1e-12], true),
    ];

    #[test]
    fn boxes_are_closed_and_no_direction_confuses_the_slabs() {
        for (name, [min, max], origin, direction, [t_min, t_max], expected) in BOX_ROWS {
            let bounds = Aabb { min: min.into(), max: max.into() };
            let ray = Ray { origin: origin.into(), t_min, direction: direction.into(), t_max };
            assert_eq!(intersect_box(&bounds, &ray, &LESSON).is_some(), expected, "{name}");
        }
    }

    #[test]
    fn a_box_is_entered_and_left_where_its_planes_are() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 3.0) };
        let through = Ray::new(DVec3::new(-1.0, 1.0, 1.0), DVec3::new(0.5, 0.0, 0.0));
        assert_eq!(intersect_box(&bounds, &through, &LESSON), Some((2.0, 4.0)));
        let from_inside = Ray::new(DVec3::splat(0.5), DVec3::new(0.0, 0.0, -1.0));
        assert_eq!(intersect_box(&bounds, &from_inside, &LESSON), Some((-2.5, 0.5)));
    }
}
