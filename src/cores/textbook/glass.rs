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
    /// Multiplies what is let through.
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

    fn clear() -> Glass {
        Glass { index: 1.5, reflectance: [1.0; 3], transmittance: [1.0; 3] }
    }

    fn from_degrees(degrees: f64) -> DVec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        DVec3::new(sine, 0.0, cosine)
    }

    fn refracted(wo: DVec3) -> BsdfSample {
        let almost_one = 1.0 - f64::EPSILON;
        clear().sample(wo, almost_one, &LESSON).expect("light passes")
    }

    /// Mean over the hemisphere with cosine weight: ∫ 2c F(c) dc.
    fn mean_reflectance(ratio: f64) -> f64 {
        let steps = 200_000;
        (0..steps)
            .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
            .map(|cosine| 2.0 * cosine * fresnel(cosine, ratio) / f64::from(steps))
            .sum()
    }

    #[test]
    fn reflectance_has_the_known_values() {
        let at_60 = 60.0_f64.to_radians().cos();
        assert!((fresnel(1.0, 1.5) - 0.04).abs() < 1e-15);
        assert!((fresnel(at_60, 1.5) - 0.089_186_712_8).abs() < 1e-10);
        // Walsh's closed forms, S25.
        assert!((mean_reflectance(1.5) - 0.091_777_959_34).abs() < 1e-8);
        assert!((mean_reflectance(1.0 / 1.5) - 0.596_345_759_7).abs() < 1e-7);
    }

    #[test]
    fn light_bends_towards_the_normal_as_snell_says() {
        let sample = refracted(from_degrees(50.0));
        let expected = (50.0_f64.to_radians().sin() / 1.5).asin();
        assert!(sample.wi.z < 0.0 && sample.wi.x < 0.0, "{sample:?}");
        assert!(((-sample.wi.x).asin() - expected).abs() < 1e-14, "{sample:?}");
    }

    #[test]
    fn beyond_the_critical_angle_everything_is_reflected() {
        let critical = (1.0_f64 / 1.5).asin().to_degrees();
        let below = |degrees| -from_degrees(degrees);
        assert!(refracted(below(critical - 0.01)).wi.z > 0.0);
        let reflected = clear().sample(below(critical + 0.01), 0.999, &LESSON);
        let reflected = reflected.expect("light comes back");
        assert!(reflected.wi.z < 0.0 && reflected.pdf == 1.0, "{reflected:?}");
    }

    #[test]
    fn in_and_out_again_radiance_is_as_before() {
        let weight = |sample: &BsdfSample| sample.f[0] * sample.wi.z.abs() / sample.pdf;
        let inward = refracted(from_degrees(35.0));
        let outward = refracted(inward.wi);
        assert!((weight(&inward) - 1.0 / 2.25).abs() < 1e-14, "{}", weight(&inward));
        assert!((weight(&outward) - 2.25).abs() < 1e-13, "{}", weight(&outward));
    }

    #[test]
    fn light_along_the_surface_is_a_failed_sample_and_not_a_number_game() {
        assert_eq!(clear().sample(DVec3::X, 0.3, &LESSON), None);
    }
}
