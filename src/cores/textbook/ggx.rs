//! A rough conductor: single reflection from GGX microfacets, separable Smith masking-shadowing.
//!
//! Formulas: Walter et al. 2007 (distribution, masking); Heitz 2018, "Sampling the GGX distribution
//! of visible normals". All directions have z > 0 here.

use super::steps::Steps;
use crate::contract::BsdfValue;
use crate::scene::Rgb;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// What f and pdf of a pair of directions are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Microfacets {
    /// α.
    pub(crate) roughness: f64,
    /// Towards the viewer.
    pub(crate) wo: DVec3,
    /// Towards the light.
    pub(crate) wi: DVec3,
    /// The normal h of the microfacets that reflect one into the other.
    pub(crate) normal: DVec3,
    /// D(h).
    pub(crate) distribution: f64,
    /// G₁(wo)/cos θo and G₁(wi)/cos θi.
    pub(crate) masking_over_cosine: [f64; 2],
}

/// `f` and the pdf of [`sample`].
pub(crate) fn evaluate(
    reflectance: Rgb,
    roughness: f64,
    wo: DVec3,
    wi: DVec3,
    steps: &Steps,
) -> BsdfValue {
    let roughness = steps.alpha(roughness);
    let normal = (wo + wi).normalize();
    let distribution = normal_distribution(roughness, normal);
    let masking_over_cosine = [wo, wi].map(|w| masking_over_cosine(roughness, w));
    let microfacets = Microfacets { roughness, wo, wi, normal, distribution, masking_over_cosine };
    let value = steps.metal_f(&microfacets);
    BsdfValue { f: reflectance.map(|r| r * value), pdf: steps.metal_pdf(&microfacets) }
}

/// The width of the lobe is the roughness itself.
pub(crate) fn alpha(roughness: f64) -> f64 {
    roughness
}

/// f/R = D(h) G₁(wo) G₁(wi) / (4 cos θo cos θi).
pub(crate) fn metal_f(microfacets: &Microfacets) -> f64 {
    let [masking_wo, masking_wi] = microfacets.masking_over_cosine;
    microfacets.distribution * masking_wo * masking_wi / 4.0
}

/// The pdf of visible normals, G₁(wo) D(h) max(0, wo·h) / cos θo, over the Jacobian 4 wo·h of the reflection.
pub(crate) fn metal_pdf(microfacets: &Microfacets) -> f64 {
    microfacets.distribution * microfacets.masking_over_cosine[0] / 4.0
}

/// A direction reflected from a visible microfacet; it may point below the horizon, where `f` is zero.
pub(crate) fn sample(roughness: f64, wo: DVec3, point: DVec2, steps: &Steps) -> DVec3 {
    let microfacet = visible_microfacet(steps.alpha(roughness), wo, point);
    2.0 * wo.dot(microfacet) * microfacet - wo
}

/// D: area of microfacets with normal `h` per unit of surface and solid angle.
///
/// Written with h.x² + h.y² in place of 1 − h.z², which would lose all digits for small roughness.
pub(crate) fn normal_distribution(roughness: f64, h: DVec3) -> f64 {
    let alpha_squared = roughness * roughness;
    let stretched = h.x * h.x + h.y * h.y + alpha_squared * h.z * h.z;
    alpha_squared * FRAC_1_PI / (stretched * stretched)
}

/// G₁(w)/cos θ with G₁ = 2/(1 + √(1 + α² tan² θ)): finite down to the horizon, where both are zero.
pub(crate) fn masking_over_cosine(roughness: f64, w: DVec3) -> f64 {
    let alpha_squared = roughness * roughness;
    let sine_squared = w.x * w.x + w.y * w.y;
    2.0 / (w.z + (w.z * w.z + alpha_squared * sine_squared).sqrt())
}

/// Heitz 2018, listing 1: stretch to the unit hemisphere, sample its projected area as seen from `wo`, unstretch.
pub(crate) fn visible_microfacet(roughness: f64, wo: DVec3, point: DVec2) -> DVec3 {
    let view = DVec3::new(roughness * wo.x, roughness * wo.y, wo.z).normalize();
    let across = DVec3::new(-view.y, view.x, 0.0).try_normalize().unwrap_or(DVec3::X);
    let along = view.cross(across);
    let disk = visible_disk_point(view, point);
    let height = (1.0 - disk.length_squared()).max(0.0).sqrt();
    let stretched = disk.x * across + disk.y * along + height * view;
    DVec3::new(roughness * stretched.x, roughness * stretched.y, stretched.z.max(0.0)).normalize()
}

/// A uniform point on the part of the unit disk across `view` behind which the hemisphere lies.
fn visible_disk_point(view: DVec3, point: DVec2) -> DVec2 {
    let radius = point.x.sqrt();
    let (sine, cosine) = (2.0 * PI * point.y).sin_cos();
    let x = radius * cosine;
    let visible = (1.0 + view.z) / 2.0;
    let y = (1.0 - visible) * (1.0 - x * x).sqrt() + visible * radius * sine;
    DVec2::new(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::sampling::direction_at;

    #[test]
    fn microfacets_cover_the_surface_once() {
        for roughness in [0.1, 0.6, 1.0] {
            let heights = 20_000;
            let total: f64 = (0..heights)
                .map(|i| (f64::from(i) + 0.5) / f64::from(heights))
                .map(|z| normal_distribution(roughness, direction_at(z, 0.2)) * z)
                .sum();
            let total = 2.0 * PI * total / f64::from(heights);
            assert!((total - 1.0).abs() < 1e-5, "{roughness}: {total}");
        }
    }
}
