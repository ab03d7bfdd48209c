//! The albedo of a surface, as in a white furnace test: never above one, and what its parameters say it is.

use super::albedo::Albedo;
use super::wrong_value::{DIRECTIONS, Made, made};
use crate::checks::phrase::{degrees, figure};
use crate::checks::surface::{SurfaceEntry, evaluated, kink, seen_from};
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, check};
use crate::contract::{BsdfQuery, Capabilities};
use crate::math::quadrature::Diligence;
use crate::math::ratios::names_of;
use crate::stats::{SphereCells, Tolerance};
use crate::text::{Polar, Several};

/// Rings in each hemisphere and sectors of the quadrature.
const CELLS: (usize, usize) = (4, 8);

check! {
    pub(crate) struct ConservesEnergy {
        surface: Several<SurfaceEntry>,
        seen_from: Several<Polar>,
    }
    name: "bsdf-conserves-energy",
    summary: "quadrature of f cos is the albedo, and never above one",
    needs: EVAL_BSDF,
}

impl Check for ConservesEnergy {
    fn needs_besides(&self) -> Capabilities {
        SurfaceEntry::all_need(&self.surface)
    }

    fn validate(&self) -> Result<(), String> {
        SurfaceEntry::refuse_delta(&self.surface, "is zero wherever it is evaluated")
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let mut measures = Vec::new();
        for surface in self.surface.iter() {
            for Polar(angle) in self.seen_from.iter() {
                measures.extend(albedo_measures(context, *surface, *angle)?);
            }
        }
        let worst = measures.iter().find(|measure| measure.failed()).map(complaint);
        let made = match worst {
            Some(_) => self.made(context)?,
            None => Vec::new(),
        };
        // It is the same with all surfaces that something is wrong with.
        let mut causes: Vec<_> = made.iter().filter_map(|of_one| of_one.cause).collect();
        causes.dedup();
        let causes = if causes.len() == 1 { causes } else { Vec::new() };
        let right = format!("{} albedos are what they should be", measures.len());
        Ok(Finding::measured(right, measures)
            .complaining(worst)
            .because_each(causes, &format!("predicts f at {DIRECTIONS} pairs of directions"))
            .by_law(made.into_iter().filter_map(|of_one| of_one.law)))
    }
}

impl ConservesEnergy {
    /// What makes f of each surface.
    fn made(&self, context: &mut Context<'_>) -> Result<Vec<Made>> {
        self.surface.iter().map(|surface| made(context, *surface)).collect()
    }
}

fn complaint(measure: &Measure) -> String {
    let ratio = measure.measured / measure.expected;
    let slack = 1e-3 * ratio.abs();
    let named = names_of([ratio - slack, ratio + slack], &[]);
    let name = named.first().map_or_else(String::new, |ratio| format!(" ({})", ratio.name));
    format!("{} is {}{name} of what it should be", measure.name(), figure(ratio))
}

/// The albedo of the green channel, by quadrature of the core's own values; of what light passes, on either side.
fn albedo_measures(
    context: &mut Context<'_>,
    surface: SurfaceEntry,
    angle: f64,
) -> Result<Vec<Measure>> {
    let relative = Tolerance::FORMULA.of(context.info.precision);
    let expected = Albedo::expected(surface, angle, context.info.conventions);
    let (material, wo) = (surface.material(), seen_from(angle));
    let cells =
        SphereCells::sphere(CELLS.0, CELLS.1).with_kinks(kink(&material.surface, angle).as_slice());
    let diligence = match expected {
        Albedo::OfOneSide(albedo) => {
            let tolerance = 0.1 * relative * albedo / cells.len() as f64;
            Diligence { tolerance, ..Diligence::default() }
        }
        // Where total reflection begins, f has a kink along a curve.
        Albedo::OfBothSides { .. } => Diligence::KINKED,
    };
    let core = &mut *context.core;
    let integral = cells.probabilities(diligence, &mut |directions, values| {
        let queries: Vec<_> = directions.iter().map(|wi| BsdfQuery { wo, wi: *wi }).collect();
        let answers = evaluated(core, &material, &queries)?;
        for ((value, answer), wi) in values.iter_mut().zip(&answers).zip(directions) {
            *value = answer.f[1] * wi.z.abs();
        }
        Ok::<_, CheckError>(())
    })?;
    let measure = |what: &str, expected: f64, belongs: &dyn Fn(f64) -> bool| {
        let within = |cell: &usize| belongs(cells.bounds(*cell).0.iter().sum::<f64>() * wo.z);
        let sum = |of: &[f64]| (0..cells.len()).filter(within).map(|cell| of[cell]).sum::<f64>();
        let (found, error) = (sum(&integral.cells), sum(&integral.errors));
        let row = format!("{surface} seen from {}", degrees(angle));
        Measure::by_quadrature(what, [found, error], expected, relative * expected).of_row(row)
    };
    Ok(match expected {
        Albedo::OfOneSide(expected) => vec![measure("albedo", expected, &|_| true)],
        Albedo::OfBothSides { reflected, refracted } => vec![
            measure("albedo, reflected", reflected, &|height| height > 0.0),
            measure("albedo, refracted", refracted, &|height| height < 0.0),
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::super::fake::Lambertian;
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use std::f64::consts::PI;

    const CASE: &str =
        "[expect]\nsurface = [{ diffuse = 0.5 }]\nseen-from = [\"20 deg\", \"70 deg\"]";

    fn found(gain: f64) -> Finding {
        judge(
            &check_of::<ConservesEnergy>(CASE),
            &mut Lambertian { gain, ..Lambertian::default() }.core(),
        )
    }

    #[test]
    fn the_albedo_of_a_lambertian_surface_is_its_reflectance() {
        assert_passes(&found(1.0));
    }

    #[test]
    fn a_missing_pi_is_named() {
        let finding = found(PI);
        assert!(failure(&finding).contains("(π)"));
        assert_eq!(finding.clues[0].cause, "brdf-without-pi");
        assert_eq!(found(0.5).clues[0].cause, "albedo-halved");
        assert!(found(1.1).clues.is_empty());
    }

    #[test]
    fn a_part_in_ten_thousand_is_seen() {
        failure(&found(1.0001));
    }
}
