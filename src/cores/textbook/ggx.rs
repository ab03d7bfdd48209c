//! A rough conductor: single reflection from GGX microfacets, separable Smith masking.
//!
//! Formulas: Walter et al. 2007 (distribution, masking); Heitz 2018, "Sampling the GGX distribution of visible
//! normals". All directions have z > 0 here.

use crate::contract::BsdfValue;
use crate::scene::Rgb;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// f = R D(h) G₁(wo) G₁(wi) / (4 cos θo cos θi), and the density of visible normals G₁(wo) D(h) max(0, wo·h) / cos θo
/// over the Jacobian 4 wo·h of the reflection.
pub fn evaluate(reflectance: Rgb, roughness: f64, wo: DVec3, wi: DVec3) -> BsdfValue {
    let density = facet_density(roughness, (wo + wi).normalize());
    let masked_wo = masking_over_cosine(roughness, wo);
    let masked_wi = masking_over_cosine(roughness, wi);
    let value = density * masked_wo * masked_wi / 4.0;
    BsdfValue { f: reflectance.map(|r| r * value), pdf: density * masked_wo / 4.0 }
}

/// A direction reflected from a visible facet; it may point below the horizon, where `f` is zero.
pub fn sample(roughness: f64, wo: DVec3, point: DVec2) -> DVec3 {
    let facet = visible_facet(roughness, wo, point);
    2.0 * wo.dot(facet) * facet - wo
}

/// D: area of facets with normal `h` per unit of surface and solid angle.
///
/// Written with h.x² + h.y² in place of 1 − h.z², which would lose all digits for small roughness.
fn facet_density(roughness: f64, h: DVec3) -> f64 {
    let alpha_squared = roughness * roughness;
    let stretched = h.x * h.x + h.y * h.y + alpha_squared * h.z * h.z;
    alpha_squared * FRAC_1_PI / (stretched * stretched)
}

/// G₁(w)/cos θ with G₁ = 2/(1 + √(1 + α² tan² θ)): finite down to the horizon, where both are zero.
fn masking_over_cosine(roughness: f64, w: DVec3) -> f64 {
    let alpha_squared = roughness * roughness;
    let sine_squared = w.x * w.x + w.y * w.y;
    2.0 / (w.z + (w.z * w.z + alpha_squared * sine_squared).sqrt())
}

/// Heitz 2018, listing 1: stretch to the unit hemisphere, sample its projected area as seen from `wo`, unstretch.
fn visible_facet(roughness: f64, wo: DVec3, point: DVec2) -> DVec3 {
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
