//! Means of low harmonics over the samples against those of the pdf: fifteen numbers that see a
//! smooth error, such as a lobe that leans, long before counts in cells do, and say which way it
//! leans.

use super::distribution::{Distribution, DistributionEntry};
use super::moments::Judged;
use super::of_distributions::OfDistributions;
use crate::checks::{Context, Finding, Result, check};
use crate::stats::Band;
use crate::text::{Count, Percent};

check! {
    /// E\[Yₗₘ\] over samples is ∫ pdf Yₗₘ, for degrees 1 to 3.
    pub(crate) struct MomentsFollowPdf {
        distribution: DistributionEntry,
        /// The smallest error of a moment that must be seen; moments lie between −1 and 1.
        detects: Percent,
        at_most: Count,
    }
    name: "moments-follow-pdf",
    summary: "means of spherical harmonics over samples against their pdf",
}

impl OfDistributions for MomentsFollowPdf {
    type Judged = Judged;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution) -> Result<Judged> {
        let effort = context.effort(self.detects, self.at_most);
        let band = Band::math(context.info.precision);
        Judged::of(context, distribution, band, &effort)
    }

    fn finding(judged: &[Judged]) -> Finding {
        let measures: Vec<_> = judged.iter().flat_map(Judged::measures).collect();
        let right = format!("{} moments of samples are those of their pdfs", measures.len());
        Finding::measured(right, measures)
            .in_terms(" of the range of a moment")
            .complaining(judged.iter().filter_map(Judged::complaint))
            .because_of(judged.iter().filter_map(|judged| judged.cause.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_pdf, drawing, uniform, uniform_pdf};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, judge, number_after};
    use glam::{DQuat, DVec2, DVec3};

    type Map = fn(DVec2) -> Option<DVec3>;

    fn found(map: Map, pdf: fn(DVec3) -> f64) -> Finding {
        let check: MomentsFollowPdf = check_of(
            "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }\n\
             detects = \"1 %\"\nat-most = \"400 k\"",
        );
        judge(&check, &mut drawing(map, pdf))
    }

    #[test]
    fn right_samplers_pass() {
        assert_passes(&found(cosine, cosine_pdf));
        assert_passes(&found(uniform, uniform_pdf));
    }

    #[test]
    fn a_lobe_that_leans_by_two_degrees_is_seen_and_told_which_way() {
        let finding = found(
            |point| cosine(point).map(|d| DQuat::from_rotation_y(2f64.to_radians()) * d),
            cosine_pdf,
        );
        let statement = failure(&finding);
        assert!((number_after(statement, "samples lean ") - 2.0).abs() < 0.1, "{statement}");
        assert!(statement.contains("towards (0.02"), "{statement}");
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn turned_frames_have_names() {
        let cases: [(Map, &str); 3] = [
            (|point| cosine(point).map(|d| DVec3::new(d.x, d.z, d.y)), "hemisphere-around-y"),
            (|point| cosine(point).map(|d| DVec3::new(d.z, d.y, d.x)), "hemisphere-around-x"),
            (|point| cosine(point).map(|d| -d), "samples-below-surface"),
        ];
        for (map, name) in cases {
            let finding = found(map, cosine_pdf);
            assert_eq!(causes(&finding), [name], "{}", finding.statement);
        }
    }

    #[test]
    fn another_law_of_heights_is_told_by_its_moment() {
        let finding = found(uniform, cosine_pdf);
        let statement = failure(&finding);
        // ∫ (3z² − 1)/2 is 0 over the hemisphere and 1/4 with the cosine.
        assert!(statement.contains("the mean of 3z² − 1 is "), "{statement}");
        assert!(statement.ends_with(" instead of 0.25"), "{statement}");
    }
}
