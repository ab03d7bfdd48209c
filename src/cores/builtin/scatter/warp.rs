//! From the unit square to directions of the uniform and the cosine-weighted hemisphere about +z, in single precision.

use crate::contract::Sampler;
use glam::{DVec2, Vec2, Vec3, vec3};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

/// The largest f32 below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Pdf, per steradian, of [`uniform_hemisphere`]: 1/2π.
pub(crate) const UNIFORM_PDF: f32 = 0.5 * FRAC_1_PI;

/// A random number in single precision. Rounding must not turn a number below 1 into 1.
pub(crate) fn narrow(number: f64) -> f32 {
    (number as f32).min(BELOW_ONE)
}

/// A random point in single precision, still inside the half-open unit square.
pub(crate) fn narrow_point(point: DVec2) -> Vec2 {
    Vec2::new(narrow(point.x), narrow(point.y))
}

/// The direction that a point of the unit square becomes.
pub(crate) fn direction(sampler: Sampler, point: Vec2) -> Vec3 {
    match sampler {
        Sampler::UniformHemisphere => uniform_hemisphere(point),
        Sampler::CosineHemisphere => cosine_hemisphere(point),
    }
}

/// Pdf, per steradian, of [`direction`]; zero below the horizon.
pub(crate) fn pdf(sampler: Sampler, direction: Vec3) -> f32 {
    match sampler {
        Sampler::UniformHemisphere if direction.z >= 0.0 => UNIFORM_PDF,
        Sampler::UniformHemisphere => 0.0,
        Sampler::CosineHemisphere => cosine_pdf(direction.z),
    }
}

/// Uniform over the hemisphere: the height is uniform (Archimedes).
pub(crate) fn uniform_hemisphere(point: Vec2) -> Vec3 {
    // With z = 1 − u, sin² θ = u (2 − u) has no cancellation, and z is never 0.
    let radius = (point.x * (2.0 - point.x)).sqrt();
    let (sine, cosine) = sin_cos_of_turns(point.y);
    vec3(radius * cosine, radius * sine, 1.0 - point.x)
}

/// Proportional to the cosine: a uniform point of the disk, lifted to the sphere (Malley).
pub(crate) fn cosine_hemisphere(point: Vec2) -> Vec3 {
    let radius = point.x.sqrt();
    let (sine, cosine) = sin_cos_of_turns(point.y);
    vec3(radius * cosine, radius * sine, (1.0 - point.x).sqrt())
}

/// Pdf, per steradian, of [`cosine_hemisphere`]; zero below the horizon.
pub(crate) fn cosine_pdf(cosine: f32) -> f32 {
    cosine.max(0.0) * FRAC_1_PI
}

/// Sine and cosine of a whole turn times `turns`, for `turns` in [0, 1].
///
/// The same on every machine, which the standard library's are not, and two to three times as fast. The
/// argument is brought to ±π/4 exactly; the Taylor remainders there are below 2⁻²⁹ (sine) and 2⁻³³ (cosine).
pub(crate) fn sin_cos_of_turns(turns: f32) -> (f32, f32) {
    let quarter = (4.0 * turns + 0.5) as u8;
    let angle = (4.0 * turns - f32::from(quarter)) * FRAC_PI_2;
    let square = angle * angle;
    let sine = angle
        * (1.0
            - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))));
    let cosine = 1.0
        - square / 2.0
            * (1.0
                - square / 12.0
                    * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0))));
    match quarter {
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        3 => (-cosine, sine),
        _ => (sine, cosine),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn sines_and_cosines_are_right_to_the_last_bits() {
        for step in 0..=100_000_u32 {
            let turns = step as f32 / 100_000.0;
            let (sine, cosine) = sin_cos_of_turns(turns);
            let (right_sine, right_cosine) = (TAU * f64::from(turns)).sin_cos();
            assert!((f64::from(sine) - right_sine).abs() <= 2.4e-7, "sine of {turns} turns");
            assert!((f64::from(cosine) - right_cosine).abs() <= 2.4e-7, "cosine of {turns} turns");
        }
    }
}
