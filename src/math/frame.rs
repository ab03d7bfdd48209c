//! Spherical coordinates in a local frame.

use glam::DVec3;

/// The unit direction at polar angle `theta` from +z and azimuth `phi` from +x, radians.
pub(crate) fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}
