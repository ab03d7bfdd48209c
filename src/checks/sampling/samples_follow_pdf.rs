//! Samples fall where the pdf says, by χ² on cells of the sphere; failed samples are a cell of their own.

use super::cell_source::Source;
use super::claimed_pdf::ClaimedPdf;
use super::counted::Judged;
use super::distribution::{Distribution, DistributionEntry};
use super::of_distributions::OfDistributions;
use crate::checks::{Context, Finding, Result, check};
use crate::stats::{Stage, judge_count_source};
use crate::text::{Count, Percent};

check! {
    pub(crate) struct SamplesFollowPdf {
        distribution: DistributionEntry,
        /// The smallest error of the pdf, root mean square, that must be seen.
        detects: Percent,
        at_most: Count,
    }
    name: "samples-follow-pdf",
    summary: "chi-square of samples against their pdf",
}

impl OfDistributions for SamplesFollowPdf {
    type Judged = Judged;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution) -> Result<Judged> {
        let effort = context.effort(self.detects, self.at_most);
        let seed = context.seed.child(distribution.name());
        let mut source = Source::new(&mut *context.core, distribution, seed);
        let report = judge_count_source(&effort, &mut source)?;
        let counted = report.counted().map_or(Stage::First, |stage| stage.stage);
        let cells = source.cells_of(counted);
        let pdf = ClaimedPdf::of(context.core, distribution)?;
        Ok(Judged { name: distribution.name(), report, cells, pdf })
    }

    fn finding(judged: &[Judged]) -> Finding {
        let samples: u64 = judged.iter().map(|judged| judged.report.samples).sum();
        let right = format!("{samples} samples fall where their pdfs say");
        Finding::measured(right, judged.iter().map(Judged::measure))
            .in_terms(" of a pdf, root mean square")
            .complaining(judged.iter().filter_map(Judged::complaint))
            .because_each(
                judged.iter().filter_map(Judged::cause),
                "predicts the counts of samples in all rings",
            )
            .showing(Judged::furthest(judged).and_then(Judged::series))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_pdf, drawing, interface, uniform};
    use super::*;
    use crate::checks::series::{Series, SphereCounts};
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use crate::stats::Verdict;
    use glam::DVec2;
    use glam::DVec3;
    use std::f64::consts::TAU;

    const SAMPLER: &str = "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }\n\
                           detects = \"5 %\"\nat-most = \"1 M samples\"";
    const SURFACE: &str = "[expect]\ndistribution = { surface = { diffuse = 0.5 }, seen-from = [\"30 deg\"] }\n\
         detects = \"5 %\"\nat-most = \"1 M samples\"";

    fn found(text: &str, map: fn(DVec2) -> Option<DVec3>) -> Finding {
        let check: SamplesFollowPdf = check_of(text);
        judge(&check, &mut drawing(map, cosine_pdf))
    }

    fn statement(map: fn(DVec2) -> Option<DVec3>) -> String {
        failure(&found(SAMPLER, map)).to_owned()
    }

    #[test]
    fn samples_that_follow_their_pdf_pass_and_spend_of_the_budget() {
        let finding = found(SAMPLER, cosine);
        assert_passes(&finding);
        assert!(finding.hypotheses().count() > 0);
        assert!(counts(&finding).rejected.is_empty());
        assert_passes(&found(SURFACE, cosine));
    }

    #[test]
    fn other_laws_are_named() {
        assert!(statement(uniform).ends_with("they are uniform over the hemisphere"));
        assert_eq!(found(SAMPLER, uniform).clues[0].cause, "uniform-for-cosine");
        assert_eq!(found(SURFACE, uniform).clues[0].cause, "cosine-pdf-for-uniform");
        let theta = |p: DVec2| Some(crate::math::frame::direction(0.25 * TAU * p.x, TAU * p.y));
        assert!(statement(theta).contains("uniform in the angle θ"), "{}", statement(theta));
        let half = |p: DVec2| Some(at_height((1.0 - p.x).sqrt(), 0.5 * TAU * p.y));
        assert!(statement(half).ends_with("nowhere in a part of the azimuths"));
    }

    fn counts(finding: &Finding) -> &SphereCounts {
        let [Series::Directions(counts)] = &finding.series[..] else { panic!("{finding:?}") };
        counts
    }

    #[test]
    fn what_is_drawn_is_what_was_counted_and_the_cells_at_fault_stand_out() {
        let right = counts(&found(SAMPLER, cosine)).clone();
        let expected: f64 = right.expected.iter().sum();
        assert!((expected / right.observed.iter().sum::<u64>() as f64 - 1.0).abs() < 1e-3);
        // The sampler leaves a hole in an azimuth of its own; cells are turned, and it has to be found there.
        let finding = found(SAMPLER, |p| cosine(DVec2::new(p.x, 0.05 + 0.95 * p.y)));
        let holed = counts(&finding);
        let width = TAU / holed.sectors as f64;
        let middle = |cell: usize| holed.offset + width * ((cell % holed.sectors) as f64 + 0.5);
        let empty = (0..holed.observed.len()).filter(|cell| holed.observed[*cell] == 0);
        let empty: Vec<_> = empty.filter(|cell| holed.expected[*cell] > 100.0).collect();
        assert!(holed.rejected.len() >= 5, "{holed:?}");
        for cell in empty {
            assert!(holed.rejected.contains(&cell), "{cell} of {holed:?}");
            assert!((middle(cell) / TAU).rem_euclid(1.0) < 0.05 + 0.5 / 20.0, "{}", middle(cell));
        }
    }

    #[test]
    fn one_number_used_twice_is_seen() {
        let statement = statement(|p| Some(at_height((1.0 - p.x).sqrt(), TAU * p.x)));
        assert!(statement.contains("samples do not follow the pdf"), "{statement}");
    }

    #[test]
    fn samples_below_the_horizon_are_named() {
        let statement = statement(|p| {
            let up = at_height((1.0 - p.x).sqrt(), TAU * p.y);
            Some(if p.x < 0.01 { -up } else { up })
        });
        assert!(statement.contains("the horizon and below, where the pdf is 0"), "{statement}");
    }

    /// In the middle of nothing, too small for quadrature.
    fn is_in_sliver(direction: DVec3) -> bool {
        direction.distance(DVec3::new(0.6, 0.0, -0.8)) < 1e-4
    }

    #[test]
    fn samples_in_a_sliver_that_quadrature_missed_are_not_forbidden() {
        let map = |p: DVec2| if p.x < 1e-4 { Some(DVec3::new(0.6, 0.0, -0.8)) } else { cosine(p) };
        let pdf = |wi| if is_in_sliver(wi) { 1.0 } else { cosine_pdf(wi) };
        assert_passes(&judge(&check_of::<SamplesFollowPdf>(SAMPLER), &mut drawing(map, pdf)));
        assert!(statement(map).contains("where the pdf is 0"), "{}", statement(map));
    }

    fn of_both_ways(reflected: f64) -> Finding {
        let check: SamplesFollowPdf = check_of(
            "[expect]\ndistribution = { surface = { rough-glass = { index = 1.5, roughness = 0.5 } }, \
             seen-from = [\"30 deg\"] }\ndetects = \"5 %\"\nat-most = \"1 M samples\"",
        );
        let pdf = |d: DVec3| (if d.z > 0.0 { 0.3 } else { 0.7 }) * cosine_pdf(d.with_z(d.z.abs()));
        judge(&check, &mut interface(reflected, pdf))
    }

    #[test]
    fn both_ways_are_counted_together() {
        assert_passes(&of_both_ways(0.3));
        let finding = of_both_ways(0.35);
        assert!(failure(&finding).contains("samples do not follow the pdf"), "{finding:?}");
    }

    #[test]
    fn samples_that_fail_without_the_pdf_knowing_are_seen() {
        let finding = found(SURFACE, |p| (p.x > 0.05).then(|| cosine(p)).flatten());
        assert_eq!(finding.verdict, Verdict::Fail);
        let finding = found(SURFACE, |p| (p.y * 97.0 % 1.0 > 0.2).then(|| cosine(p)).flatten());
        assert!(failure(&finding).contains("samples of 66270 fail instead of"), "{finding:?}");
    }
}
