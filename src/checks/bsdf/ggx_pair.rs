//! A rough conductor at one pair of directions, right and wrong.

use crate::cause::{Cause, bsdf as cause, convention};
use crate::math::closed_form::microfacet::{Masking, distribution, masking, masking_shadowing};
use crate::scene::Rgb;
use glam::DVec3;
use std::f64::consts::PI;

/// A conductor at one pair of directions.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub(super) wo: DVec3,
    pub(super) wi: DVec3,
    pub(super) reflectance: Rgb,
    pub(super) roughness: f64,
    pub(super) masking: Masking,
}

impl Pair {
    pub(super) fn half(&self) -> DVec3 {
        (self.wo + self.wi).normalize()
    }

    fn both_masked(&self) -> f64 {
        self.masked_by(self.masking)
    }

    fn masked_by(&self, form: Masking) -> f64 {
        masking_shadowing(self.wo.z, self.wi.z, self.roughness, form)
    }

    /// D G / (4 cos cos): f for a reflectance of 1.
    pub(super) fn right(&self) -> f64 {
        let facets = distribution(self.half().z, self.roughness);
        facets * self.both_masked() / (4.0 * self.wo.z * self.wi.z)
    }
}

/// f as a share of what is right, under a mistake.
pub(super) type Mistake = fn(&Pair) -> f64;

pub(super) const MISTAKES: &[(&Cause, Mistake)] = &[
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
    (&cause::D_WITHOUT_PI, |_| PI),
    (&cause::BECKMANN_FOR_GGX, |pair| {
        beckmann(pair.half().z, pair.roughness) / distribution(pair.half().z, pair.roughness)
    }),
    (&cause::HALF_NOT_NORMALISED, |pair| {
        let [half, whole] = [pair.half().z, (pair.wo + pair.wi).z];
        distribution(whole, pair.roughness) / distribution(half, pair.roughness)
    }),
    (&cause::COSINE_IN_F, |pair| pair.wi.z),
];

/// The density of facets of Beckmann and Spizzichino (1963).
fn beckmann(cosine: f64, alpha: f64) -> f64 {
    let squared = cosine * cosine;
    let tangent = (1.0 - squared) / squared;
    (-tangent / (alpha * alpha)).exp() / (PI * alpha * alpha * squared * squared)
}
