//! Part 2: one ray against one box, by its three pairs of planes: the slab test.

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
