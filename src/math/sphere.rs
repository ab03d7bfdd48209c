//! Directions drawn at random, and the angle between two.

use super::rng::{Stream, uniform};
use glam::DVec3;
use std::f64::consts::TAU;

/// A unit vector, uniform over the sphere (Archimedes: its z is uniform).
pub fn on_sphere(stream: &mut Stream) -> DVec3 {
    at_height(2.0 * uniform(stream) - 1.0, TAU * uniform(stream))
}

/// A unit vector, uniform over the hemisphere around +z.
pub(crate) fn on_hemisphere(stream: &mut Stream) -> DVec3 {
    at_height(uniform(stream), TAU * uniform(stream))
}

/// The unit vector with `z` and azimuth `phi` from +x.
pub(crate) fn at_height(z: f64, phi: f64) -> DVec3 {
    let radius = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(radius * phi.cos(), radius * phi.sin(), z)
}

/// The angle between two directions of any length, radians. Exact to rounding for tiny angles too,
/// where the arc cosine of the dot product is not.
pub(crate) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;

    #[test]
    fn tiny_angles_keep_their_digits() {
        let angle = angle_between(DVec3::X, DVec3::new(1.0, 1e-12, 0.0) * 7.0);
        assert!((angle - 1e-12).abs() < 1e-24);
        assert!((angle_between(DVec3::X, -DVec3::X) - TAU / 2.0).abs() < 1e-15);
    }

    #[test]
    fn the_sphere_has_no_favourite_side_and_the_hemisphere_has() {
        let mut stream = Seed(3).stream();
        let mut mean = |draw: fn(&mut Stream) -> DVec3| {
            (0..10_000).map(|_| draw(&mut stream)).sum::<DVec3>() / 10_000.0
        };
        // Each component has variance 1/3: 0.04 is seven standard errors.
        assert!(mean(on_sphere).length() < 0.04);
        assert!((mean(on_hemisphere) - DVec3::Z / 2.0).length() < 0.04);
    }
}
