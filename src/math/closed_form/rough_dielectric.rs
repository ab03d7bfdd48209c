//! The directional albedo and transmittance of a rough dielectric interface: GGX microfacets, each of
//! them smooth.
//!
//! Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007). Only
//! single scattering: light that hits two microfacets is lost.

use super::fresnel;
use super::microfacet::{Masking, masking_shadowing};
use crate::math::quadrature::integrate;
use std::f64::consts::PI;

/// Shares of the light that meets the interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shares {
    /// To the side where it came from.
    pub(crate) reflected: f64,
    /// To the other side; of radiance, before any scaling by the index squared.
    pub(crate) refracted: f64,
}

impl Shares {
    /// Of an interface of roughness `alpha`, seen at this cosine; `eta` is eta_t / eta_i.
    ///
    /// With microfacet normals distributed by D cos, a share is the mean of F G (o·m) / (cos θo cos θm),
    /// or of 1 − F in place of F, over the microfacets that send light to its side. For each θm they are
    /// intervals of φ, whose ends are known.
    pub(crate) fn of(cos_o: f64, eta: f64, alpha: f64, form: Masking) -> Self {
        let view = View { cos_o, sin_o: (1.0 - cos_o * cos_o).max(0.0).sqrt(), eta, alpha, form };
        let mean = |light: Light| {
            let over_microfacets =
                |v: f64| 2.0 * v * view.mean_over_phi(view.cos_microfacet(v), light);
            integrate(&[0.0, 0.25, 0.5, 0.75, 1.0], 1e-8, over_microfacets).value
        };
        Self { reflected: mean(View::reflected), refracted: mean(View::refracted) }
    }
}

/// Fraction of light by a microfacet: of the cosines of its normal with +z and with the view.
type Light = fn(&View, f64, f64) -> f64;

struct View {
    cos_o: f64,
    sin_o: f64,
    eta: f64,
    alpha: f64,
    form: Masking,
}

impl View {
    /// Of the microfacet that has the fraction 1 − v² of all microfacets above it, by D cos.
    fn cos_microfacet(&self, v: f64) -> f64 {
        v / (v * v + self.alpha * self.alpha * (1.0 - v * v)).sqrt()
    }

    fn mean_over_phi(&self, cos_m: f64, light: Light) -> f64 {
        let sin_m = (1.0 - cos_m * cos_m).max(0.0).sqrt();
        let (level, swing) = (self.cos_o * cos_m, self.sin_o * sin_m);
        let place = |cos_d: f64| ((cos_d - level) / swing).clamp(-1.0, 1.0).acos();
        let mut breaks = vec![0.0, PI];
        breaks.extend(self.edges(cos_m).into_iter().map(place).filter(|phi| !phi.is_nan()));
        breaks.sort_by(f64::total_cmp);
        let share = |phi: f64| light(self, cos_m, level + swing * phi.cos());
        integrate(&breaks, 1e-9, share).value / PI
    }

    /// Cosines between view and microfacet where a fraction begins, ends, or has no derivative.
    fn edges(&self, cos_m: f64) -> [f64; 4] {
        let never = f64::NAN;
        let lack = 1.0 - self.eta * self.eta;
        // Light comes out of the denser side above the horizon while d − √(d² − 1 + η²) < q.
        let q = self.cos_o / cos_m;
        let leaves = if lack > q * q { 0.5 * (q + lack / q) } else { never };
        [0.0, 0.5 * q, if lack > 0.0 { lack.sqrt() } else { never }, leaves]
    }

    fn reflected(&self, cos_m: f64, cos_d: f64) -> f64 {
        let cos_i = 2.0 * cos_d * cos_m - self.cos_o;
        let share = fresnel::reflectance(cos_d, self.eta);
        self.seen(cos_m, cos_d, cos_i, share)
    }

    fn refracted(&self, cos_m: f64, cos_d: f64) -> f64 {
        let sine_squared = (1.0 - cos_d * cos_d) / (self.eta * self.eta);
        let beyond = (1.0 - sine_squared).max(0.0).sqrt();
        let cos_i = self.cos_o / self.eta + (beyond - cos_d / self.eta) * cos_m;
        let share = 1.0 - fresnel::reflectance(cos_d, self.eta);
        self.seen(cos_m, cos_d, cos_i, share)
    }

    fn seen(&self, cos_m: f64, cos_d: f64, cos_i: f64, share: f64) -> f64 {
        if cos_d <= 0.0 || cos_i <= 0.0 || share <= 0.0 {
            return 0.0;
        }
        let masking = masking_shadowing(self.cos_o, cos_i, self.alpha, self.form);
        share * masking * cos_d / (self.cos_o * cos_m)
    }
}

#[cfg(test)]
mod tests {
    use super::super::microfacet;
    use super::super::witness::assert_close;
    use super::*;

    const GLASS: f64 = 1.5;

    /// Degrees from the normal, η, roughness; reflected and refracted by separable masking, then by
    /// height-correlated. Midpoint sums over 16 million incident directions of Walter's equations 20
    /// and 21, cut where the half vector of refraction turns over, in Python.
    const TABLE: [([f64; 3], [f64; 2], [f64; 2]); 7] = [
        ([0.0, GLASS, 0.3], [0.035_597, 0.952_793], [0.035_597, 0.952_793]),
        ([45.0, GLASS, 0.3], [0.043_648, 0.927_755], [0.043_715, 0.927_961]),
        ([75.0, GLASS, 0.6], [0.052_830, 0.683_856], [0.058_842, 0.753_965]),
        ([20.0, 1.0 / GLASS, 0.4], [0.097_546, 0.718_297], [0.097_651, 0.718_356]),
        ([60.0, 1.0 / GLASS, 0.4], [0.525_458, 0.178_835], [0.531_637, 0.182_664]),
        ([80.0, 1.0 / GLASS, 0.8], [0.368_637, 0.062_878], [0.438_017, 0.111_452]),
        ([0.0, GLASS, 1.0], [0.012_702, 0.880_638], [0.012_702, 0.880_638]),
    ];

    #[test]
    fn shares_are_those_of_the_table() {
        for ([degrees, eta, alpha], separable, correlated) in TABLE {
            let forms = [(Masking::Separable, separable), (Masking::HeightCorrelated, correlated)];
            for (form, [reflected, refracted]) in forms {
                let found = Shares::of(degrees.to_radians().cos(), eta, alpha, form);
                let errors = [found.reflected - reflected, found.refracted - refracted];
                assert!(errors.iter().all(|e| e.abs() < 2e-6), "{degrees} {alpha}: {found:?}");
            }
        }
    }

    #[test]
    fn nearly_smooth_glass_has_fresnels_shares() {
        for (degrees, eta) in [(0f64, GLASS), (60.0, GLASS), (30.0, GLASS.recip())] {
            let cosine = degrees.to_radians().cos();
            let shares = Shares::of(cosine, eta, 1e-3, Masking::Separable);
            assert_close(shares.reflected, fresnel::reflectance(cosine, eta), 1e-3);
            assert_close(shares.refracted, 1.0 - fresnel::reflectance(cosine, eta), 1e-3);
        }
    }

    #[test]
    fn microfacets_that_reflect_everything_are_metal() {
        // A ratio of indices near zero: total reflection at nearly every angle.
        for form in [Masking::Separable, Masking::HeightCorrelated] {
            let shares = Shares::of(0.7, 1e-4, 0.5, form);
            assert_close(shares.reflected, microfacet::albedo(0.7, 0.5, form), 1e-5);
        }
    }

    #[test]
    fn no_light_is_made() {
        for degrees in [0f64, 45.0, 80.0] {
            for eta in [GLASS, GLASS.recip()] {
                for form in [Masking::Separable, Masking::HeightCorrelated] {
                    let Shares { reflected, refracted } =
                        Shares::of(degrees.to_radians().cos(), eta, 0.6, form);
                    assert!(reflected > 0.0 && refracted > 0.0 && reflected + refracted < 1.0);
                }
            }
        }
    }
}
