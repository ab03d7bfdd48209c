//! The slab test: a ray and a box, as the contract asks: exact about parallel rays, flat boxes, t_min and
//! t_max. Not the test that traversal runs eight at a time; that one only has to be conservative (`ray.rs`).

use crate::contract::{BoxHit, Ray};
use crate::scene::Aabb;

/// Where the line of `ray` is inside the closed `bounds`, and whether its closed segment is.
pub(crate) fn intersect_box(bounds: &Aabb, ray: &Ray) -> BoxHit {
    let (mut t_enter, mut t_exit) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut beside = false;
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        let (low, high) = (bounds.min[axis], bounds.max[axis]);
        if direction == 0.0 {
            // 0/0 on a face would be NaN: a parallel ray is between the faces, or it misses.
            beside |= !(low <= origin && origin <= high);
            continue;
        }
        let (first, second) = ((low - origin) / direction, (high - origin) / direction);
        t_enter = t_enter.max(first.min(second));
        t_exit = t_exit.min(first.max(second));
    }
    let meets = !beside && t_enter <= t_exit && t_enter <= ray.t_max && t_exit >= ray.t_min;
    BoxHit { t_enter, t_exit, hit: u32::from(meets), reserved: 0 }
}
