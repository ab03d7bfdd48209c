//! Whether a ray meets a box, in exact arithmetic.

use crate::contract::Ray;
use crate::scene::Aabb;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

/// The truth about a ray and a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overlap {
    pub(super) hits: bool,
    /// Where the line enters the box and leaves it, rounded once.
    pub(super) enters: f64,
    pub(super) exits: f64,
}

impl Overlap {
    /// In rationals: t ∈ [(lo − o)/d, (hi − o)/d] on each axis, or the axis decides alone if d = 0.
    /// `None` if a number that has to be finite is not.
    pub(super) fn exact(bounds: &Aabb, ray: &Ray) -> Option<Self> {
        let mut line: Option<(BigRational, BigRational)> = None;
        for axis in 0..3 {
            let [low, high, origin, direction] =
                [bounds.min[axis], bounds.max[axis], ray.origin[axis], ray.direction[axis]]
                    .map(BigRational::from_float);
            let (from, to, direction) =
                (low? - origin.as_ref()?, high? - origin.as_ref()?, direction?);
            if direction.is_zero() {
                if from > BigRational::zero() || to < BigRational::zero() {
                    return Some(Self { hits: false, enters: f64::NAN, exits: f64::NAN });
                }
                continue;
            }
            let (a, b) = (from / &direction, to / &direction);
            let (near, far) = if a <= b { (a, b) } else { (b, a) };
            line = Some(match line {
                None => (near, far),
                Some((enters, exits)) => (enters.max(near), exits.min(far)),
            });
        }
        let (enters, exits) = line?;
        let starts_in_time = BigRational::from_float(ray.t_max).is_none_or(|end| enters <= end);
        let ends_in_time = BigRational::from_float(ray.t_min).is_none_or(|start| exits >= start);
        let hits = enters <= exits && starts_in_time && ends_in_time;
        Some(Self { hits, enters: enters.to_f64()?, exits: exits.to_f64()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn exact_arithmetic_sees_what_doubles_cannot() {
        // The ray leaves x at t = 2 and enters y at 2 + 2ε, or at 2.
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 1.0) };
        let just_over = 1.0 + f64::EPSILON;
        let ray = Ray::new(DVec3::new(-1.0, -just_over, 0.5), DVec3::new(1.0, 0.5, 0.0));
        assert!(!Overlap::exact(&bounds, &ray).unwrap().hits);
        let ray = Ray::new(DVec3::new(-1.0, -1.0, 0.5), DVec3::new(1.0, 0.5, 0.0));
        assert!(Overlap::exact(&bounds, &ray).unwrap().hits);
    }
}
