//! A rough conductor: GGX microfacets that reflect the same at every angle.
//!
//! Written with the masking sums of `facets`, f = R D G₁ G₁ / (4 cos cos) and its pdf G₁ D / (4 cos) have no
//! cosines left.

use super::facets::Facets;
use super::scattering::Scattering;
use glam::{Vec2, Vec3};

/// A rough conductor seen from its upper side.
#[derive(Clone, Debug)]
pub(crate) struct Conductor {
    reflectance: Vec3,
    facets: Facets,
}

impl Conductor {
    /// `reflectance` of a single microfacet, and the width α of the distribution.
    pub(crate) const fn new(reflectance: Vec3, roughness: f32) -> Self {
        Self { reflectance, facets: Facets::new(roughness) }
    }

    /// `f` and pdf for two directions of the upper side.
    pub(crate) fn evaluate(&self, wo: Vec3, wi: Vec3) -> (Vec3, f32) {
        let distribution = self.facets.distribution((wo + wi).normalize());
        let (s_wo, s_wi) = (self.facets.masking_sum(wo), self.facets.masking_sum(wi));
        (self.reflectance * (distribution / (s_wo * s_wi)), distribution / (2.0 * s_wo))
    }

    /// A reflection on a microfacet that `wo` sees; `None` if it goes down into the surface.
    pub(crate) fn sample(&self, wo: Vec3, point: Vec2) -> Option<Scattering> {
        let facet = self.facets.visible_normal(wo, point);
        let wi = (2.0 * wo.dot(facet) * facet - wo).normalize();
        (wi.z > 0.0).then(|| {
            let weight = self.reflectance * (2.0 * wi.z / self.facets.masking_sum(wi));
            Scattering { wi, weight, pdf: self.evaluate(wo, wi).1 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;
    use std::f64::consts::PI;

    fn towards(degrees: f32) -> Vec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        vec3(sine, 0.0, cosine)
    }

    /// Midpoint rule over (cos θ, φ) of a function of the direction.
    fn integrate(function: impl Fn(Vec3) -> f64) -> f64 {
        let (rows, columns) = (1200_u16, 300_u16);
        let mut sum = 0.0;
        for row in 0..rows {
            // Squeezed towards the horizon and the pole, where a grazing lobe is narrow.
            let u = (f64::from(row) + 0.5) / f64::from(rows);
            let cosine = u * u * (3.0 - 2.0 * u);
            let width = 6.0 * u * (1.0 - u) / f64::from(rows);
            let sine = (1.0 - cosine * cosine).sqrt();
            for column in 0..columns {
                let angle = 2.0 * PI * (f64::from(column) + 0.5) / f64::from(columns);
                let wi =
                    vec3((sine * angle.cos()) as f32, (sine * angle.sin()) as f32, cosine as f32);
                sum += function(wi) * width;
            }
        }
        sum * 2.0 * PI / f64::from(columns)
    }

    // Directional albedo for reflectance 1 by Gauss quadrature in double precision, separable Smith.
    #[test]
    fn the_albedo_is_that_of_separable_smith() {
        for (roughness, degrees, albedo) in [
            (0.3, 0.0, 0.877357),
            (0.3, 45.0, 0.844432),
            (0.3, 75.0, 0.808411),
            (0.6, 45.0, 0.602149),
            (1.0, 0.0, 1.0 - 2_f64.ln()),
            (1.0, 75.0, 0.487525),
        ] {
            let conductor = Conductor::new(Vec3::ONE, roughness);
            let wo = towards(degrees);
            let measured =
                integrate(|wi| f64::from(conductor.evaluate(wo, wi).0.x) * f64::from(wi.z));
            assert!((measured - albedo).abs() < 2e-5, "{roughness} {degrees}: {measured}");
        }
    }

    #[test]
    fn the_density_has_the_mass_of_the_accepted_samples_and_the_weights_the_albedo() {
        for (roughness, degrees, albedo) in [(0.3, 75.0, 0.808411), (0.6, 45.0, 0.602149)] {
            let conductor = Conductor::new(Vec3::ONE, roughness);
            let wo = towards(degrees);
            let mass = integrate(|wi| f64::from(conductor.evaluate(wo, wi).1));
            let side = 600_u16;
            let (mut accepted, mut weight) = (0.0, 0.0);
            for row in 0..side {
                for column in 0..side {
                    let place = Vec2::new(f32::from(row) + 0.5, f32::from(column) + 0.5);
                    if let Some(sample) = conductor.sample(wo, place / f32::from(side)) {
                        accepted += 1.0;
                        weight += f64::from(sample.weight.x);
                        assert_eq!(sample.pdf, conductor.evaluate(wo, sample.wi).1);
                    }
                }
            }
            let samples = f64::from(side) * f64::from(side);
            assert!((accepted / samples - mass).abs() < 2e-4, "{} {mass}", accepted / samples);
            assert!((weight / samples - albedo).abs() < 2e-4, "{}", weight / samples);
        }
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
