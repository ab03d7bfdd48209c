//! GGX: its normal distribution function D, its masking-shadowing G, and the directional albedo of a
//! perfect rough conductor.
//!
//! Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007); Heitz,
//! "Understanding the Masking-Shadowing Function" (2014). Only single scattering: what bounces
//! twice between microfacets is lost.

use crate::math::quadrature::integrate;
use std::f64::consts::PI;

/// How masking towards viewer and light combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Masking {
    /// G₁(wo) G₁(wi), as if the two were independent. Mitsuba's.
    Separable,
    /// 1 / (1 + Λ(wo) + Λ(wi)): deep points are hidden from both.
    HeightCorrelated,
}

/// The normal distribution function D at this cosine to the surface normal, per steradian; ∫ D cos dω =
/// 1.
pub(crate) fn distribution(cos_theta: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let c2 = cos_theta * cos_theta;
    a2 / (PI * (c2 * (a2 - 1.0) + 1.0).powi(2))
}

/// Smith's Λ: hidden over visible area, seen at this cosine.
pub(crate) fn lambda(cos_theta: f64, alpha: f64) -> f64 {
    let c2 = cos_theta * cos_theta;
    0.5 * ((1.0 + alpha * alpha * (1.0 - c2) / c2).sqrt() - 1.0)
}

/// Masking G1: the fraction of microfacets visible from this cosine.
pub(crate) fn masking(cos_theta: f64, alpha: f64) -> f64 {
    (1.0 + lambda(cos_theta, alpha)).recip()
}

/// Masking-shadowing G: the fraction of microfacets visible from both cosines.
pub(crate) fn masking_shadowing(cos_o: f64, cos_i: f64, alpha: f64, form: Masking) -> f64 {
    match form {
        Masking::Separable => masking(cos_o, alpha) * masking(cos_i, alpha),
        Masking::HeightCorrelated => (1.0 + lambda(cos_o, alpha) + lambda(cos_i, alpha)).recip(),
    }
}

/// The share of light that a GGX conductor of reflectance 1 sends back, viewed at this cosine.
///
/// With microfacet normals distributed by D cos, the albedo is the mean of G (wo·h) / (cos θo cos θh)
/// over those that reflect above the horizon. For each θh they are an interval of φ, whose end is
/// known, so the integrand is smooth.
pub(crate) fn albedo(cos_o: f64, alpha: f64, form: Masking) -> f64 {
    let (cos_o, sin_o) = (cos_o, (1.0 - cos_o * cos_o).max(0.0).sqrt());
    let over_phi = |u: f64| {
        let tangent_squared = alpha * alpha * u / (1.0 - u);
        let cos_h = (1.0 + tangent_squared).sqrt().recip();
        let sin_h = (1.0 - cos_h * cos_h).max(0.0).sqrt();
        // wi is above the horizon while 2 (wo·h) cos θh > cos θo.
        let boundary = cos_o * (0.5 / cos_h - cos_h) / (sin_o * sin_h);
        let end = if boundary.is_nan() || boundary <= -1.0 { PI } else { boundary.min(1.0).acos() };
        let weight = |phi: f64| {
            let facing = cos_o * cos_h + sin_o * sin_h * phi.cos();
            let cos_i = (2.0 * facing * cos_h - cos_o).clamp(1e-12, 1.0);
            masking_shadowing(cos_o, cos_i, alpha, form) * facing / (cos_o * cos_h)
        };
        integrate(&[0.0, end], 1e-9, weight).value / PI
    };
    // The end of the interval leaves φ = π at θh = (π/2 − θo)/2 and, head on, at 45°.
    let break_at = |theta: f64| theta.tan().powi(2) / (alpha * alpha + theta.tan().powi(2));
    let leaves = 0.5 * (0.5 * PI - cos_o.acos());
    let closes = 0.5 * (0.5 * PI + cos_o.acos());
    integrate(&[0.0, break_at(leaves), break_at(closes)], 1e-8, over_phi).value
}

#[cfg(test)]
mod tests {
    use super::super::witness::{assert_close, over};
    use super::*;
    use crate::math::frame::direction;
    use glam::{DVec2, DVec3};

    fn hemisphere(f: impl Fn(DVec3) -> f64) -> f64 {
        let top = DVec2::new(0.5 * PI, 2.0 * PI);
        over(DVec2::ZERO, top, |p| f(direction(p.x, p.y)) * p.x.sin())
    }

    #[test]
    fn microfacets_cover_the_surface_once() {
        for alpha in [0.1, 0.3, 1.0] {
            let covered = hemisphere(|h| distribution(h.z, alpha) * h.z);
            assert_close(covered, 1.0, 1e-7);
        }
    }

    #[test]
    fn visible_microfacets_cover_what_is_seen_once() {
        for (alpha, degrees) in [(0.3, 45f64), (0.6, 75.0)] {
            let wo = direction(degrees.to_radians(), 0.0);
            let seen = hemisphere(|h| {
                masking(wo.z, alpha) * wo.dot(h).max(0.0) * distribution(h.z, alpha) / wo.z
            });
            assert_close(seen, 1.0, 1e-5);
        }
    }

    /// ∫ f cos θi dωi with f = D G / (4 cos θo cos θi): the definition, over incident directions.
    fn albedo_by_definition(theta: f64, alpha: f64, form: Masking) -> f64 {
        let wo = direction(theta, 0.0);
        hemisphere(|wi| {
            let h = (wo + wi).normalize();
            distribution(h.z, alpha) * masking_shadowing(wo.z, wi.z.max(1e-12), alpha, form)
                / (4.0 * wo.z)
        })
    }

    #[test]
    fn the_albedo_agrees_with_its_definition() {
        for (alpha, degrees) in [(0.3, 0f64), (0.6, 45.0), (1.0, 75.0)] {
            for form in [Masking::Separable, Masking::HeightCorrelated] {
                let theta = degrees.to_radians();
                let expected = albedo_by_definition(theta, alpha, form);
                assert_close(albedo(theta.cos(), alpha, form), expected, 1e-5);
            }
        }
    }

    #[test]
    fn the_albedo_is_that_of_the_table() {
        for [alpha, degrees, correlated, separable] in [
            [0.1, 0.0f64, 0.988_306, 0.988_306],
            [0.1, 75.0, 0.924_418, 0.923_240],
            [0.3, 45.0, 0.845_396, 0.844_432],
            [0.3, 60.0, 0.821_711, 0.818_134],
            [0.6, 75.0, 0.727_138, 0.676_011],
            [1.0, 45.0, 0.376_775, 0.359_500],
            [1.0, 75.0, 0.590_600, 0.487_525],
        ] {
            let cosine = degrees.to_radians().cos();
            assert_close(albedo(cosine, alpha, Masking::HeightCorrelated), correlated, 2e-6);
            assert_close(albedo(cosine, alpha, Masking::Separable), separable, 2e-6);
        }
    }

    #[test]
    fn at_roughness_one_head_on_the_albedo_is_one_minus_ln_two() {
        let expected = 1.0 - 2f64.ln();
        assert_close(albedo(1.0, 1.0, Masking::Separable), expected, 1e-7);
        assert_close(albedo(1.0, 1.0, Masking::HeightCorrelated), expected, 1e-7);
    }
}
