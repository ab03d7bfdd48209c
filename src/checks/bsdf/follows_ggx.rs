//! f of a rough conductor against the microfacet formula, pair by pair: R · D(h) · G(wo, wi) / (4 cos θo cos θi).
//!
//! That the microfacets cover the surface once (∫ D cos = 1), that no more of them is seen than there is (G ≤ 1), and
//! which Smith term a core uses: all of it follows, and a wrong factor is named by where it is wrong.

use super::albedo;
use super::ggx_pair::{MISTAKES, Mistake, Pair};
use super::terms::{Scattering, Value};
use super::wrong_value::DIRECTIONS;
use crate::cause::Cause;
use crate::checks::phrase::{figure, percent, some_are};
use crate::checks::surface::{SurfaceEntry, evaluated};
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{BsdfQuery, BsdfValue, Conventions, SmithTerm};
use crate::math::sphere::on_hemisphere;
use crate::scene::Surface;
use crate::stats::{Compared, ExactReport, Tolerance, judge_exact};
use crate::text::Several;

/// Pairs of directions for each surface.
const PAIRS: usize = 10_000;
/// Nearer to the horizon, cosines of single precision have lost their digits.
const GRAZING: f64 = 1e-3;
/// A mistake may magnify rounding, but not a hundredfold.
const LIKENESS: f64 = 100.0;

check! {
    pub(crate) struct FollowsGgx {
        surface: Several<SurfaceEntry>,
    }
    name: "bsdf-follows-ggx",
    summary: "f of rough metal against the microfacet formula, pair by pair",
    needs: EVAL_BSDF,
}

impl Check for FollowsGgx {
    fn validate(&self) -> Result<(), String> {
        let other = self.surface.iter().find(|s| !matches!(s, SurfaceEntry::Conductor(_)));
        match other {
            Some(other) => Err(format!("{other} has no microfacets; give conductors")),
            None => Ok(()),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let smith = context.info.conventions.smith_term;
        let mut tried = Vec::new();
        for surface in self.surface.iter() {
            tried.extend(Tried::of(context, *surface, smith)?);
        }
        let tolerance = Tolerance::FORMULA.of(context.info.precision);
        let laws = tried.iter().filter_map(|one| one.law(context.info.conventions, tolerance));
        Ok(finding(&tried, tolerance).by_law(laws))
    }
}

/// One surface, and what the core made of it.
struct Tried {
    name: String,
    pairs: Vec<Pair>,
    values: Vec<BsdfValue>,
}

impl Tried {
    fn of(
        context: &mut Context<'_>,
        surface: SurfaceEntry,
        smith: SmithTerm,
    ) -> Result<Option<Self>> {
        let material = surface.material();
        let Surface::Conductor { reflectance, roughness } = material.surface else {
            return Ok(None);
        };
        let masking = albedo::masking(smith);
        let mut stream = context.seed.child(surface).stream();
        let mut next = || (on_hemisphere(&mut stream), on_hemisphere(&mut stream));
        let pairs: Vec<_> = (0..PAIRS)
            .map(|_| next())
            .filter(|(wo, wi)| wo.z > GRAZING && wi.z > GRAZING)
            .map(|(wo, wi)| Pair { wo, wi, reflectance, roughness, masking })
            .collect();
        let queries: Vec<_> =
            pairs.iter().map(|Pair { wo, wi, .. }| BsdfQuery { wo: *wo, wi: *wi }).collect();
        let values = evaluated(context.core, &material, &queries)?;
        Ok(Some(Self { name: surface.to_string(), pairs, values }))
    }

    /// Every channel of every pair against a share of what is right.
    fn report(&self, share: Mistake, tolerance: f64) -> ExactReport {
        let pairs = self.pairs.iter().zip(&self.values);
        judge_exact(pairs.flat_map(|(pair, value)| {
            let right = share(pair) * pair.right();
            (0..3).map(move |c| {
                Compared::relative(value.f[c], pair.reflectance[c] * right, tolerance)
            })
        }))
    }

    fn measure(&self, tolerance: f64) -> Measure {
        Measure::worst("f", &self.report(|_| 1.0, tolerance)).of_row(&self.name)
    }

    /// Of the first pairs: what all obey they obey.
    fn law(&self, conventions: Conventions, tolerance: f64) -> Option<String> {
        let Pair { reflectance, roughness, .. } = *self.pairs.first()?;
        let surface = Surface::Conductor { reflectance, roughness };
        let value = |(pair, value): (&Pair, &BsdfValue)| {
            let query = BsdfQuery { wo: pair.wo, wi: pair.wi };
            let right = reflectance.map(|r| r * pair.right());
            Value { query, found: value.f, right }
        };
        let values: Vec<_> =
            self.pairs.iter().zip(&self.values).take(DIRECTIONS).map(value).collect();
        let scattering = Scattering { surface, conventions };
        let law = scattering.law_of_values(&values, tolerance)?;
        Some(format!("f of {} {law}", scattering.kind()))
    }

    fn complaint(&self, tolerance: f64) -> Option<String> {
        let report = self.report(|_| 1.0, tolerance);
        let worst = report.worst.filter(|_| report.disagree > 0)?.compared;
        let some = some_are(report.disagree, report.compared, "values");
        let ratio = figure(worst.found / worst.expected);
        Some(format!("{}: {some} not D G / (4 cos cos), the worst {ratio} of it", self.name))
    }
}

fn finding(tried: &[Tried], tolerance: f64) -> Finding {
    let measures = tried.iter().map(|one| one.measure(tolerance)).collect();
    let pairs: usize = tried.iter().map(|one| one.pairs.len()).sum();
    let right = format!("f is D G / (4 cos cos) at {pairs} pairs of directions");
    let resolution = format!("would have caught an error of {} at one pair", percent(tolerance));
    let finding = Finding::of(right, resolution, measures)
        .complaining(tried.iter().filter_map(|one| one.complaint(tolerance)));
    if !finding.failed() {
        return finding;
    }
    let explains = |(_, mistake): &&(&Cause, Mistake)| {
        tried.iter().all(|one| one.report(*mistake, LIKENESS * tolerance).disagree == 0)
    };
    let made = MISTAKES.iter().filter(explains).map(|(cause, _)| *cause);
    finding.because_each(made, &format!("predicts f at {pairs} pairs of directions"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::scene::Material;

    const CASE: &str = include_str!("../../../cases/bsdf/rough-conductor-matches-ggx.toml");

    /// The formula times the share of a mistake.
    fn rough(mistake: Mistake, smith_term: SmithTerm) -> Fake {
        let masking = albedo::masking(smith_term);
        let value = move |material: &Material, query: &BsdfQuery| {
            let Surface::Conductor { reflectance, roughness } = material.surface else {
                panic!("no conductor")
            };
            let BsdfQuery { wo, wi } = *query;
            let pair = Pair { wo, wi, reflectance, roughness, masking };
            let f = mistake(&pair) * pair.right();
            BsdfValue { f: reflectance.map(|r| r * f), pdf: 1.0 }
        };
        let mut core = Fake { value: Box::new(value), ..Fake::default() };
        core.info.conventions.smith_term = smith_term;
        core
    }

    fn found(mistake: Mistake) -> Finding {
        let mut core = rough(mistake, SmithTerm::Separable);
        judge(&check_of::<FollowsGgx>(CASE), &mut core)
    }

    #[test]
    fn the_formula_passes_with_the_term_that_is_declared() {
        for smith_term in [SmithTerm::Separable, SmithTerm::HeightCorrelated] {
            let mut core = rough(|_| 1.0, smith_term);
            assert_passes(&judge(&check_of::<FollowsGgx>(CASE), &mut core));
        }
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        for (cause, mistake) in MISTAKES {
            let finding = found(*mistake);
            failure(&finding);
            assert_eq!(finding.clues.len(), 1, "{} {:?}", cause.name, finding.clues);
            assert_eq!(finding.clues[0].cause, cause.name);
        }
    }

    #[test]
    fn a_part_in_a_hundred_thousand_is_seen() {
        assert!(failure(&found(|_| 1.00001)).contains("1 of it"));
    }
}
