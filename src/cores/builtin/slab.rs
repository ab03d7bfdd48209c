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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, dvec3};

    const UNIT: Aabb = Aabb { min: DVec3::ZERO, max: DVec3::ONE };

    fn meets(bounds: &Aabb, origin: DVec3, direction: DVec3, t_min: f64, t_max: f64) -> bool {
        intersect_box(bounds, &Ray { origin, t_min, direction, t_max }).hit == 1
    }

    #[test]
    fn a_ray_through_the_middle_enters_and_leaves() {
        let hit = intersect_box(&UNIT, &Ray::new(dvec3(-1.0, 0.5, 0.5), DVec3::X * 2.0));
        assert_eq!((hit.t_enter, hit.t_exit, hit.hit), (0.5, 1.0, 1));
    }

    #[test]
    fn a_parallel_ray_hits_only_between_the_faces() {
        let inside = dvec3(-1.0, 1.0, 0.5);
        assert!(meets(&UNIT, inside, DVec3::X, 0.0, 9.0), "on a face");
        assert!(meets(&UNIT, inside, dvec3(1.0, -0.0, -0.0), 0.0, 9.0), "negative zeros");
        assert!(!meets(&UNIT, dvec3(-1.0, 1.5, 0.5), DVec3::X, 0.0, 9.0), "beside");
    }

    #[test]
    fn the_segment_ends_count() {
        let origin = dvec3(-1.0, 0.5, 0.5);
        assert!(meets(&UNIT, origin, DVec3::X, 0.0, 1.0), "touches the near face");
        assert!(!meets(&UNIT, origin, DVec3::X, 0.0, 0.999), "ends before");
        assert!(meets(&UNIT, origin, DVec3::X, 2.0, 9.0), "touches the far face");
        assert!(!meets(&UNIT, origin, DVec3::X, 2.001, 9.0), "starts behind");
        assert!(meets(&UNIT, origin, DVec3::X, 1.4, 1.6), "lies inside");
    }

    #[test]
    fn flat_and_point_boxes_are_boxes() {
        let flat = Aabb { min: DVec3::ZERO, max: dvec3(0.0, 1.0, 1.0) };
        assert!(meets(&flat, dvec3(-1.0, 0.5, 0.5), DVec3::X, 0.0, 9.0));
        assert!(meets(&flat, dvec3(0.0, -1.0, 0.5), DVec3::Y, 0.0, 9.0), "in its plane");
        let point = Aabb { min: DVec3::ONE, max: DVec3::ONE };
        assert!(meets(&point, DVec3::ZERO, DVec3::ONE, 0.0, 9.0));
        assert!(!meets(&point, DVec3::ZERO, dvec3(1.0, 1.0, 1.01), 0.0, 9.0));
    }
}
