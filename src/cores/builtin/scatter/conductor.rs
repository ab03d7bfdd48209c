//! A rough conductor: GGX microfacets that reflect the same at every angle.
//!
//! Written with the masking sums of `microfacets`, f = R D G₁ G₁ / (4 cos cos) and its pdf G₁ D / (4 cos) have no
//! cosines left.

use super::microfacets::Microfacets;
use super::scattering::Scattering;
use glam::{Vec2, Vec3};

/// A rough conductor seen from its upper side.
#[derive(Clone, Debug)]
pub(crate) struct Conductor {
    reflectance: Vec3,
    microfacets: Microfacets,
}

impl Conductor {
    /// `reflectance` of a single microfacet, and the width α of the distribution.
    pub(crate) const fn new(reflectance: Vec3, roughness: f32) -> Self {
        Self { reflectance, microfacets: Microfacets::new(roughness) }
    }

    /// `f` and pdf for two directions of the upper side.
    pub(crate) fn evaluate(&self, wo: Vec3, wi: Vec3) -> (Vec3, f32) {
        let distribution = self.microfacets.distribution((wo + wi).normalize());
        let (s_wo, s_wi) = (self.microfacets.masking_sum(wo), self.microfacets.masking_sum(wi));
        (self.reflectance * (distribution / (s_wo * s_wi)), distribution / (2.0 * s_wo))
    }

    /// A reflection on a microfacet that `wo` sees; `None` if it goes down into the surface.
    pub(crate) fn sample(&self, wo: Vec3, point: Vec2) -> Option<Scattering> {
        let microfacet = self.microfacets.visible_normal(wo, point);
        let wi = (2.0 * wo.dot(microfacet) * microfacet - wo).normalize();
        (wi.z > 0.0).then(|| {
            let weight = self.reflectance * (2.0 * wi.z / self.microfacets.masking_sum(wi));
            Scattering { wi, weight, pdf: self.evaluate(wo, wi).1 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    fn towards(degrees: f32) -> Vec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        vec3(sine, 0.0, cosine)
    }

    #[test]
    fn extreme_directions_and_widths_give_finite_answers() {
        for roughness in [1e-4, 0.01, 1.0] {
            let conductor = Conductor::new(Vec3::ONE, roughness);
            for wo in [Vec3::Z, towards(89.999), vec3(1.0, 0.0, 1e-20)] {
                for point in [Vec2::ZERO, Vec2::splat(0.5), Vec2::splat(1.0 - f32::EPSILON / 2.0)] {
                    if let Some(sample) = conductor.sample(wo, point) {
                        let (f, pdf) = conductor.evaluate(wo, sample.wi);
                        assert!(f.is_finite() && pdf.is_finite() && pdf >= 0.0, "{roughness} {wo}");
                        assert!(
                            sample.weight.is_finite() && sample.weight.max_element() <= 1.000001
                        );
                    }
                }
            }
        }
    }
}
