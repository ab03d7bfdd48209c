//! A ray and a sphere. In double precision throughout, against catastrophic cancellation in the quadratic.

use super::segment::Segment;
use super::tree::PackedSphere;
use glam::DVec3;

/// Where the line through `origin` along `direction` enters and leaves a sphere around the point zero.
///
/// The discriminant is taken from the distance between line and centre, and the smaller root from the product
/// of the roots, so that neither cancels (Haines, Günther and Akenine-Möller 2019, "Precision improvements for
/// ray/sphere intersection").
pub(crate) fn roots(origin: DVec3, direction: DVec3, radius: f64) -> Option<[f64; 2]> {
    let square = direction.length_squared();
    let towards = -origin.dot(direction);
    let nearest = origin + direction * (towards / square);
    let discriminant = radius * radius - nearest.length_squared();
    // Written so that what is not a number misses.
    (discriminant >= 0.0).then(|| {
        let sum = towards + (square * discriminant).sqrt().copysign(towards);
        let product = origin.length_squared() - radius * radius;
        let (one, other) = if sum == 0.0 { (0.0, 0.0) } else { (product / sum, sum / square) };
        [one.min(other), one.max(other)]
    })
}

/// The first root on the segment, of those not beyond `t_last`, in single precision.
#[inline]
pub(crate) fn first_root_inside(
    sphere: &PackedSphere,
    segment: &Segment,
    t_last: f32,
) -> Option<f32> {
    let roots = roots(segment.origin - sphere.centre, segment.direction, sphere.radius)?;
    let is_inside = |t: &f32| *t > segment.t_after && *t <= t_last;
    roots.map(|root| root as f32).into_iter().find(is_inside)
}

/// The root that `t` was rounded from.
pub(crate) fn exact_root(centre: DVec3, radius: f64, segment: &Segment, t: f32) -> f64 {
    let rounded = f64::from(t);
    match roots(segment.origin - centre, segment.direction, radius) {
        Some([near, far]) if (near - rounded).abs() <= (far - rounded).abs() => near,
        Some([_, far]) => far,
        None => rounded,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::Ray;
    use glam::dvec3;

    #[test]
    fn both_roots_are_found_from_outside_inside_and_behind() {
        assert_eq!(roots(dvec3(0.0, 0.0, -3.0), DVec3::Z, 1.0), Some([2.0, 4.0]));
        assert_eq!(roots(DVec3::ZERO, DVec3::Z * 2.0, 1.0), Some([-0.5, 0.5]));
        assert_eq!(roots(dvec3(0.0, 0.0, 3.0), DVec3::Z, 1.0), Some([-4.0, -2.0]));
        assert_eq!(roots(dvec3(0.0, 1.5, -3.0), DVec3::Z, 1.0), None);
    }

    #[test]
    fn a_far_origin_loses_no_digits() {
        for distance in [1e2, 1e4, 1e6] {
            let [near, _] = roots(dvec3(0.6, 0.0, -distance), DVec3::Z, 1.0).expect("two roots");
            assert!((near - (distance - 0.8)).abs() <= 1e-15 * distance * distance, "{distance}");
        }
    }

    #[test]
    fn the_segment_chooses_the_root() {
        let sphere = PackedSphere::new(0, DVec3::ZERO, 1.0, false);
        let first = |t_min, t_max| {
            let ray = Ray { t_min, t_max, ..Ray::new(dvec3(0.0, 0.0, -3.0), DVec3::Z) };
            let segment = Segment::new(&ray);
            first_root_inside(&sphere, &segment, segment.t_last)
        };
        assert_eq!(first(0.0, 9.0), Some(2.0));
        assert_eq!(first(2.0, 9.0), Some(4.0), "the ends are open");
        assert_eq!(first(3.0, 4.0), None);
        assert_eq!(first(0.0, 2.0), None);
    }
}
