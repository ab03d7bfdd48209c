//! A smooth interface between vacuum (the side of the normal) and glass.

use super::bsdf;
use super::steps::Steps;
use crate::contract::BsdfSample;
use crate::scene::Rgb;
use glam::DVec3;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Glass {
    /// Of the inside; outside is vacuum.
    pub(crate) index: f64,
    /// Multiplies what is reflected.
    pub(crate) reflectance: Rgb,
    /// Multiplies what is transmitted.
    pub(crate) transmittance: Rgb,
}

impl Glass {
    /// Reflects with the probability of Fresnel's reflectance, refracts otherwise.
    pub(crate) fn sample(&self, wo: DVec3, lobe: f64, steps: &Steps) -> Option<BsdfSample> {
        let ratio = steps.relative_index(self.index, wo);
        let fresnel = steps.fresnel(wo.z.abs(), ratio);
        let (reflected, transmitted) = steps.shares(fresnel);
        if steps.reflects(lobe, fresnel) {
            let weight = self.reflectance.map(|r| r * reflected);
            return bsdf::delta(bsdf::reflect(wo), weight, fresnel);
        }
        let scale = steps.radiance_scale(ratio);
        let weight = self.transmittance.map(|t| t * transmitted * scale);
        bsdf::delta(refract(wo, ratio)?, weight, 1.0 - fresnel)
    }
}

/// Index of refraction on the far side over that on the side of `wo`.
pub(crate) fn relative_index(index: f64, wo: DVec3) -> f64 {
    if wo.z > 0.0 { index } else { 1.0 / index }
}

/// The unpolarised reflectance of Fresnel's equations for light that arrives at `cosine` > 0.
pub(crate) fn fresnel(cosine: f64, ratio: f64) -> f64 {
    let Some(refracted) = refracted_cosine(cosine, ratio) else { return 1.0 };
    let perpendicular = (cosine - ratio * refracted) / (cosine + ratio * refracted);
    let parallel = (ratio * cosine - refracted) / (ratio * cosine + refracted);
    (perpendicular * perpendicular + parallel * parallel) / 2.0
}

/// Cosine of the refracted direction by Snell's law; `None` if all light is reflected.
pub(crate) fn refracted_cosine(cosine: f64, ratio: f64) -> Option<f64> {
    let sine_squared = (1.0 - cosine * cosine) / (ratio * ratio);
    (sine_squared < 1.0).then(|| (1.0 - sine_squared).sqrt())
}

/// The number of the lobe decides: reflection has the probability `fresnel`.
pub(crate) fn reflects(lobe: f64, fresnel: f64) -> bool {
    lobe < fresnel
}

/// The shares of light that are reflected and transmitted.
pub(crate) fn shares(fresnel: f64) -> (f64, f64) {
    (fresnel, 1.0 - fresnel)
}

/// Radiance over index squared is what crosses an interface unchanged: light that comes to the
/// side of `wo` out of the denser medium is spread over a wider cone.
pub(crate) fn radiance_scale(ratio: f64) -> f64 {
    1.0 / (ratio * ratio)
}

/// The direction on the far side from which light is bent towards `wo`.
fn refract(wo: DVec3, ratio: f64) -> Option<DVec3> {
    let cosine = refracted_cosine(wo.z.abs(), ratio)?;
    Some(DVec3::new(-wo.x / ratio, -wo.y / ratio, -cosine.copysign(wo.z)).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;

    #[test]
    fn light_along_the_surface_is_a_failed_sample_and_not_a_number_game() {
        let clear = Glass { index: 1.5, reflectance: [1.0; 3], transmittance: [1.0; 3] };
        assert_eq!(clear.sample(DVec3::X, 0.3, &LESSON), None);
    }
}
