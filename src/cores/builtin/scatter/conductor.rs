//! A rough conductor: GGX microfacets with separable Smith masking, and facets that reflect the same at every
//! angle. Sampled by the visible normals (Heitz 2018, "Sampling the GGX distribution of visible normals").
//!
//! With s(w) = cos θ + √(cos² θ + α² sin² θ), Smith's masking is G₁(w) = 2 cos θ / s(w). Written with s, the
//! cosines of f = R D G₁ G₁ / (4 cos cos) and of the density G₁ D / (4 cos) cancel, also at grazing angles.

use super::bsdf::Scattering;
use super::warp::sin_cos_of_turns;
use glam::{Vec2, Vec3, vec3};
use std::f32::consts::FRAC_1_PI;

/// A rough conductor seen from its upper side.
#[derive(Clone, Debug)]
pub struct Conductor {
    reflectance: Vec3,
    roughness: f32,
}

impl Conductor {
    /// `reflectance` of a single facet, and the width α of the distribution.
    pub const fn new(reflectance: Vec3, roughness: f32) -> Self {
        Self { reflectance, roughness }
    }

    /// `f` and density for two directions of the upper side.
    pub fn evaluate(&self, wo: Vec3, wi: Vec3) -> (Vec3, f32) {
        let distribution = self.distribution((wo + wi).normalize());
        let (s_wo, s_wi) = (self.masking_sum(wo), self.masking_sum(wi));
        (self.reflectance * (distribution / (s_wo * s_wi)), distribution / (2.0 * s_wo))
    }

    /// A reflection on a facet that `wo` sees; `None` if it goes down into the surface.
    pub fn sample(&self, wo: Vec3, point: Vec2) -> Option<Scattering> {
        let facet = self.visible_normal(wo, point);
        let wi = (2.0 * wo.dot(facet) * facet - wo).normalize();
        (wi.z > 0.0).then(|| {
            let weight = self.reflectance * (2.0 * wi.z / self.masking_sum(wi));
            Scattering { wi, weight, pdf: self.evaluate(wo, wi).1 }
        })
    }

    /// D(h) = α² / (π (sin² θ + α² cos² θ)²), from the components, which near the normal are more exact than
    /// the cosine.
    fn distribution(&self, half: Vec3) -> f32 {
        let alpha = self.roughness;
        let sine_square = half.x * half.x + half.y * half.y;
        let ratio = alpha / (sine_square + alpha * alpha * half.z * half.z);
        ratio * ratio * FRAC_1_PI
    }

    /// s(w).
    fn masking_sum(&self, w: Vec3) -> f32 {
        let alpha = self.roughness;
        w.z + (w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y)).sqrt()
    }

    /// Heitz 2018, listing 1: the hemisphere stretched to roughness 1, its projection sampled, and back.
    fn visible_normal(&self, wo: Vec3, point: Vec2) -> Vec3 {
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

#[cfg(test)]
mod tests {
    use super::*;
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
