//! GGX microfacets: the normal distribution function D, with separable Smith masking-shadowing, seen
//! from above. Sampled by the visible normals (Heitz 2018, "Sampling the GGX distribution of visible normals").
//!
//! With s(w) = cos θ + √(cos² θ + α² sin² θ), Smith's masking is G₁(w) = 2 cos θ / s(w). Written with s, the cosines
//! of microfacet formulas and of their pdfs cancel, also at grazing angles.

use super::warp::sin_cos_of_turns;
use glam::{Vec2, Vec3, vec3};
use std::f32::consts::FRAC_1_PI;

#[derive(Clone, Debug)]
pub(crate) struct Microfacets {
    roughness: f32,
}

impl Microfacets {
    pub(crate) const fn new(roughness: f32) -> Self {
        Self { roughness }
    }

    /// D(h) = α² / (π (sin² θ + α² cos² θ)²), from the components, which near the normal are more exact than
    /// the cosine.
    pub(crate) fn distribution(&self, half: Vec3) -> f32 {
        let alpha = self.roughness;
        let sine_square = half.x * half.x + half.y * half.y;
        let ratio = alpha / (sine_square + alpha * alpha * half.z * half.z);
        ratio * ratio * FRAC_1_PI
    }

    /// s(w).
    pub(crate) fn masking_sum(&self, w: Vec3) -> f32 {
        let alpha = self.roughness;
        w.z + (w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y)).sqrt()
    }

    /// Heitz 2018, listing 1: the hemisphere stretched to roughness 1, its projection sampled, and back.
    pub(crate) fn visible_normal(&self, wo: Vec3, point: Vec2) -> Vec3 {
        let alpha = self.roughness;
        let stretched = vec3(alpha * wo.x, alpha * wo.y, wo.z).normalize();
        let length = stretched.x.hypot(stretched.y);
        let first = if length > 0.0 {
            vec3(-stretched.y / length, stretched.x / length, 0.0)
        } else {
            Vec3::X
        };
        let second = stretched.cross(first);
        let (sine, cosine) = sin_cos_of_turns(point.y);
        let along_first = point.x.sqrt() * cosine;
        let visible = 0.5 * (1.0 + stretched.z);
        let along_second = (1.0 - visible) * (1.0 - along_first * along_first).max(0.0).sqrt()
            + visible * point.x.sqrt() * sine;
        let up = (1.0 - along_first * along_first - along_second * along_second).max(0.0).sqrt();
        let normal = along_first * first + along_second * second + up * stretched;
        vec3(alpha * normal.x, alpha * normal.y, normal.z.max(0.0)).normalize()
    }
}
