//! Parts 3 and 4: how surfaces scatter. Directions are local and both point away from the surface.
//!
//! Diffuse, mirror and conductor surfaces are two-sided: seen from below, both directions are turned over first.
//! Glass is not: which side is outside matters there. Not here: the formulas of `glass` and of `ggx`.

use super::{ggx, glass, sampling};
use crate::contract::{BsdfSample, BsdfValue};
use crate::scene::{Rgb, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// A pair of directions between which nothing is scattered.
pub const NOTHING: BsdfValue = BsdfValue { f: [0.0; 3], pdf: 0.0 };

/// A sample that failed.
pub const FAILED: BsdfSample =
    BsdfSample { wi: DVec3::Z, f: [0.0; 3], pdf: 0.0, is_delta: 0, is_valid: 0 };

/// Whether the surface scatters each direction into finitely many: nothing else can be evaluated, and no light be
/// sampled, there.
pub fn is_delta(surface: &Surface) -> bool {
    matches!(surface, Surface::Mirror { .. } | Surface::Glass { .. })
}

/// `f` and the density of [`sample`]. Zero for mirror and glass, and for directions on different sides.
pub fn evaluate(surface: &Surface, wo: DVec3, wi: DVec3) -> BsdfValue {
    if wo.z < 0.0 {
        evaluate_from_above(surface, -wo, -wi)
    } else {
        evaluate_from_above(surface, wo, wi)
    }
}

fn evaluate_from_above(surface: &Surface, wo: DVec3, wi: DVec3) -> BsdfValue {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return NOTHING;
    }
    match *surface {
        Surface::Diffuse { reflectance } => {
            BsdfValue { f: diffuse(reflectance), pdf: sampling::cosine_hemisphere_pdf(wi) }
        }
        Surface::Conductor { reflectance, roughness } => {
            ggx::evaluate(reflectance, roughness, wo, wi)
        }
        Surface::Mirror { .. } | Surface::Glass { .. } => NOTHING,
    }
}

/// One incident direction for `wo`; `point` chooses the direction, `lobe` between reflection and refraction.
pub fn sample(surface: &Surface, wo: DVec3, point: DVec2, lobe: f64) -> Option<BsdfSample> {
    if let Surface::Glass { index, reflectance, transmittance } = *surface {
        return glass::sample(index, reflectance, transmittance, wo, lobe);
    }
    if wo.z < 0.0 {
        let sample = sample_from_above(surface, -wo, point)?;
        return Some(BsdfSample { wi: -sample.wi, ..sample });
    }
    sample_from_above(surface, wo, point)
}

fn sample_from_above(surface: &Surface, wo: DVec3, point: DVec2) -> Option<BsdfSample> {
    let wi = match *surface {
        Surface::Diffuse { .. } => sampling::cosine_hemisphere(point),
        Surface::Conductor { roughness, .. } => ggx::sample(roughness, wo, point),
        Surface::Mirror { reflectance } => return delta(reflect(wo), reflectance, 1.0),
        Surface::Glass { .. } => return None,
    };
    let BsdfValue { f, pdf } = evaluate_from_above(surface, wo, wi);
    (pdf > 0.0).then_some(BsdfSample { wi, f, pdf, is_delta: 0, is_valid: 1 })
}

/// Lambert's law: f = reflectance/π.
fn diffuse(reflectance: Rgb) -> Rgb {
    reflectance.map(|reflectance| reflectance * FRAC_1_PI)
}

/// `w` mirrored about the normal.
pub fn reflect(w: DVec3) -> DVec3 {
    DVec3::new(-w.x, -w.y, w.z)
}

/// The only direction of a delta lobe, chosen with `probability`, that carries `weight` of the radiance along it.
///
/// f is such that f·|cos θ| is the weight: the cosine of the rendering equation has no part in a mirror. Along the
/// surface there is no such f.
pub fn delta(wi: DVec3, weight: Rgb, probability: f64) -> Option<BsdfSample> {
    let f = weight.map(|weight| weight / wi.z.abs());
    let is_sound = probability > 0.0 && f.iter().all(|f| f.is_finite());
    is_sound.then_some(BsdfSample { wi, f, pdf: probability, is_delta: 1, is_valid: 1 })
}
