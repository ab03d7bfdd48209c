//! f(a, b) = f(b, a), after Helmholtz. Densities need not be.

use crate::checks::phrase::{some_are, worst_measure, would_have_caught};
use crate::checks::surface::SurfaceEntry;
use crate::checks::{Check, CheckError, Context, Finding};
use crate::contract::{BsdfQuery, BsdfValue, Capabilities};
use crate::math::sphere::on_hemisphere;
use crate::stats::{Compared, Tolerance, judge_exact};
use serde::Deserialize;

/// Pairs of directions for each surface.
const PAIRS: usize = 10_000;

/// Light and eye are exchanged.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Reciprocal {
    surface: Vec<SurfaceEntry>,
}

impl Check for Reciprocal {
    const NAME: &'static str = "bsdf-reciprocal";
    const SUMMARY: &'static str = "f(a, b) = f(b, a)";

    fn needs(&self) -> Capabilities {
        Capabilities::EVAL_BSDF
    }

    fn validate(&self) -> Result<(), String> {
        match self.surface.iter().find(|surface| surface.is_delta()) {
            Some(delta) => Err(format!("{delta} is zero wherever it is evaluated")),
            None if self.surface.is_empty() => Err("there are no surfaces".to_owned()),
            None => Ok(()),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let allowed = Tolerance::FORMULA.of(context.info.precision);
        let mut measures = Vec::new();
        let mut complaints = Vec::new();
        for surface in &self.surface {
            let (there, back) = there_and_back(context, *surface)?;
            let pairs = there.iter().zip(&back);
            let report = judge_exact(pairs.flat_map(|(a, b)| {
                (0..3).map(move |c| Compared::relative(a.f[c], b.f[c], allowed))
            }));
            measures.push(worst_measure(format!("{surface}: f there and back"), &report));
            if report.disagree > 0 {
                let some = some_are(report.disagree, report.compared, "values");
                complaints.push(format!("{surface}: {some} another with light and eye exchanged"));
            }
        }
        let statement = match complaints.is_empty() {
            true => format!("{} surfaces are reciprocal", self.surface.len()),
            false => complaints.join("; "),
        };
        let resolution = would_have_caught(&measures);
        Ok(Finding::of(statement, resolution, measures))
    }
}

fn there_and_back(
    context: &mut Context<'_>,
    surface: SurfaceEntry,
) -> Result<(Vec<BsdfValue>, Vec<BsdfValue>), CheckError> {
    let mut stream = context.seed.child(surface).stream();
    let there: Vec<_> = (0..PAIRS)
        .map(|_| BsdfQuery { wo: on_hemisphere(&mut stream), wi: on_hemisphere(&mut stream) })
        .collect();
    let back: Vec<_> = there.iter().map(|q| BsdfQuery { wo: q.wi, wi: q.wo }).collect();
    let mut evaluated = |queries: &[BsdfQuery]| {
        let mut values = vec![BsdfValue { f: [0.0; 3], pdf: 0.0 }; queries.len()];
        let result = context.core.eval_bsdf(&surface.material(), queries, &mut values);
        result.map(|()| values)
    };
    Ok((evaluated(&there)?, evaluated(&back)?))
}

#[cfg(test)]
mod tests {
    use super::super::fake::Fake;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    const CASE: &str = "[expect]\nsurface = [{ diffuse = 0.5 }]";

    #[test]
    fn a_lambertian_surface_is_reciprocal() {
        assert_passes(&judge(&check_of::<Reciprocal>(CASE), &mut Fake::default()));
    }

    #[test]
    fn a_value_that_depends_on_the_eye_alone_is_seen() {
        let mut fake = Fake { tilt: 1e-3, ..Fake::default() };
        let finding = judge(&check_of::<Reciprocal>(CASE), &mut fake);
        assert!(failure(&finding).contains("light and eye exchanged"));
    }
}
