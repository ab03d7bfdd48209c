//! A smooth interface between vacuum (the side of the normal) and glass, with the exact Fresnel equations.
//! Radiance over index squared is conserved, so radiance itself changes when it crosses.

use super::scattering::Scattering;
use glam::{Vec3, vec3};

#[derive(Clone, Debug)]
pub(crate) struct Glass {
    index: f32,
    reflectance: Vec3,
    transmittance: Vec3,
}

impl Glass {
    /// `index` of refraction inside; the colours multiply what Fresnel's equations say.
    pub(crate) const fn new(index: f64, reflectance: Vec3, transmittance: Vec3) -> Self {
        Self { index: index as f32, reflectance, transmittance }
    }

    /// Reflects with the probability of the Fresnel reflectance, `lobe` below it, and refracts otherwise.
    pub(crate) fn sample(&self, wo: Vec3, lobe: f32) -> Option<Scattering> {
        // Index on the far side of the interface over that on the side of `wo`.
        let index = if wo.z > 0.0 { self.index } else { 1.0 / self.index };
        let sine_square = (wo.x * wo.x + wo.y * wo.y) / (index * index);
        let cosine_beyond = (1.0 - sine_square).max(0.0).sqrt();
        let reflected = if sine_square < 1.0 {
            fresnel_reflectance(wo.z.abs(), cosine_beyond, index)
        } else {
            1.0
        };
        if lobe < reflected {
            let wi = vec3(-wo.x, -wo.y, wo.z);
            return Some(Scattering { wi, weight: self.reflectance, pdf: reflected });
        }
        let wi = vec3(-wo.x / index, -wo.y / index, -cosine_beyond.copysign(wo.z)).normalize();
        // Radiance arrives from the far side and leaves on this one: L/n² is what is carried over.
        let weight = self.transmittance / (index * index);
        (cosine_beyond > 0.0).then_some(Scattering { wi, weight, pdf: 1.0 - reflected })
    }
}

/// Unpolarised reflectance for cosines on this side and beyond, and the index beyond over that on this side.
fn fresnel_reflectance(cosine: f32, cosine_beyond: f32, index: f32) -> f32 {
    let perpendicular = (cosine - index * cosine_beyond) / (cosine + index * cosine_beyond);
    let parallel = (index * cosine - cosine_beyond) / (index * cosine + cosine_beyond);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}
