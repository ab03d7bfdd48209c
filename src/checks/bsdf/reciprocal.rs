//! Helmholtz reciprocity: f(a, b) = f(b, a); across an interface, of f over the index squared. Pdfs need not be.

use crate::checks::phrase::some_are;
use crate::checks::surface::{SurfaceEntry, evaluated};
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, check};
use crate::contract::{BsdfQuery, BsdfValue, Capabilities, GlassRadiance};
use crate::scene::Rgb;
use crate::stats::{Compared, Tolerance, judge_exact};
use crate::text::Several;

/// Pairs of directions for each surface.
const PAIRS: usize = 10_000;
/// By how many roundings the squared sine beyond a microfacet may be off.
const ROUNDINGS: f64 = 16.0;

check! {
    pub(crate) struct Reciprocal {
        surface: Several<SurfaceEntry>,
    }
    name: "bsdf-reciprocal",
    summary: "f(a, b) = f(b, a), over the index squared",
    needs: EVAL_BSDF,
}

impl Check for Reciprocal {
    fn needs_besides(&self) -> Capabilities {
        SurfaceEntry::all_need(&self.surface)
    }

    fn validate(&self) -> Result<(), String> {
        SurfaceEntry::refuse_delta(&self.surface, "is zero wherever it is evaluated")
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let allowed = Tolerance::FORMULA.of(context.info.precision);
        let mut measures = Vec::new();
        let mut complaints = Vec::new();
        for surface in self.surface.iter() {
            let (there, back) = there_and_back(context, *surface)?;
            let report =
                judge_exact(there.iter().zip(&back).flat_map(|(a, b)| {
                    (0..3).map(move |c| Compared::relative(a[c], b[c], allowed))
                }));
            measures.push(Measure::worst("f there and back", &report).of_row(surface));
            if report.disagree > 0 {
                let some = some_are(report.disagree, report.compared, "values");
                complaints.push(format!("{surface}: {some} another with wi and wo exchanged"));
            }
        }
        let right = format!("{} surfaces are reciprocal", self.surface.len());
        Ok(Finding::measured(right, measures).complaining(complaints))
    }
}

/// f at pairs of directions, and with wi and wo exchanged, each over what exchanging changes.
fn there_and_back(
    context: &mut Context<'_>,
    surface: SurfaceEntry,
) -> Result<(Vec<Rgb>, Vec<Rgb>)> {
    let precision = context.info.precision;
    // cos = √(1 - sin²), to which f is proportional, is off by half of what sin² is, over cos².
    let grazing = (0.5 * ROUNDINGS * precision.epsilon() / Tolerance::FORMULA.of(precision)).sqrt();
    let mut stream = context.seed.child(surface).stream();
    let mut direction = || surface.direction(&mut stream);
    let there: Vec<_> = (0..PAIRS)
        .map(|_| BsdfQuery { wo: direction(), wi: direction() })
        .filter(|query| !grazes_its_microfacet(surface, query, grazing))
        .collect();
    let back: Vec<_> = there.iter().map(|q| BsdfQuery { wo: q.wi, wi: q.wo }).collect();
    let radiance = context.info.conventions.glass_radiance;
    let mut asked = |queries: &[BsdfQuery]| {
        let values = evaluated(context.core, &surface.material(), queries)?;
        let over_index = |(query, value): (&BsdfQuery, &BsdfValue)| {
            let index = index_squared(surface, radiance, query);
            value.f.map(|f| f / index)
        };
        Ok::<_, CheckError>(queries.iter().zip(&values).map(over_index).collect())
    };
    Ok((asked(&there)?, asked(&back)?))
}

/// Whether light is refracted along the microfacet that takes it from `wi` to `wo`, where f vanishes.
fn grazes_its_microfacet(
    surface: SurfaceEntry,
    BsdfQuery { wo, wi }: &BsdfQuery,
    grazing: f64,
) -> bool {
    let SurfaceEntry::RoughGlass(glass) = surface else { return false };
    let ratio = if wo.z > 0.0 { glass.index.0 } else { glass.index.0.recip() };
    let microfacet = (*wo + ratio * *wi).normalize();
    wo.z * wi.z < 0.0 && wo.dot(microfacet).abs().min(wi.dot(microfacet).abs()) < grazing
}

/// What f across an interface is proportional to that is not the same both ways: the square of the index on the
/// side of wo where radiance is scaled by it, on the side of wi where it is not.
fn index_squared(surface: SurfaceEntry, radiance: GlassRadiance, query: &BsdfQuery) -> f64 {
    let side = match radiance {
        GlassRadiance::Scaled => query.wo,
        GlassRadiance::Unscaled => query.wi,
    };
    match surface {
        SurfaceEntry::RoughGlass(glass) if query.wo.z * query.wi.z < 0.0 && side.z < 0.0 => {
            glass.index.0 * glass.index.0
        }
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::Lambertian;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    const CASE: &str = "[expect]\nsurface = [{ diffuse = 0.5 }]";

    #[test]
    fn a_lambertian_surface_is_reciprocal() {
        assert_passes(&judge(&check_of::<Reciprocal>(CASE), &mut Lambertian::default().core()));
    }

    #[test]
    fn a_value_that_depends_on_wo_alone_is_seen() {
        let fake = Lambertian { tilt: 1e-3, ..Lambertian::default() };
        let finding = judge(&check_of::<Reciprocal>(CASE), &mut fake.core());
        assert!(failure(&finding).contains("wi and wo exchanged"));
    }
}
