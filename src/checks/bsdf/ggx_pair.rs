//! A rough conductor at one pair of directions, right and wrong.

use crate::cause::{Cause, bsdf as cause, convention};
use crate::math::closed_form::microfacet::{Masking, distribution, masking, masking_shadowing};
use crate::scene::Rgb;
use glam::DVec3;
use std::f64::consts::PI;

/// Two values this close, relative, are the same; the wrong ones are far apart nearly everywhere.
const SAME: f64 = 1e-3;

/// A conductor at one pair of directions above the horizon.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    pub(crate) wo: DVec3,
    pub(crate) wi: DVec3,
    pub(crate) reflectance: Rgb,
    pub(crate) roughness: f64,
    pub(crate) masking: Masking,
}

impl Pair {
    pub(crate) fn half(&self) -> DVec3 {
        (self.wo + self.wi).normalize()
    }

    fn both_masked(&self) -> f64 {
        self.masked_by(self.masking)
    }

    fn masked_by(&self, form: Masking) -> f64 {
        masking_shadowing(self.wo.z, self.wi.z, self.roughness, form)
    }

    fn distribution(&self) -> f64 {
        distribution(self.half().z, self.roughness)
    }

    /// D G / (4 cos cos): f for a reflectance of 1.
    pub(crate) fn right(&self) -> f64 {
        self.distribution() * self.both_masked() / (4.0 * self.wo.z * self.wi.z)
    }

    /// What f is made of ([`super::terms`]).
    pub(super) fn factors(&self) -> Vec<f64> {
        vec![
            self.wo.z,
            self.wi.z,
            self.half().z,
            self.wo.dot(self.half()),
            self.distribution(),
            self.both_masked(),
            masking(self.wo.z, self.roughness),
            masking(self.wi.z, self.roughness),
            self.roughness,
        ]
    }

    /// The pdf of visible normals: of the microfacets that `wo` sees.
    fn visible(&self) -> f64 {
        let seen = masking(self.wo.z, self.roughness) * self.wo.dot(self.half());
        self.distribution() * seen / self.wo.z
    }
}

/// f as a share of what is right, under a mistake.
pub(crate) type Mistake = fn(&Pair) -> f64;

pub(crate) const MISTAKES: &[(&Cause, Mistake)] = &[
    (&cause::MASKING_FORGOTTEN, |pair| pair.both_masked().recip()),
    (&cause::MASKING_ONE_SIDED, |pair| masking(pair.wo.z, pair.roughness) / pair.both_masked()),
    (&convention::OTHER_SMITH_TERM, |pair| {
        let other = match pair.masking {
            Masking::Separable => Masking::HeightCorrelated,
            Masking::HeightCorrelated => Masking::Separable,
        };
        pair.masked_by(other) / pair.both_masked()
    }),
    (&cause::FOUR_FORGOTTEN, |_| 4.0),
    (&cause::ROUGHNESS_SQUARED, |pair| {
        Pair { roughness: pair.roughness.powi(2), ..*pair }.right() / pair.right()
    }),
    (&cause::MASKING_OF_ALPHA, |pair| {
        Pair { roughness: pair.roughness.sqrt(), ..*pair }.both_masked() / pair.both_masked()
    }),
    (&cause::D_WITHOUT_PI, |_| PI),
    (&cause::D_NOT_SQUARED, |pair| pair.roughness / (PI * pair.distribution()).sqrt()),
    (&cause::BECKMANN_FOR_GGX, |pair| {
        beckmann(pair.half().z, pair.roughness) / pair.distribution()
    }),
    (&cause::HALF_NOT_NORMALISED, |pair| {
        distribution((pair.wo + pair.wi).z, pair.roughness) / pair.distribution()
    }),
    (&cause::COSINE_IN_F, |pair| pair.wi.z),
];

/// The normal distribution function of Beckmann and Spizzichino (1963).
fn beckmann(cosine: f64, alpha: f64) -> f64 {
    let squared = cosine * cosine;
    let tangent = (1.0 - squared) / squared;
    (-tangent / (alpha * alpha)).exp() / (PI * alpha * alpha * squared * squared)
}

/// Those that a few values are enough to tell.
const PLAIN: [&Cause; 4] = [
    &cause::ROUGHNESS_SQUARED,
    &cause::MASKING_FORGOTTEN,
    &cause::FOUR_FORGOTTEN,
    &convention::OTHER_SMITH_TERM,
];

/// The plain mistake that makes the green channel of every value.
pub(crate) fn mistake_of_value(values: &[(Pair, f64)]) -> Option<&'static Cause> {
    let predicts = |mistake: Mistake| {
        values.iter().all(|(pair, f)| {
            let expected = pair.reflectance[1] * mistake(pair) * pair.right();
            (f / expected - 1.0).abs() <= SAME
        })
    };
    let is_made = |plain: &&Cause| MISTAKES.iter().any(|(cause, m)| cause == plain && predicts(*m));
    PLAIN.into_iter().find(is_made)
}

/// The mistake that makes every one of these pdfs. Two ways to sample are right.
pub(crate) fn mistake_of_pdf(pdfs: &[(Pair, f64)]) -> Option<&'static Cause> {
    let of_normals: [fn(&Pair) -> f64; 2] = [Pair::visible, |p| p.distribution() * p.half().z];
    let predicts = |formula: &fn(&Pair) -> f64| {
        let same = |(pair, pdf): &(Pair, f64)| (pdf / formula(pair) - 1.0).abs() <= SAME;
        !pdfs.is_empty() && pdfs.iter().all(same)
    };
    of_normals.iter().any(predicts).then_some(&cause::PDF_OF_HALF_VECTOR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;
    use crate::math::sphere::on_hemisphere;

    fn with(formula: impl Fn(&Pair) -> f64) -> Vec<(Pair, f64)> {
        let mut stream = Seed(1).stream();
        let mut above = || on_hemisphere(&mut stream);
        let (reflectance, roughness, masking) = ([0.9; 3], 0.3, Masking::Separable);
        let mut pair = || Pair { wo: above(), wi: above(), reflectance, roughness, masking };
        (0..50).map(|_| pair()).map(|pair| (pair, formula(&pair))).collect()
    }

    #[test]
    fn the_plain_mistakes_of_f_are_told() {
        let told = |mistake: Mistake| mistake_of_value(&with(|p| 0.9 * mistake(p) * p.right()));
        assert_eq!(told(|_| 1.0), None);
        for (cause, mistake) in MISTAKES {
            assert_eq!(told(*mistake), PLAIN.contains(cause).then_some(*cause));
        }
    }

    #[test]
    fn a_pdf_of_normals_is_told_from_one_of_directions() {
        let told = mistake_of_pdf(&with(Pair::visible));
        assert_eq!(told, Some(&cause::PDF_OF_HALF_VECTOR));
        let of_directions = with(|p| p.visible() / (4.0 * p.wo.dot(p.half())));
        assert_eq!(mistake_of_pdf(&of_directions), None);
    }
}
