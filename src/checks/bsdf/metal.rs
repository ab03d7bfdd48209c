//! Rough metal, right and wrong: f = R D(h) G / (4 cos θo cos θi), and what it becomes by the usual mistakes.

use crate::cause::{Cause, bsdf, convention};
use crate::contract::{BsdfQuery, BsdfValue, SmithTerm};
use crate::math::closed_form::microfacet::{Masking, distribution, masking, masking_shadowing};
use glam::DVec3;

/// Two values this close, relative, are the same; the wrong ones are far apart nearly everywhere.
const SAME: f64 = 1e-3;

/// What f and densities of rough metal are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facets {
    alpha: f64,
    cos_o: f64,
    cos_i: f64,
    /// Of the half vector with the normal.
    cos_h: f64,
    /// Of the half vector with `wo`.
    cos_d: f64,
}

type Formula = fn(&Facets) -> f64;

impl Facets {
    /// For a pair of directions above the horizon.
    pub(crate) fn of(alpha: f64, wo: DVec3, wi: DVec3) -> Self {
        let half = (wo + wi).normalize();
        Self { alpha, cos_o: wo.z, cos_i: wi.z, cos_h: half.z, cos_d: wo.dot(half) }
    }

    fn distribution(&self) -> f64 {
        distribution(self.cos_h, self.alpha)
    }

    fn value(&self, form: Masking) -> f64 {
        let masking = masking_shadowing(self.cos_o, self.cos_i, self.alpha, form);
        self.distribution() * masking / (4.0 * self.cos_o * self.cos_i)
    }

    /// Of facets that `wo` sees.
    fn visible(&self) -> f64 {
        self.distribution() * masking(self.cos_o, self.alpha) * self.cos_d / self.cos_o
    }
}

const fn masking_of(smith: SmithTerm) -> (Formula, Formula) {
    let separable: Formula = |facets| facets.value(Masking::Separable);
    let correlated: Formula = |facets| facets.value(Masking::HeightCorrelated);
    match smith {
        SmithTerm::Separable => (separable, correlated),
        SmithTerm::HeightCorrelated => (correlated, separable),
    }
}

/// The mistake that makes every value of the green channel of a conductor with this reflectance there.
pub(crate) fn mistake_of_value(
    (reflectance, alpha): (f64, f64),
    smith: SmithTerm,
    queries: &[BsdfQuery],
    values: &[BsdfValue],
) -> Option<&'static Cause> {
    let (right, other_smith) = masking_of(smith);
    let without_masking: Formula = |f| f.distribution() / (4.0 * f.cos_o * f.cos_i);
    let predicts = |alpha: f64, factor: f64, formula: Formula| {
        queries.iter().zip(values).all(|(query, value)| {
            let expected = factor * reflectance * formula(&Facets::of(alpha, query.wo, query.wi));
            (value.f[1] / expected - 1.0).abs() <= SAME
        })
    };
    let made: [(bool, &Cause); 4] = [
        (predicts(alpha * alpha, 1.0, right), &bsdf::ROUGHNESS_SQUARED),
        (predicts(alpha, 1.0, without_masking), &bsdf::MASKING_FORGOTTEN),
        (predicts(alpha, 4.0, right), &bsdf::FOUR_FORGOTTEN),
        (predicts(alpha, 1.0, other_smith), &convention::OTHER_SMITH_TERM),
    ];
    made.into_iter().find(|(is_made, _)| *is_made).map(|(_, cause)| cause)
}

/// The mistake that makes every one of these densities of a conductor. Two ways to sample are right.
pub(crate) fn mistake_of_density(facets: &[(Facets, f64)]) -> Option<&'static Cause> {
    let of_facets: [Formula; 2] = [Facets::visible, |f| f.distribution() * f.cos_h];
    let predicts = |formula: &Formula| {
        let same = |(f, pdf): &(Facets, f64)| (pdf / formula(f) - 1.0).abs() <= SAME;
        !facets.is_empty() && facets.iter().all(same)
    };
    of_facets.iter().any(predicts).then_some(&bsdf::PDF_OF_HALF_VECTOR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;
    use crate::math::sphere::on_hemisphere;

    fn queries() -> Vec<BsdfQuery> {
        let mut stream = Seed(1).stream();
        let mut direction = || on_hemisphere(&mut stream);
        (0..50).map(|_| BsdfQuery { wo: direction(), wi: direction() }).collect()
    }

    fn told(formula: impl Fn(&Facets) -> f64, alpha: f64) -> Option<&'static Cause> {
        let value = |q: &BsdfQuery| {
            let f = 0.9 * formula(&Facets::of(alpha, q.wo, q.wi));
            BsdfValue { f: [f; 3], pdf: 0.0 }
        };
        let values: Vec<_> = queries().iter().map(value).collect();
        mistake_of_value((0.9, 0.3), SmithTerm::Separable, &queries(), &values)
    }

    #[test]
    fn every_mistake_of_f_is_told() {
        let right = |f: &Facets| f.value(Masking::Separable);
        assert_eq!(told(right, 0.3), None);
        assert_eq!(told(right, 0.09), Some(&bsdf::ROUGHNESS_SQUARED));
        assert_eq!(told(|f| 4.0 * right(f), 0.3), Some(&bsdf::FOUR_FORGOTTEN));
        let bare = |f: &Facets| f.distribution() / (4.0 * f.cos_o * f.cos_i);
        assert_eq!(told(bare, 0.3), Some(&bsdf::MASKING_FORGOTTEN));
        let correlated = |f: &Facets| f.value(Masking::HeightCorrelated);
        assert_eq!(told(correlated, 0.3), Some(&convention::OTHER_SMITH_TERM));
    }

    #[test]
    fn a_density_of_facets_is_told_from_one_of_directions() {
        let of = |density: fn(&Facets) -> f64| -> Option<&'static Cause> {
            let facets = queries().into_iter().map(|q| Facets::of(0.3, q.wo, q.wi));
            mistake_of_density(&facets.map(|f| (f, density(&f))).collect::<Vec<_>>())
        };
        assert_eq!(of(Facets::visible), Some(&bsdf::PDF_OF_HALF_VECTOR));
        assert_eq!(of(|f| f.visible() / (4.0 * f.cos_d)), None);
    }
}
