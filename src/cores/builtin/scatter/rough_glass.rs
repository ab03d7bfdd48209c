//! A rough interface between vacuum (the side of the normal) and glass: GGX microfacets, each of them a smooth
//! interface (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces").
//!
//! All is worked out with the side of `wo` up: seen from inside, heights are negated and η =
//! eta_t / eta_i is below 1. A microfacet takes `wi` to `wo` by refraction if its normal is along ∓(wo + η wi);
//! the length of that vector is Walter's η wi·h + wo·h. With the masking sums of `microfacets`,
//!
//! reflected: f = F D / (s s), pdf F D / (2 s);
//! refracted: f = (1 − F) D 4 |wo·h wi·h| / (s s |wo + η wi|²), pdf (1 − F) D 2 |wo·h| η² |wi·h| / (s |wo + η wi|²).

use super::microfacets::Microfacets;
use super::scattering::Scattering;
use glam::{Vec2, Vec3, vec3};

#[derive(Clone, Debug)]
pub(crate) struct RoughGlass {
    index: f32,
    microfacets: Microfacets,
    reflectance: Vec3,
    transmittance: Vec3,
}

impl RoughGlass {
    /// `index` of refraction inside and width α; the colours multiply what Fresnel's equations say.
    pub(crate) const fn new(
        index: f64,
        roughness: f64,
        reflectance: Vec3,
        transmittance: Vec3,
    ) -> Self {
        Self {
            index: index as f32,
            microfacets: Microfacets::new(roughness as f32),
            reflectance,
            transmittance,
        }
    }

    /// `f` and pdf for two directions of any side.
    pub(crate) fn evaluate(&self, wo: Vec3, wi: Vec3) -> (Vec3, f32) {
        let index = self.index_beyond(wo);
        let (wo, wi) = (facing(wo, wo), facing(wi, wo));
        if wo.z == 0.0 || wi.z == 0.0 {
            (Vec3::ZERO, 0.0)
        } else if wi.z > 0.0 {
            self.evaluate_reflection(wo, wi, index)
        } else {
            self.evaluate_refraction(wo, wi, index)
        }
    }

    /// Index of refraction on the far side of the interface over that on the side of `wo`.
    fn index_beyond(&self, wo: Vec3) -> f32 {
        if wo.z > 0.0 { self.index } else { 1.0 / self.index }
    }

    fn evaluate_reflection(&self, wo: Vec3, wi: Vec3, index: f32) -> (Vec3, f32) {
        let sum = wo + wi;
        // Half the length is the cosine with the microfacet, and the same with wo and wi exchanged.
        let length = sum.length();
        let reflected = 1.0 - transmittance(0.5 * length, index);
        let microfacets = reflected * self.microfacets.distribution(sum / length);
        let (s_wo, s_wi) = (self.microfacets.masking_sum(wo), self.microfacets.masking_sum(wi));
        (self.reflectance * (microfacets / (s_wo * s_wi)), microfacets / (2.0 * s_wo))
    }

    fn evaluate_refraction(&self, wo: Vec3, wi: Vec3, index: f32) -> (Vec3, f32) {
        let sum = wo + index * wi;
        let length_square = sum.length_squared();
        let half = sum / length_square.sqrt().copysign(sum.z);
        let (before, beyond) = (wo.dot(half), -wi.dot(half));
        if !(before > 0.0 && beyond > 0.0) {
            return (Vec3::ZERO, 0.0);
        }
        let (s_wo, s_wi) = (
            self.microfacets.masking_sum(wo),
            self.microfacets.masking_sum(vec3(wi.x, wi.y, -wi.z)),
        );
        let microfacets = transmittance_between(before, beyond, index)
            * self.microfacets.distribution(half)
            * before
            * beyond
            / length_square;
        let f = self.transmittance * (4.0 * microfacets / (s_wo * s_wi));
        (f, 2.0 * index * index * microfacets / s_wo)
    }

    /// A microfacet that `wo` sees, which reflects with the probability of its Fresnel reflectance, `lobe` below it, and
    /// refracts otherwise; `None` if light would have to come through the interface to be reflected, or not to be
    /// refracted.
    pub(crate) fn sample(&self, wo: Vec3, point: Vec2, lobe: f32) -> Option<Scattering> {
        let index = self.index_beyond(wo);
        let up = facing(wo, wo);
        let microfacet = self.microfacets.visible_normal(up, point);
        let cosine = up.dot(microfacet);
        let (wi, colour, is_possible) = if lobe < 1.0 - transmittance(cosine, index) {
            let wi = (2.0 * cosine * microfacet - up).normalize();
            (wi, self.reflectance, wi.z > 0.0)
        } else {
            let wi = refracted(up, microfacet, index);
            // Radiance arrives from the far side and leaves on this one: L/n² is what is carried over.
            (wi, self.transmittance / (index * index), wi.z < 0.0)
        };
        let wi_up = vec3(wi.x, wi.y, wi.z.abs());
        let weight = colour * (2.0 * wi_up.z / self.microfacets.masking_sum(wi_up));
        let wi = facing(wi, wo);
        let pdf = self.evaluate(wo, wi).1;
        (is_possible && pdf > 0.0).then_some(Scattering { wi, weight, pdf })
    }
}

/// `w` turned over if `wo` is below: there, and back again.
fn facing(w: Vec3, wo: Vec3) -> Vec3 {
    vec3(w.x, w.y, w.z * 1_f32.copysign(wo.z))
}

/// The refracted direction: the microfacet transmits light from there towards `wo`.
fn refracted(wo: Vec3, microfacet: Vec3, index: f32) -> Vec3 {
    let cosine = wo.dot(microfacet);
    let beyond = cosine_beyond(cosine, index);
    (microfacet * (cosine / index - beyond) - wo / index).normalize()
}

/// Cosine of the refracted direction by Snell's law; 0 if all light is reflected.
fn cosine_beyond(cosine: f32, index: f32) -> f32 {
    (1.0 - (1.0 - cosine * cosine) / (index * index)).max(0.0).sqrt()
}

/// Unpolarised transmittance of light that arrives at this cosine; 0 if all is reflected.
fn transmittance(cosine: f32, index: f32) -> f32 {
    transmittance_between(cosine, cosine_beyond(cosine, index), index)
}

/// The same for cosines on this side and beyond: 1 − F without the cancellation, also near the critical angle.
fn transmittance_between(cosine: f32, beyond: f32, index: f32) -> f32 {
    let perpendicular = cosine + index * beyond;
    let parallel = index * cosine + beyond;
    let product = 2.0 * index * cosine * beyond;
    product * (1.0 / (perpendicular * perpendicular) + 1.0 / (parallel * parallel))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glass(roughness: f64) -> RoughGlass {
        RoughGlass::new(1.5, roughness, Vec3::ONE, Vec3::ONE)
    }

    fn towards(degrees: f32) -> Vec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        vec3(sine, 0.0, cosine)
    }

    /// Samples on a grid of points and lobes.
    fn samples(glass: &RoughGlass, wo: Vec3) -> impl Iterator<Item = Option<Scattering>> {
        let middle = |i: u16, of: u16| (f32::from(i) + 0.5) / f32::from(of);
        let points = (0..40).flat_map(|i| (0..40).map(move |j| (i, j)));
        points.flat_map(move |(i, j)| {
            let point = Vec2::new(middle(i, 40), middle(j, 40));
            (0..50).map(move |lobe| glass.sample(wo, point, middle(lobe, 50)))
        })
    }

    #[test]
    fn weights_are_f_times_cosine_over_pdf_on_both_sides() {
        for wo in [towards(40.0), towards(85.0), towards(150.0), towards(120.0)] {
            let mut sides = [0, 0];
            for Scattering { wi, weight, pdf } in samples(&glass(0.4), wo).flatten() {
                let (f, evaluated) = glass(0.4).evaluate(wo, wi);
                assert_eq!(evaluated, pdf);
                let error = (f * wi.z.abs() / pdf / weight - 1.0).abs().max_element();
                assert!(error < 1e-3, "{wo} {wi}: {error}");
                sides[usize::from(wi.z * wo.z > 0.0)] += 1;
            }
            assert!(sides[0] > 1000 && sides[1] > 1000, "{wo}: {sides:?}");
        }
    }

    /// Reflected and refracted share by the tables of the closed form, the latter over index squared.
    #[test]
    fn samples_weigh_the_shares_of_the_table() {
        for (degrees, roughness, share) in [
            (45.0, 0.3, 0.043648 + 0.927755 / 2.25),
            (75.0, 0.6, 0.052830 + 0.683856 / 2.25),
            (160.0, 0.4, 0.097546 + 0.718297 * 2.25),
            (120.0, 0.4, 0.525458 + 0.178835 * 2.25),
        ] {
            let all: Vec<_> = samples(&glass(roughness), towards(degrees)).collect();
            let sum: f32 = all.iter().flatten().map(|sample| sample.weight.x).sum();
            let mean = sum / all.len() as f32;
            assert!((mean / share - 1.0).abs() < 0.01, "{degrees} {roughness}: {mean} {share}");
        }
    }

    #[test]
    fn all_light_is_reflected_by_microfacets_beyond_the_critical_angle() {
        let wo = towards(135.0);
        let beyond = glass(1e-3).sample(wo, Vec2::new(0.3, 0.6), 0.999).expect("a reflection");
        assert!(
            beyond.wi.z < 0.0
                && (beyond.wi - towards(135.0) * vec3(-1.0, 1.0, 1.0)).length() < 0.01
        );
    }

    #[test]
    fn extreme_directions_and_widths_give_finite_answers() {
        for roughness in [1e-3, 0.1, 1.0] {
            for wo in [Vec3::Z, towards(89.999), -Vec3::Z, vec3(1.0, 0.0, -1e-20), towards(91.0)] {
                for Scattering { wi, weight, pdf } in samples(&glass(roughness), wo).flatten() {
                    let (f, evaluated) = glass(roughness).evaluate(wo, wi);
                    assert!(f.is_finite() && weight.is_finite(), "{roughness} {wo} {wi}");
                    assert!(evaluated > 0.0 && pdf.is_finite(), "{roughness} {wo} {wi}");
                    assert!(weight.max_element() < 2.2501, "{roughness} {wo} {wi}: {weight}");
                }
            }
        }
    }
}
