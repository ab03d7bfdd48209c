//! A ray made ready for traversal: scaled, rounded, and with what the box and triangle tests need of it.
//!
//! Two promises hold the BVH together:
//!
//! - The segment is kept exactly. `t` passes in single precision if and only if it lies in the open interval
//!   of the double precision ray.
//! - The box test loses nothing that a primitive test could hit. Its planes are moved outward by more than
//!   the rounding of the origin and of the products (after Ize 2013, "Robust BVH ray traversal").

use crate::contract::Ray;
use glam::{DVec3, Vec3};

/// Direction components are kept this far from zero in the box test, so that reciprocals stay finite.
const SMALLEST_COMPONENT: f32 = 1e-18;

/// Relative outward shift of `origin / direction`: the origin's rounding and that of one product, 2⁻²⁴ each,
/// and as much again for a box test without fused multiplication; four times that to be sure.
const OFFSET_MARGIN: f32 = f32::EPSILON * 4.0;

/// A ray ready for traversal. Its direction is scaled by a power of two, exactly, so that the largest
/// component is in [1, 2); `t` is in units of that direction until [`Segment::unscale`].
#[derive(Clone, Debug)]
pub(crate) struct Segment {
    /// In double precision, with the scaled direction.
    pub(crate) origin: DVec3,
    /// Scaled.
    pub(crate) direction: DVec3,
    /// The given `t` over the scaled one.
    scale: f64,
    /// Open ends in units of the given direction.
    limits: [f64; 2],
    /// `t` must be greater than this.
    pub(crate) t_after: f32,
    /// `t` must not be greater than this.
    pub(crate) t_last: f32,
    pub(crate) slabs: Slabs,
    pub(crate) shear: Shear,
}

/// The ray for boxes: a plane at `p` is met at `p · inverse − offset`.
#[derive(Clone, Debug)]
pub(crate) struct Slabs {
    /// Reciprocal of the direction; its sign says which of two planes the ray meets first.
    pub(crate) inverse: [f32; 3],
    /// Of the planes where the ray enters, a little too large.
    pub(crate) enter_offset: [f32; 3],
    /// Of the planes where it leaves, a little too small.
    pub(crate) exit_offset: [f32; 3],
}

/// The ray for triangles: the shear that turns it into the z axis (Woop, Benthin and Wald 2013, "Watertight
/// ray/triangle intersection").
#[derive(Clone, Debug)]
pub(crate) struct Shear {
    /// Rounded origin, in the order of `axes`.
    pub(crate) origin: [f32; 3],
    /// World axes in the order x, y, z of the sheared space; z is where the direction is largest.
    pub(crate) axes: [u8; 3],
    /// Shear along x and y, and scale of z.
    pub(crate) factors: [f32; 3],
}

impl Segment {
    /// Relative outward shift of where a ray leaves a box or ends: for the rounding of reciprocals and products
    /// and of the triangle test itself.
    pub(crate) const MARGIN: f32 = f32::EPSILON * 8.0;

    /// Prepares `ray`. A direction that is zero or not finite makes an empty segment, which hits nothing.
    #[inline]
    pub(crate) fn new(ray: &Ray) -> Self {
        let (scale, inverse_scale) = power_of_two_for(ray.direction.abs().max_element());
        let direction = ray.direction * scale;
        let (origin32, direction32) = (ray.origin.as_vec3(), direction.as_vec3());
        let slabs = Slabs::new(origin32, direction32);
        let shear = Shear::new(origin32, direction32, slabs.inverse);
        Self {
            origin: ray.origin,
            direction,
            scale,
            limits: [ray.t_min, ray.t_max],
            // An unusable direction has scale 0 and both ends NaN.
            t_after: largest_not_above(ray.t_min * inverse_scale),
            t_last: largest_below(ray.t_max * inverse_scale),
            slabs,
            shear,
        }
    }

    /// `t` in units of the direction that was given, strictly inside the ends that were given.
    #[inline]
    pub(crate) fn unscale(&self, t: f64) -> f64 {
        let [t_min, t_max] = self.limits;
        let given = t * self.scale;
        // A refined t may round across the end that its single precision forerunner respected.
        if given >= t_max {
            t_max.next_down()
        } else if given <= t_min {
            t_min.next_up()
        } else {
            given
        }
    }

    /// An end of a segment for the box test: a little beyond `t_last`.
    #[inline(always)]
    pub(crate) fn beyond(t_last: f32) -> f32 {
        t_last + t_last.abs() * Self::MARGIN
    }
}

impl Slabs {
    #[inline]
    fn new(origin: Vec3, direction: Vec3) -> Self {
        let away_from_zero =
            direction.abs().max(Vec3::splat(SMALLEST_COMPONENT)).copysign(direction);
        let inverse = away_from_zero.recip();
        let offset = origin * inverse;
        let margin = offset.abs() * OFFSET_MARGIN;
        Self {
            inverse: inverse.to_array(),
            enter_offset: (offset + margin).to_array(),
            exit_offset: (offset - margin).to_array(),
        }
    }

    /// The rows of a node's planes that the ray enters and leaves by along `axis`.
    #[inline(always)]
    pub(crate) fn rows(&self, axis: usize) -> [usize; 2] {
        let is_backward = usize::from(self.inverse[axis] < 0.0);
        [2 * axis + is_backward, 2 * axis + 1 - is_backward]
    }
}

impl Shear {
    #[inline]
    fn new(origin: Vec3, direction: Vec3, inverse: [f32; 3]) -> Self {
        let z = direction.abs().max_position() % 3;
        let [x, y, z] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][z];
        Self {
            origin: [origin[x], origin[y], origin[z]],
            axes: [x as u8, y as u8, z as u8],
            factors: [direction[x] * inverse[z], direction[y] * inverse[z], inverse[z]],
        }
    }
}

/// The power of two that brings `largest` into [1, 2), and its reciprocal; 0 and NaN if `largest` is zero,
/// infinite, NaN, or so large that the power would be denormal.
#[inline]
fn power_of_two_for(largest: f64) -> (f64, f64) {
    const EXPONENT: u64 = 0x7ff << 52;
    const TWICE_BIAS: u64 = (2 * 1023) << 52;
    if !(f64::MIN_POSITIVE..=f64::MAX / 4.0).contains(&largest) {
        return (0.0, f64::NAN);
    }
    let exponent = largest.to_bits() & EXPONENT;
    // The biased exponents of x and 1/x, powers of two, add up to twice the bias.
    (f64::from_bits(TWICE_BIAS - exponent), f64::from_bits(exponent))
}

/// The largest f32 not above `t`: an f32 is greater than it if and only if it is greater than `t`.
#[inline]
fn largest_not_above(t: f64) -> f32 {
    let rounded = t as f32;
    if f64::from(rounded) > t { rounded.next_down() } else { rounded }
}

/// The largest f32 below `t`: an f32 is not greater than it if and only if it is below `t`.
#[inline]
fn largest_below(t: f64) -> f32 {
    let rounded = t as f32;
    if f64::from(rounded) < t { rounded } else { rounded.next_down() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn directions_of_any_length_are_scaled_exactly() {
        for length in [1e-300, 1e-3, 1.0, 7.0, 1e300] {
            let direction = dvec3(0.3, -0.9, 0.1) * length;
            let segment = Segment::new(&Ray::new(DVec3::ZERO, direction));
            let largest = segment.direction.abs().max_element();
            assert!((1.0..2.0).contains(&largest), "{length}: {largest}");
            assert_eq!(segment.direction / segment.scale, direction);
        }
    }

    #[test]
    fn a_direction_that_is_none_makes_an_empty_segment() {
        for direction in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert!(Segment::new(&Ray::new(DVec3::ZERO, direction)).t_last.is_nan(), "{direction}");
        }
    }

    #[test]
    fn both_ends_of_the_segment_are_open() {
        let ray = Ray { t_min: 1.0, t_max: 2.0, ..Ray::new(DVec3::ZERO, DVec3::X) };
        let segment = Segment::new(&ray);
        assert_eq!(segment.t_after, 1.0);
        assert_eq!(segment.t_last, 2.0_f32.next_down());
        assert!(segment.unscale(1.0) > 1.0 && segment.unscale(2.0) < 2.0);
    }

    #[test]
    fn ends_between_single_precision_numbers_lose_no_number() {
        let between = f64::from(1.0_f32) + 1e-9;
        assert_eq!(largest_not_above(between), 1.0);
        assert_eq!(largest_below(between), 1.0);
        assert_eq!(largest_below(1.0), 1.0_f32.next_down());
        assert_eq!(largest_below(f64::INFINITY), f32::MAX);
        assert_eq!(largest_not_above(f64::NEG_INFINITY), f32::NEG_INFINITY);
    }
}
