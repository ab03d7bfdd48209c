//! A rough interface between vacuum (the side of the normal) and glass: GGX microfacets, each a smooth interface.
//!
//! Formulas: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", with
//! i = wi, o = wo and m = the microfacet's normal, which has z > 0 here whichever side light comes from.

use super::bsdf::{self, NOTHING};
use super::ggx;
use super::glass;
use super::steps::Steps;
use crate::contract::{BsdfSample, BsdfValue};
use crate::scene::Rgb;
use glam::{DVec2, DVec3};

#[derive(Clone, Copy, Debug)]
pub(crate) struct RoughGlass {
    /// Of the inside; outside is vacuum.
    pub(crate) index: f64,
    /// The width α of the distribution of microfacets.
    pub(crate) roughness: f64,
    /// Multiplies what is reflected.
    pub(crate) reflectance: Rgb,
    /// Multiplies what is transmitted.
    pub(crate) transmittance: Rgb,
}

impl RoughGlass {
    /// `f` and the pdf of [`Self::sample`].
    pub(crate) fn evaluate(&self, wo: DVec3, wi: DVec3, steps: &Steps) -> BsdfValue {
        if wo.z * wi.z > 0.0 {
            self.reflection(wo, wi, steps)
        } else if wo.z * wi.z < 0.0 {
            self.refraction(wo, wi, steps)
        } else {
            NOTHING
        }
    }

    /// Walter's equation 20, F D G / (4 |cos θi| |cos θo|), and 14 for the Jacobian 1 / (4 |o·m|).
    fn reflection(&self, wo: DVec3, wi: DVec3, steps: &Steps) -> BsdfValue {
        let microfacet = upward((wo + wi).normalize());
        let cosine = wo.dot(microfacet).abs();
        let reflected = self.fresnel(wo, microfacet, steps);
        let value = reflected * self.microfacets_over_cosines(wo, wi, microfacet, steps) / 4.0;
        let jacobian = 1.0 / (4.0 * cosine);
        let pdf =
            steps.lobe_probability(reflected) * self.visible_normals_pdf(wo, microfacet) * jacobian;
        BsdfValue { f: self.reflectance.map(|r| r * value), pdf }
    }

    /// Walter's equation 21, with the indices divided by the one on the side of `wo`, and 17 for the Jacobian.
    fn refraction(&self, wo: DVec3, wi: DVec3, steps: &Steps) -> BsdfValue {
        let ratio = self.ratio(wo);
        let microfacet = steps.refraction_microfacet(self, wo, wi);
        let (o_m, i_m) = (wo.dot(microfacet), wi.dot(microfacet));
        if o_m * wo.z <= 0.0 || i_m * wi.z <= 0.0 {
            return NOTHING;
        }
        let passed = 1.0 - self.fresnel(wo, microfacet, steps);
        let denominator = (o_m + ratio * i_m).powi(2);
        let jacobian = steps.refraction_jacobian(ratio, i_m, denominator);
        let pdf =
            steps.lobe_probability(passed) * self.visible_normals_pdf(wo, microfacet) * jacobian;
        let value =
            passed * self.microfacets_over_cosines(wo, wi, microfacet, steps) * (o_m * i_m).abs()
                / denominator
                * steps.rough_radiance_scale(ratio);
        BsdfValue { f: self.transmittance.map(|t| t * value), pdf }
    }

    /// One incident direction for `wo`: a microfacet that is seen, which reflects with the probability of Fresnel's
    /// reflectance and refracts otherwise. What comes out on the wrong side of the surface is lost.
    pub(crate) fn sample(
        &self,
        wo: DVec3,
        point: DVec2,
        lobe: f64,
        steps: &Steps,
    ) -> Option<BsdfSample> {
        let side = wo.z.signum();
        let towards_wo = side * ggx::visible_microfacet(self.roughness, side * wo, point);
        let (cosine, ratio) = (wo.dot(towards_wo), self.ratio(wo));
        let reflects = lobe < self.fresnel(wo, towards_wo, steps);
        let wi = if reflects {
            2.0 * cosine * towards_wo - wo
        } else {
            let beyond = glass::refracted_cosine(cosine, ratio)?;
            ((cosine / ratio - beyond) * towards_wo - wo / ratio).normalize()
        };
        let is_lost = (wi.z * wo.z > 0.0) != reflects;
        let value = self.evaluate(wo, wi, steps);
        (value.pdf > 0.0 && !is_lost).then(|| bsdf::sampled(wi, value))
    }

    /// Index of refraction on the far side over that on the side of `wo`.
    pub(crate) fn ratio(&self, wo: DVec3) -> f64 {
        glass::relative_index(self.index, wo)
    }

    /// Share of light that the microfacet reflects.
    fn fresnel(&self, wo: DVec3, microfacet: DVec3, steps: &Steps) -> f64 {
        glass::fresnel(steps.fresnel_cosine(wo, microfacet), self.ratio(wo))
    }

    /// D G / (|cos θi| |cos θo|).
    fn microfacets_over_cosines(
        &self,
        wo: DVec3,
        wi: DVec3,
        microfacet: DVec3,
        steps: &Steps,
    ) -> f64 {
        let (wo, wi) = (wo.with_z(wo.z.abs()), wi.with_z(wi.z.abs()));
        let masking_over_cosines = steps.masking_over_cosines(self.roughness, wo, wi);
        ggx::normal_distribution(self.roughness, microfacet) * masking_over_cosines
    }

    /// The pdf of visible normals: G₁(wo) D |wo·m| / |cos θo|.
    fn visible_normals_pdf(&self, wo: DVec3, microfacet: DVec3) -> f64 {
        let masked = ggx::masking_over_cosine(self.roughness, wo.with_z(wo.z.abs()));
        masked * ggx::normal_distribution(self.roughness, microfacet) * wo.dot(microfacet).abs()
    }
}

/// The cosine that Fresnel's equations take: light meets the microfacet, not the surface.
pub(crate) fn fresnel_cosine(wo: DVec3, microfacet: DVec3) -> f64 {
    wo.dot(microfacet).abs()
}

/// The microfacet that refracts `wi` towards `wo`: Walter's equation 16.
pub(crate) fn refraction_microfacet(glass: &RoughGlass, wo: DVec3, wi: DVec3) -> DVec3 {
    upward((-(wo + glass.ratio(wo) * wi)).normalize())
}

/// Solid angle of microfacets per solid angle of refracted directions: Walter's equation 17.
pub(crate) fn refraction_jacobian(ratio: f64, i_m: f64, denominator: f64) -> f64 {
    ratio * ratio * i_m.abs() / denominator
}

/// A sample goes each way with the probability of that way's share of the light.
pub(crate) fn lobe_probability(share: f64) -> f64 {
    share
}

/// G / (cos θo cos θi), with separable masking.
pub(crate) fn masking_over_cosines(roughness: f64, wo: DVec3, wi: DVec3) -> f64 {
    ggx::masking_over_cosine(roughness, wo) * ggx::masking_over_cosine(roughness, wi)
}

/// Equation 21 is of radiance that is scaled by the index squared where it crosses.
pub(crate) fn rough_radiance_scale(_ratio: f64) -> f64 {
    1.0
}

/// The normal of a microfacet, which points out of the glass.
pub(crate) fn upward(microfacet: DVec3) -> DVec3 {
    if microfacet.z < 0.0 { -microfacet } else { microfacet }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::glass::Glass;
    use crate::cores::textbook::random::Random;
    use crate::cores::textbook::sampling;
    use crate::cores::textbook::steps::LESSON;

    const WHITE: Rgb = [1.0; 3];

    fn frosted(roughness: f64) -> RoughGlass {
        RoughGlass { index: 1.5, roughness, reflectance: WHITE, transmittance: WHITE }
    }

    fn view(degrees: f64) -> DVec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        DVec3::new(sine, 0.0, cosine)
    }

    fn weight(sample: &BsdfSample) -> f64 {
        sample.f[0] * sample.wi.z.abs() / sample.pdf
    }

    #[test]
    fn nearly_smooth_glass_is_smooth_glass() {
        let smooth = Glass { index: 1.5, reflectance: WHITE, transmittance: WHITE };
        for wo in [view(30.0), view(70.0), view(160.0), view(120.0)] {
            for lobe in [0.0, 0.9999] {
                let rough = frosted(1e-4).sample(wo, DVec2::new(0.2, 0.7), lobe, &LESSON);
                let (rough, smooth) = (
                    rough.expect("light goes on"),
                    smooth.sample(wo, lobe, &LESSON).expect("light goes on"),
                );
                assert!(rough.wi.abs_diff_eq(smooth.wi, 1e-3), "{wo}: {rough:?} {smooth:?}");
                assert!((weight(&rough) / weight(&smooth) - 1.0).abs() < 1e-3, "{wo}");
            }
        }
    }

    #[test]
    fn samples_of_both_sides_say_what_evaluation_says() {
        let mut random = Random::for_ray(2, 0);
        let mut passed = 0;
        for roughness in [1e-3, 0.1, 0.5, 1.0] {
            let glass = frosted(roughness);
            for _ in 0..2000 {
                let wo = sampling::uniform_sphere(random.point());
                let Some(sample) = glass.sample(wo, random.point(), random.number(), &LESSON)
                else {
                    continue;
                };
                let value = glass.evaluate(wo, sample.wi, &LESSON);
                assert_eq!((sample.f, sample.pdf), (value.f, value.pdf), "{roughness} {wo}");
                assert!((sample.wi.length() - 1.0).abs() < 1e-12 && weight(&sample) < 2.2501);
                passed += usize::from(sample.wi.z * wo.z < 0.0);
            }
        }
        assert!(passed > 3000, "{passed}");
    }
}
