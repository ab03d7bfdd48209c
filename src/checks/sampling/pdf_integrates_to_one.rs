//! A density integrates to one; where samples may fail, to the share of those that do not.

use super::density::Density;
use super::distribution::{Distribution, DistributionEntry};
use super::of_distributions::OfDistributions;
use crate::cause::Cause;
use crate::checks::phrase::{figure, percent};
use crate::checks::{CheckError, Context, Finding, Measure};
use crate::math::quadrature::Diligence;
use crate::math::ratios::names_of;
use crate::stats::{Band, Effort, ShareReport, SphereCells, Tolerance, judge_share};
use serde::Deserialize;

/// Rings in each hemisphere and sectors: the horizon is an edge between cells, and no cell is larger than most lobes.
const CELLS: (usize, usize) = (4, 8);
/// The smallest error of the share of samples that succeed.
const SHARE_DETECTS: f64 = 0.01;

/// The core's own density, integrated over the whole sphere.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PdfIntegratesToOne {
    distribution: DistributionEntry,
}

impl OfDistributions for PdfIntegratesToOne {
    const NAME: &'static str = "pdf-integrates-to-one";
    const SUMMARY: &'static str = "quadrature of a sampler's density over the sphere";
    type Judged = Mass;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(
        &self,
        context: &mut Context<'_>,
        distribution: &Distribution,
    ) -> Result<Self::Judged, CheckError> {
        Mass::of(context, distribution)
    }

    fn finding(masses: &[Self::Judged]) -> Finding {
        Finding::measured(passing_statement(masses), masses.iter().map(Mass::measure))
            .complaining(masses.iter().filter_map(Mass::complaint))
            .because_each(
                masses.iter().filter_map(|mass| mass.cause),
                "has the form of the density at 200 directions",
            )
    }
}

fn passing_statement(masses: &[Mass]) -> String {
    match masses {
        [one] => format!("the density of {} integrates to {}", one.name, figure(one.value)),
        all => format!("{} densities integrate to the share of samples that succeed", all.len()),
    }
}

/// The integral of one density, and what it has to be.
pub struct Mass {
    name: String,
    value: f64,
    /// Bound on the error of the quadrature.
    error: f64,
    allowed: f64,
    /// Where samples may fail and some have to: the share of those that succeed.
    accepted: Option<ShareReport>,
    cause: Option<&'static Cause>,
}

impl Mass {
    fn of(context: &mut Context<'_>, distribution: &Distribution) -> Result<Self, CheckError> {
        let allowed = Tolerance::INTEGRAL.of(context.info.precision);
        let cells =
            SphereCells::sphere(CELLS.0, CELLS.1).with_kinks(distribution.kink().as_slice());
        // Together the cells may not use up more than a tenth of what is allowed.
        let tolerance = 0.1 * allowed / cells.len() as f64;
        let diligence = match distribution.is_of_sphere() {
            // Where total reflection begins, a density has a kink along a curve; some samples always fail.
            true => Diligence::KINKED,
            false => Diligence { tolerance, ..Diligence::default() },
        };
        let core = &mut *context.core;
        let probabilities = cells.probabilities(diligence, &mut |directions, values| {
            distribution.pdf(core, directions, values)
        })?;
        let error: f64 = probabilities.errors.iter().sum();
        let value = probabilities.mass;
        let may_fail = distribution.may_fail() && value < 1.0 - allowed - error;
        let accepted = match may_fail && value > 0.0 {
            true => Some(accepted_share(context, distribution, value)?),
            false => None,
        };
        let cause = Density::of(context.core, distribution)?.and_then(Density::mistake);
        Ok(Self { name: distribution.name(), value, error, allowed, accepted, cause }.named())
    }

    /// Without a cause where nothing is wrong.
    fn named(self) -> Self {
        let cause = self.cause.filter(|_| self.complaint().is_some());
        Self { cause, ..self }
    }

    fn measure(&self) -> Measure {
        let measure = match &self.accepted {
            None => {
                let name = "integral of the density";
                Measure::exact(name, self.value, 1.0, self.allowed + self.error)
            }
            Some(report) => Measure {
                measured: self.value,
                expected: report.share.min(1.0),
                allowed: report.resolution * report.share.min(1.0),
                ..Measure::of(
                    "integral of the density, against the share of samples that succeed",
                    report,
                )
            },
        };
        measure.of_row(&self.name)
    }

    fn complaint(&self) -> Option<String> {
        let measure = Some(self.measure()).filter(Measure::failed)?;
        let measured = figure(self.value);
        if let Some(report) = &self.accepted {
            let share = percent(report.share);
            return Some(format!(
                "the density of {} integrates to {measured}, but {share} of its samples succeed",
                self.name
            ));
        }
        let slack = 1e-3 * self.value;
        let names = names_of([self.value - slack, self.value + slack], &[]);
        let named = names.first().map(|ratio| &ratio.name).filter(|name| **name != measured);
        let also = named.map_or_else(String::new, |name| format!(" ({name})"));
        let expected = measure.expected;
        Some(format!(
            "the density of {} integrates to {measured}{also} instead of {expected}",
            self.name
        ))
    }
}

/// Whether samples succeed as often as the density says.
fn accepted_share(
    context: &mut Context<'_>,
    distribution: &Distribution,
    mass: f64,
) -> Result<ShareReport, CheckError> {
    let seed = context.seed.child(distribution.name());
    let band = Band::math(context.info.precision);
    let effort = context.budget.scale(Effort::new(SHARE_DETECTS));
    let core = &mut *context.core;
    let report = judge_share(mass, band, &effort, &mut |stage, samples| {
        let mut succeeded = 0;
        distribution.draw(core, seed.child(stage), samples, |drawn| {
            succeeded += drawn.iter().filter(|drawn| drawn.direction.is_some()).count() as u64;
        })?;
        Ok::<_, CheckError>(succeeded)
    })?;
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_density, drawing, uniform_density};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use crate::stats::Verdict;
    use std::f64::consts::{FRAC_1_PI, TAU};

    const SAMPLER: &str = "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }";
    const SURFACE: &str =
        "[expect]\ndistribution = { surface = { diffuse = 0.5 }, seen-from = [\"30 deg\"] }";

    fn found(text: &str, density: fn(glam::DVec3) -> f64) -> Finding {
        judge(&check_of::<PdfIntegratesToOne>(text), &mut drawing(cosine, density))
    }

    #[test]
    fn densities_that_integrate_to_one_pass() {
        assert_passes(&found(SAMPLER, cosine_density));
        assert_passes(&found(SAMPLER, uniform_density));
        assert_passes(&found(SURFACE, cosine_density));
    }

    #[test]
    fn wrong_factors_are_named() {
        let statement = |density| found(SAMPLER, density).statement;
        assert!(statement(|d| d.z.max(0.0)).contains("integrates to 3.14 (π) instead of 1"));
        assert!(statement(|d| d.z.abs() * FRAC_1_PI).contains("integrates to 2 instead of 1"));
        assert!(statement(|d| if d.z > 0.0 { 0.5 / TAU } else { 0.0 }).contains("0.5 (1/2)"));
        assert_eq!(found(SAMPLER, |d| d.z.max(0.0)).verdict, Verdict::Fail);
    }

    #[test]
    fn a_part_in_a_hundred_thousand_is_seen() {
        failure(&found(SAMPLER, |d| (1.0 + 1e-5) * cosine_density(d)));
    }

    #[test]
    fn a_density_that_lacks_what_fails_is_right_and_one_that_does_not_is_wrong() {
        let map =
            |p: glam::DVec2| (p.x < 0.9).then(|| at_height((1.0 - p.x / 0.9).sqrt(), TAU * p.y));
        let judged =
            |density| judge(&check_of::<PdfIntegratesToOne>(SURFACE), &mut drawing(map, density));
        assert_passes(&judged(|d| 0.9 * cosine_density(d)));
        let wrong = judged(|d| 0.8 * cosine_density(d));
        assert!(
            failure(&wrong).contains("integrates to 0.8, but 90 % of its samples succeed"),
            "{wrong:?}"
        );
    }
}
