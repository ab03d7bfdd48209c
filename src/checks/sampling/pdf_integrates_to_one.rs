//! A pdf integrates to one; where samples may fail, to the share of those that do not.

use super::distribution::{Distribution, DistributionEntry};
use super::mass::Mass;
use super::of_distributions::OfDistributions;
use crate::checks::phrase::figure;
use crate::checks::{Context, Finding, Result, check};

check! {
    pub(crate) struct PdfIntegratesToOne {
        distribution: DistributionEntry,
    }
    name: "pdf-integrates-to-one",
    summary: "quadrature of a sampler's pdf over the sphere",
}

impl OfDistributions for PdfIntegratesToOne {
    type Judged = Mass;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution) -> Result<Mass> {
        Mass::of(context, distribution)
    }

    fn finding(masses: &[Mass]) -> Finding {
        Finding::measured(passing_statement(masses), masses.iter().map(Mass::measure))
            .complaining(masses.iter().filter_map(Mass::complaint))
            .because_each(
                masses.iter().filter_map(|mass| mass.cause),
                "has the form of the pdf at 200 directions",
            )
    }
}

fn passing_statement(masses: &[Mass]) -> String {
    match masses {
        [one] => format!("the pdf of {} integrates to {}", one.name, figure(one.value)),
        all => format!("{} pdfs integrate to the share of samples that succeed", all.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_pdf, drawing, uniform_pdf};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge, number_after};
    use crate::math::sphere::at_height;
    use crate::stats::Verdict;
    use std::f64::consts::{FRAC_1_PI, TAU};

    const SAMPLER: &str = "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }";
    const SURFACE: &str =
        "[expect]\ndistribution = { surface = { diffuse = 0.5 }, seen-from = [\"30 deg\"] }";

    fn found(text: &str, pdf: fn(glam::DVec3) -> f64) -> Finding {
        judge(&check_of::<PdfIntegratesToOne>(text), &mut drawing(cosine, pdf))
    }

    #[test]
    fn pdfs_that_integrate_to_one_pass() {
        assert_passes(&found(SAMPLER, cosine_pdf));
        assert_passes(&found(SAMPLER, uniform_pdf));
        assert_passes(&found(SURFACE, cosine_pdf));
    }

    #[test]
    fn wrong_factors_are_named() {
        let statement = |pdf| found(SAMPLER, pdf).statement;
        assert!(statement(|d| d.z.max(0.0)).contains("integrates to 3.14 (π) instead of 1"));
        assert!(statement(|d| d.z.abs() * FRAC_1_PI).contains("integrates to 2 instead of 1"));
        assert!(statement(|d| if d.z > 0.0 { 0.5 / TAU } else { 0.0 }).contains("0.5 (1/2)"));
        assert_eq!(found(SAMPLER, |d| d.z.max(0.0)).verdict, Verdict::Fail);
    }

    #[test]
    fn a_part_in_a_hundred_thousand_is_seen() {
        failure(&found(SAMPLER, |d| (1.0 + 1e-5) * cosine_pdf(d)));
    }

    #[test]
    fn a_pdf_that_lacks_what_fails_is_right_and_one_that_does_not_is_wrong() {
        let map =
            |p: glam::DVec2| (p.x < 0.9).then(|| at_height((1.0 - p.x / 0.9).sqrt(), TAU * p.y));
        let judged = |pdf| judge(&check_of::<PdfIntegratesToOne>(SURFACE), &mut drawing(map, pdf));
        assert_passes(&judged(|d| 0.9 * cosine_pdf(d)));
        let wrong = judged(|d| 0.8 * cosine_pdf(d));
        let statement = failure(&wrong);
        assert!(statement.contains("% of its samples succeed"), "{wrong:?}");
        let share = number_after(statement, "integrates to 0.8, but ");
        assert!((share - 90.0).abs() < 0.5, "{wrong:?}");
    }
}
