//! Quadrature for the tests of the closed forms: the defining integrals, evaluated without
//! cleverness.

use crate::math::quadrature::{Diligence, Rectangle, tests};
use glam::{DVec2, DVec3};

/// The integral of `f` over the rectangle from `low` to `high`, to about 1e-9.
pub(crate) fn over(low: DVec2, high: DVec2, f: impl Fn(DVec2) -> f64) -> f64 {
    let diligence = Diligence { tolerance: 1e-9, most_evaluations: 4_000_000 };
    tests::over(Rectangle { low, high }, diligence, f).value
}

pub(crate) fn over_unit_square(f: impl Fn(DVec2) -> f64) -> f64 {
    over(DVec2::ZERO, DVec2::ONE, f)
}

/// cos θ cos θ′ / (π r²) between a receiver at the origin and a point whose normal is `normal`;
/// both cosines clamped at 0.
pub(crate) fn kernel(receiver_normal: DVec3, point: DVec3, normal: DVec3) -> f64 {
    let squared = point.length_squared();
    let arriving = point.dot(receiver_normal).max(0.0);
    let leaving = (-point.dot(normal)).max(0.0);
    arriving * leaving / (std::f64::consts::PI * squared * squared)
}

/// Panics unless `found` is `expected` to a relative error of `allowed`.
#[track_caller]
pub(crate) fn assert_close(found: f64, expected: f64, allowed: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error <= allowed, "{found} is not {expected}: off by {error:e}");
}
