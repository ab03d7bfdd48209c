//! Rough glass (BRDF and BTDF), right and wrong: f and pdf by Walter's formulas (2007), and what they become by the
//! usual mistakes.

use super::albedo::masking as declared;
use crate::cause::{Cause, bsdf, convention};
use crate::contract::{BsdfQuery, Conventions, GlassRadiance};
use crate::math::closed_form::fresnel;
use crate::math::closed_form::microfacet::{Masking, distribution, masking, masking_shadowing};
use glam::DVec3;

/// Two values this close, relative, are the same; the wrong ones are far apart nearly everywhere.
const SAME: f64 = 1e-3;

/// Rough glass, and the conventions it is worked out by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoughGlass {
    /// Inside; outside is vacuum.
    pub(crate) index: f64,
    /// The width parameter α.
    pub(crate) roughness: f64,
    /// What the core declares.
    pub(crate) conventions: Conventions,
}

/// A pair of directions, and the microfacet that takes light from one to the other. All cosines are positive where it
/// does.
#[derive(Clone, Copy, Debug)]
struct Microfacet {
    glass: RoughGlass,
    passes: bool,
    /// Index on the side of `wi`, if light passes, or else beyond, over that on the side of `wo`.
    ratio: f64,
    /// Of `wo` and `wi` with the surface, and of the microfacet's normal.
    cos_o: f64,
    cos_i: f64,
    cos_m: f64,
    /// Of `wo` and `wi` with the microfacet.
    o_m: f64,
    i_m: f64,
}

impl Microfacet {
    fn of(glass: RoughGlass, query: &BsdfQuery, index_of_half: Index) -> Self {
        let BsdfQuery { wo, wi } = *query;
        let passes = wo.z * wi.z < 0.0;
        let ratio = if wo.z > 0.0 { glass.index } else { glass.index.recip() };
        let half = if passes { -(wo + index_of_half(glass, ratio) * wi) } else { wo + wi };
        let outward = half.normalize() * 1f64.copysign(half.z);
        let towards = |w: DVec3| w.dot(outward) * 1f64.copysign(w.z);
        Self {
            glass,
            passes,
            ratio,
            cos_o: wo.z.abs(),
            cos_i: wi.z.abs(),
            cos_m: outward.z,
            o_m: towards(wo),
            i_m: towards(wi),
        }
    }

    fn is_possible(&self) -> bool {
        self.o_m > 0.0 && self.i_m > 0.0
    }

    /// Of light that meets a surface at this cosine, the share that goes the way of the pair.
    fn probability(&self, cosine: f64) -> f64 {
        let reflected = fresnel::reflectance(cosine, self.ratio);
        if self.passes { 1.0 - reflected } else { reflected }
    }

    fn masking(&self, form: Masking) -> f64 {
        masking_shadowing(self.cos_o, self.cos_i, self.glass.roughness, form)
    }

    fn denominator(&self) -> f64 {
        (self.o_m - self.ratio * self.i_m).powi(2)
    }

    /// Directions per microfacet: ∂m/∂wi.
    fn jacobian(&self) -> f64 {
        match self.passes {
            true => self.ratio * self.ratio * self.i_m / self.denominator(),
            false => 1.0 / (4.0 * self.o_m),
        }
    }

    /// f of white glass.
    fn value(&self) -> f64 {
        if !self.is_possible() {
            return 0.0;
        }
        let form = declared(self.glass.conventions.smith_term);
        let microfacets = distribution(self.cos_m, self.glass.roughness) * self.masking(form)
            / (self.cos_o * self.cos_i);
        let scale = match self.glass.conventions.glass_radiance {
            GlassRadiance::Unscaled if self.passes => self.ratio * self.ratio,
            _ => 1.0,
        };
        let turned = match self.passes {
            true => self.o_m * self.i_m / self.denominator(),
            false => 0.25,
        };
        self.probability(self.o_m) * microfacets * turned * scale
    }

    /// Of samples that are drawn by the microfacets seen and by Fresnel's share.
    fn pdf(&self) -> f64 {
        if !self.is_possible() {
            return 0.0;
        }
        let roughness = self.glass.roughness;
        let seen = distribution(self.cos_m, roughness) * masking(self.cos_o, roughness) * self.o_m
            / self.cos_o;
        self.probability(self.o_m) * seen * self.jacobian()
    }
}

/// What multiplies a formula under a mistake.
type Factor = fn(&Microfacet) -> f64;
/// What the half vector of refraction is made with: of the glass, and of η.
type Index = fn(RoughGlass, f64) -> f64;

const RIGHT: Factor = |_| 1.0;
const RIGHT_INDEX: Index = |_, ratio| ratio;
/// The index of the glass, whichever way light goes.
const OF_ENTERING: Index = |glass, _| glass.index;

const VALUES: &[(&Cause, Factor)] = &[
    (&bsdf::FRESNEL_OF_SURFACE, |f| f.probability(f.cos_o) / f.probability(f.o_m)),
    (&bsdf::MASKING_FORGOTTEN, |f| f.masking(declared(f.glass.conventions.smith_term)).recip()),
    (&convention::OTHER_SMITH_TERM, |f| {
        let declared = declared(f.glass.conventions.smith_term);
        let other = match declared {
            Masking::Separable => Masking::HeightCorrelated,
            Masking::HeightCorrelated => Masking::Separable,
        };
        f.masking(other) / f.masking(declared)
    }),
    (&convention::UNSCALED_RADIANCE, |f| {
        let is_declared = f.glass.conventions.glass_radiance == GlassRadiance::Scaled;
        if f.passes && is_declared { f.ratio * f.ratio } else { 1.0 }
    }),
];

const PDFS: &[(&Cause, Factor)] = &[
    (&bsdf::REFRACTION_JACOBIAN_WITHOUT_INDEX, |f| {
        if f.passes { (f.ratio * f.ratio).recip() } else { 1.0 }
    }),
    (&bsdf::LOBE_PROBABILITY_FORGOTTEN, |f| f.probability(f.o_m).recip()),
];

impl RoughGlass {
    /// The mistake that makes every f, of white glass, at these pairs of directions.
    pub(crate) fn mistake_of_value(self, pairs: &[(BsdfQuery, f64)]) -> Option<&'static Cause> {
        self.mistake(pairs, Microfacet::value, VALUES)
    }

    /// The mistake that makes every pdf. Samples may be drawn by other laws that are as right.
    pub(crate) fn mistake_of_pdf(self, pairs: &[(BsdfQuery, f64)]) -> Option<&'static Cause> {
        self.mistake(pairs, Microfacet::pdf, PDFS)
    }

    /// f of white glass and what it is made of at this pair of directions ([`super::terms`]); none where no microfacet
    /// takes light from one to the other.
    pub(super) fn factors(self, query: &BsdfQuery) -> Option<(f64, Vec<f64>, bool)> {
        let facet = Microfacet::of(self, query, RIGHT_INDEX);
        let fresnel = fresnel::reflectance(facet.o_m, facet.ratio);
        let form = declared(self.conventions.smith_term);
        let factors = vec![
            facet.cos_o,
            facet.cos_i,
            facet.cos_m,
            facet.o_m,
            facet.i_m,
            distribution(facet.cos_m, self.roughness),
            facet.masking(form),
            masking(facet.cos_o, self.roughness),
            masking(facet.cos_i, self.roughness),
            fresnel,
            1.0 - fresnel,
            facet.ratio,
            facet.denominator(),
            self.roughness,
            self.index,
        ];
        facet.is_possible().then(|| (facet.value(), factors, facet.passes))
    }

    fn mistake(
        self,
        pairs: &[(BsdfQuery, f64)],
        formula: Factor,
        mistakes: &[(&'static Cause, Factor)],
    ) -> Option<&'static Cause> {
        let predicts = |index: Index, factor: Factor| {
            pairs.iter().all(|(query, found)| {
                let expected = self.expected(query, formula, index, factor);
                (found - expected).abs() <= SAME * expected
            })
        };
        if predicts(RIGHT_INDEX, RIGHT) {
            return None;
        }
        if predicts(OF_ENTERING, RIGHT) {
            return Some(&bsdf::HALF_WITH_INDEX_OF_ENTERING);
        }
        let made = mistakes.iter().find(|(_, factor)| predicts(RIGHT_INDEX, *factor));
        made.map(|(cause, _)| *cause)
    }

    fn expected(self, query: &BsdfQuery, formula: Factor, index: Index, factor: Factor) -> f64 {
        let microfacet = Microfacet::of(self, query, index);
        match formula(&microfacet) {
            0.0 => 0.0,
            right => right * factor(&microfacet),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;
    use crate::math::sphere::on_sphere;

    const GLASS: RoughGlass = RoughGlass {
        index: 1.5,
        roughness: 0.4,
        conventions: Conventions {
            point_light_falloff: crate::contract::Falloff::InverseSquare,
            emission: crate::contract::EmissionSides::Front,
            smith_term: crate::contract::SmithTerm::Separable,
            glass_fresnel: crate::contract::GlassFresnel::Exact,
            glass_radiance: GlassRadiance::Scaled,
        },
    };

    fn with(formula: Factor, index: Index, factor: Factor) -> Vec<(BsdfQuery, f64)> {
        let mut stream = Seed(1).stream();
        let mut direction = || on_sphere(&mut stream);
        let queries = (0..200).map(|_| BsdfQuery { wo: direction(), wi: direction() });
        queries.map(|query| (query, GLASS.expected(&query, formula, index, factor))).collect()
    }

    #[test]
    fn what_is_right_is_no_mistake() {
        let value = |factor| with(Microfacet::value, RIGHT_INDEX, factor);
        assert_eq!(GLASS.mistake_of_value(&value(RIGHT)), None);
        assert_eq!(GLASS.mistake_of_value(&value(|_| 1.01)), None);
        let pdf = with(Microfacet::pdf, RIGHT_INDEX, RIGHT);
        assert_eq!(GLASS.mistake_of_pdf(&pdf), None);
    }

    #[test]
    fn every_mistake_is_told() {
        for (cause, factor) in VALUES {
            let found = with(Microfacet::value, RIGHT_INDEX, *factor);
            assert_eq!(GLASS.mistake_of_value(&found), Some(*cause));
        }
        for (cause, factor) in PDFS {
            let found = with(Microfacet::pdf, RIGHT_INDEX, *factor);
            assert_eq!(GLASS.mistake_of_pdf(&found), Some(*cause));
        }
        let half = Some(&bsdf::HALF_WITH_INDEX_OF_ENTERING);
        assert_eq!(GLASS.mistake_of_value(&with(Microfacet::value, OF_ENTERING, RIGHT)), half);
        assert_eq!(GLASS.mistake_of_pdf(&with(Microfacet::pdf, OF_ENTERING, RIGHT)), half);
    }

    #[test]
    fn wi_and_wo_may_be_exchanged_over_the_index_squared() {
        for (query, f) in with(Microfacet::value, RIGHT_INDEX, RIGHT) {
            let BsdfQuery { wo, wi } = query;
            let back = Microfacet::of(GLASS, &BsdfQuery { wo: wi, wi: wo }, RIGHT_INDEX).value();
            let index = |w: DVec3| if w.z < 0.0 && wo.z * wi.z < 0.0 { 2.25 } else { 1.0 };
            let (there, back) = (f / index(wo), back / index(wi));
            assert!((there - back).abs() <= 1e-9 * there, "{wo} {wi}: {there} {back}");
        }
    }
}
