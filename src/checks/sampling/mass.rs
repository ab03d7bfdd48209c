//! The integral of one pdf over the sphere, and what it has to be.

use super::claimed_pdf::ClaimedPdf;
use super::distribution::Distribution;
use crate::cause::Cause;
use crate::checks::phrase::{figure, percent};
use crate::checks::{CheckError, Context, Measure, Result};
use crate::math::quadrature::Diligence;
use crate::math::ratios::names_of;
use crate::stats::{Band, Claim, Effort, MeanReport, SphereCells, Tolerance, judge_means};

/// Rings in each hemisphere and sectors: the horizon is an edge between cells, and no cell is larger than most lobes.
pub(super) const CELLS: (usize, usize) = (4, 8);

/// The smallest error of the share of samples that succeed.
const SHARE_DETECTS: f64 = 0.01;

/// The integral of one pdf, and what it has to be.
pub(crate) struct Mass {
    pub(super) name: String,
    pub(super) value: f64,
    /// Bound on the error of the quadrature.
    pub(super) error: f64,
    pub(super) allowed: f64,
    /// Where samples may fail and some have to: the share of those that succeed.
    accepted: Option<MeanReport>,
    pub(super) cause: Option<&'static Cause>,
}

impl Mass {
    pub(super) fn of(context: &mut Context<'_>, distribution: &Distribution) -> Result<Self> {
        let allowed = Tolerance::INTEGRAL.of(context.info.precision);
        let cells =
            SphereCells::sphere(CELLS.0, CELLS.1).with_kinks(distribution.kink().as_slice());
        // Together the cells may not use up more than a tenth of what is allowed.
        let tolerance = 0.1 * allowed / cells.len() as f64;
        let diligence = match distribution.is_of_sphere() {
            // Where total reflection begins, a pdf has a kink along a curve; some samples always fail.
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
        let cause = ClaimedPdf::of(context.core, distribution)?.and_then(ClaimedPdf::mistake);
        Ok(Self { name: distribution.name(), value, error, allowed, accepted, cause }.named())
    }

    /// Without a cause where nothing is wrong.
    pub(super) fn named(self) -> Self {
        let cause = self.cause.filter(|_| self.complaint().is_some());
        Self { cause, ..self }
    }

    pub(super) fn measure(&self) -> Measure {
        let measure = match &self.accepted {
            None => Measure::by_quadrature(
                "integral of the pdf",
                [self.value, self.error],
                1.0,
                self.allowed,
            ),
            Some(report) => Measure {
                measured: self.value,
                expected: report.mean.min(1.0),
                allowed: report.resolution * report.mean.min(1.0),
                ..Measure::of(
                    "integral of the pdf, against the share of samples that succeed",
                    report,
                )
            },
        };
        measure.of_row(&self.name)
    }

    pub(super) fn complaint(&self) -> Option<String> {
        let measure = Some(self.measure()).filter(Measure::failed)?;
        let measured = figure(self.value);
        if let Some(report) = &self.accepted {
            let share = percent(report.mean);
            return Some(format!(
                "the pdf of {} integrates to {measured}, but {share} of its samples succeed",
                self.name
            ));
        }
        let slack = 1e-3 * self.value;
        let names = names_of([self.value - slack, self.value + slack], &[]);
        let named = names.first().map(|ratio| &ratio.name).filter(|name| **name != measured);
        let also = named.map_or_else(String::new, |name| format!(" ({name})"));
        let expected = measure.expected;
        Some(format!(
            "the pdf of {} integrates to {measured}{also} instead of {expected}",
            self.name
        ))
    }
}

/// Whether samples succeed as often as the pdf says.
fn accepted_share(
    context: &mut Context<'_>,
    distribution: &Distribution,
    mass: f64,
) -> Result<MeanReport> {
    let seed = context.seed.child(distribution.name());
    let band = Band::math(context.info.precision);
    let effort = context.budget.scale(Effort::new(SHARE_DETECTS));
    let core = &mut *context.core;
    let claims = [Claim::share(mass, band)];
    let mut reports = judge_means(&claims, &effort, &mut |draw| {
        let mut succeeded = 0;
        distribution.draw(core, draw.seed(seed), draw.samples, |drawn| {
            succeeded += drawn.iter().filter(|drawn| drawn.direction.is_some()).count() as u64;
        })?;
        Ok::<_, CheckError>(vec![succeeded as f64 / draw.samples as f64])
    })?;
    Ok(reports.remove(0))
}
