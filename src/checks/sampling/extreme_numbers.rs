//! Samplers at the ends of the range of their random numbers.

use super::distribution::{Distribution, DistributionEntry};
use super::extremes::{Extremes, Range, finding};
use super::of_distributions::OfDistributions;
use crate::checks::{Context, Finding, Result, check};
use crate::contract::Randomness;
use crate::stats::Tolerance;

check! {
    pub(crate) struct ExtremeNumbers {
        distribution: DistributionEntry,
    }
    name: "extreme-numbers",
    summary: "samples of random numbers that are 0, or nearly 1",
    needs: CALLERS_RANDOMNESS,
}

impl OfDistributions for ExtremeNumbers {
    type Judged = Extremes;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution) -> Result<Extremes> {
        let precision = context.info.precision;
        let allowed = Tolerance::SAME_VALUE.of(precision);
        let core = &mut *context.core;
        let ask = &mut |(point, lobe)| {
            let random = Randomness { points: &[point], lobes: &[lobe], seed: 0 };
            let drawn = distribution.sample(core, random)?[0];
            let mut pdf = [0.0];
            if let Some(direction) = drawn.direction {
                distribution.pdf(core, &[direction], &mut pdf)?;
            }
            Ok((drawn, pdf[0]))
        };
        Ok(Extremes::of(distribution.name(), Range::Hemisphere, precision, allowed, ask)?)
    }

    fn finding(extremes: &[Extremes]) -> Finding {
        finding(extremes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_pdf, drawing, uniform, uniform_pdf};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use glam::{DVec2, DVec3};
    use std::f64::consts::TAU;

    fn found(map: fn(DVec2) -> Option<DVec3>, pdf: fn(DVec3) -> f64) -> Finding {
        let check: ExtremeNumbers =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        judge(&check, &mut drawing(map, pdf))
    }

    #[test]
    fn maps_of_one_minus_u_pass() {
        assert_passes(&found(cosine, cosine_pdf));
        assert_passes(&found(uniform, uniform_pdf));
    }

    /// Shirley and Chiu's concentric map of the square to the disk: its edges are the rim.
    fn concentric(point: DVec2) -> Option<DVec3> {
        let at = 2.0 * point - 1.0;
        let (radius, eighths) = match at.x.abs() > at.y.abs() {
            true => (at.x, at.y / at.x),
            false => (at.y, 2.0 - at.x / at.y),
        };
        let height = (1.0 - radius * radius).max(0.0).sqrt();
        Some(at_height(height, if radius == 0.0 { 0.0 } else { TAU / 8.0 * eighths }))
    }

    #[test]
    fn the_rim_of_the_disk_has_pdf_0_and_is_right() {
        assert_passes(&found(concentric, cosine_pdf));
        assert_passes(&found(|p| Some(at_height(p.x.sqrt(), TAU * p.y)), cosine_pdf));
    }

    #[test]
    fn pdf_0_above_the_horizon_is_named() {
        let only_low = |direction: DVec3| if direction.z > 1.0 - 1e-6 { 0.0 } else { 0.1 };
        let finding = found(cosine, only_low);
        let statement = failure(&finding);
        assert!(statement.contains("of the numbers 0, 0 and 0: the pdf of the sample is 0"));
        assert_eq!(finding.clues[0].cause, "ends-of-range-forgotten");
    }

    #[test]
    fn nan_at_an_end_is_told_with_its_numbers() {
        let finding =
            found(|p| Some(at_height((1.0 - p.x).sqrt() + 0.0 / p.x, TAU * p.y)), cosine_pdf);
        let statement = failure(&finding);
        assert!(statement.contains("of the numbers 0, 0 and 0: sample 0 of 1: "), "{statement}");
    }

    #[test]
    fn a_pdf_that_is_not_evaluated_is_no_matter_of_extremes() {
        let finding = found(|p| cosine(p).map(|d| -d), |d| d.z.abs());
        failure(&finding);
        assert!(finding.clues.is_empty());
    }
}
