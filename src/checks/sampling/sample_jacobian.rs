//! A sampler's map and its pdf fit together at every point: |∂ω/∂u × ∂ω/∂v| · pdf = 1.
//!
//! Where a third number chooses between ways, each way has a map of its own, and the product is the probability of that
//! way: the share of third numbers that choose it, which is found by halving.
//!
//! No statistics: wherever the map from the unit square is smooth, how much it stretches area is the reciprocal of
//! the pdf (an idea seen in the tests of lajolla). Needs a core that samples with the caller's numbers.

use super::distribution::{Distribution, DistributionEntry};
use super::of_distributions::OfDistributions;
use super::products::{POINTS, Products};
use super::way::Way;
use crate::checks::phrase::figure;
use crate::checks::{Context, Finding, Result, check};
use crate::contract::Precision;
use crate::stats::Tolerance;

check! {
    pub(crate) struct SampleJacobian {
        distribution: DistributionEntry,
    }
    name: "sample-jacobian",
    summary: "pdf times the area that the sampler's map makes of the unit square",
    needs: CALLERS_RANDOMNESS,
}

impl OfDistributions for SampleJacobian {
    type Judged = Vec<Products>;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(
        &self,
        context: &mut Context<'_>,
        distribution: &Distribution,
    ) -> Result<Vec<Products>> {
        Way::of(distribution).iter().map(|way| Products::of(context, distribution, *way)).collect()
    }

    fn finding(judged: &[Vec<Products>]) -> Finding {
        let products = || judged.iter().flatten();
        let right = format!("pdf times Jacobian is 1 at {} points", POINTS * products().count());
        let precision = products().next().map_or(Precision::Double, |one| one.precision);
        let allowed = Tolerance::JACOBIAN_MEDIAN.of(precision);
        let caught = format!("would have caught a factor of 1 ± {}", figure(allowed));
        Finding::of(right, caught, products().flat_map(Products::measures).collect())
            .complaining(products().filter_map(Products::complaint))
            .because_each(
                products().filter_map(Products::cause),
                "predicts pdf and Jacobian at nearly all points",
            )
            .knowing_laws(products().filter_map(Products::law_in_words))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_pdf, drawing, interface, uniform, uniform_pdf};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use crate::stats::Verdict;
    use glam::DVec2;
    use glam::DVec3;
    use std::f64::consts::TAU;

    fn found(map: fn(DVec2) -> Option<DVec3>, pdf: fn(DVec3) -> f64) -> Finding {
        let check: SampleJacobian =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        judge(&check, &mut drawing(map, pdf))
    }

    /// The statement and the first clue.
    fn named(map: fn(DVec2) -> Option<DVec3>, pdf: fn(DVec3) -> f64) -> (String, String) {
        let finding = found(map, pdf);
        let clue = finding.clues.first().map_or_else(String::new, |clue| clue.cause.clone());
        (failure(&finding).to_owned(), clue)
    }

    fn assert_named(found: (String, String), statement: &str, clue: &str) {
        assert!(found.0.ends_with(statement), "{found:?}");
        assert_eq!(found.1, clue);
    }

    #[test]
    fn maps_that_fit_their_pdfs_pass() {
        assert_passes(&found(cosine, cosine_pdf));
        assert_passes(&found(uniform, uniform_pdf));
    }

    #[test]
    fn a_missing_one_over_pi_is_a_constant_factor() {
        assert_named(named(cosine, |d| d.z.max(0.0)), "is π instead of 1", "pdf-without-pi");
    }

    #[test]
    fn the_wrong_pdf_for_the_map_is_a_cosine() {
        let wrong_pdf = named(cosine, uniform_pdf);
        assert_named(wrong_pdf, "is 1/2 / cos θ instead of 1", "uniform-pdf-for-cosine");
        let wrong_map = named(uniform, cosine_pdf);
        assert_named(wrong_map, "is 2 cos θ instead of 1", "uniform-for-cosine");
    }

    #[test]
    fn angles_that_are_drawn_uniformly_are_named() {
        let theta = |p: DVec2| Some(crate::math::frame::direction(0.25 * TAU * p.x, TAU * p.y));
        let finding = found(theta, cosine_pdf);
        failure(&finding);
        assert_eq!(finding.clues[0].cause, "theta-uniform");
    }

    #[test]
    fn a_line_is_of_one_number_where_heights_and_azimuths_vary() {
        let cause = |map: fn(DVec2) -> Option<DVec3>| {
            let finding = found(map, cosine_pdf);
            failure(&finding);
            finding.clues.first().map(|clue| clue.cause.clone())
        };
        let twice = cause(|p| Some(at_height((1.0 - p.x).sqrt(), TAU * p.x)));
        assert_eq!(twice.as_deref(), Some("one-number-twice"));
        let azimuth_kept = cause(|p| Some(at_height((1.0 - p.x).sqrt(), 1.0)));
        assert_ne!(azimuth_kept, twice);
        let height_kept = cause(|p| Some(at_height(0.7, TAU * p.y)));
        assert_ne!(height_kept, twice);
    }

    #[test]
    fn half_of_the_azimuths_is_a_factor_of_one_half() {
        let half = |p: DVec2| Some(at_height((1.0 - p.x).sqrt(), 0.5 * TAU * p.y));
        assert_named(named(half, cosine_pdf), "is 1/2 instead of 1", "half-of-azimuths");
    }

    #[test]
    fn half_of_the_heights_is_not_half_of_the_azimuths() {
        let upper = |p: DVec2| Some(at_height((1.0 - 0.5 * p.x).sqrt(), TAU * p.y));
        assert_named(named(upper, cosine_pdf), "is 1/2 instead of 1", "");
    }

    fn of_both_ways(pdf: fn(DVec3) -> f64) -> Finding {
        let check: SampleJacobian = check_of(
            "[expect]\ndistribution = { surface = { rough-glass = { index = 1.5, roughness = 0.5 } }, \
             seen-from = [\"30 deg\"] }",
        );
        judge(&check, &mut interface(0.3, pdf))
    }

    #[test]
    fn ways_that_are_chosen_by_their_chance_pass_and_others_are_off_by_it() {
        assert_passes(&of_both_ways(|d| {
            (if d.z > 0.0 { 0.3 } else { 0.7 }) * cosine_pdf(d.with_z(d.z.abs()))
        }));
        let finding = of_both_ways(|d| cosine_pdf(d.with_z(d.z.abs())));
        assert!(
            failure(&finding).contains("lobe 0: pdf times Jacobian is 3.33 instead"),
            "{finding:?}"
        );
    }

    #[test]
    fn a_map_that_mostly_fails_proves_nothing() {
        let finding = found(|_| None, cosine_pdf);
        // The contract has no failing sampler, so that the fake answers +z everywhere: area 0.
        assert_eq!(finding.verdict, Verdict::Fail);
    }
}
