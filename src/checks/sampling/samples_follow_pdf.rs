//! Samples fall where the density says, by χ² on cells of the sphere; failed samples are a cell of their own.

use super::density::{Density, Law};
use super::distribution::{Distribution, DistributionEntry, Drawn};
use super::of_distributions::OfDistributions;
use crate::cause::Cause;
use crate::checks::phrase::{figure, percent};
use crate::checks::{CheckError, Context, Finding, Measure};
use crate::contract::Core;
use crate::math::quadrature::Diligence;
use crate::math::rng::{Seed, uniform};
use crate::stats::{
    CellProbabilities, CountDoubt, CountReport, CountSource, Counts, SphereCells, Stage, Verdict,
    chi_square_upper, judge_count_source,
};
use crate::text::{Count, Percent};
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::{FRAC_2_PI, TAU};

/// Rings and sectors of the upper hemisphere; all below is one ring more, or as many where samples belong there.
const CELLS: (usize, usize) = (10, 20);
/// Error of the integral over a cell that costs a test of millions of samples nothing.
const QUADRATURE: Diligence = Diligence { tolerance: 1e-7, most_evaluations: 4_000_000 };
/// A law is named if the rings fit it at this level.
const NAMED_LEVEL: f64 = 1e-4;

/// Counts of samples against the integral of the density over cells.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SamplesFollowPdf {
    distribution: DistributionEntry,
    /// The smallest error of the density, root mean square, that must be seen.
    detects: Percent,
    /// Past this the verdict is inconclusive, never a pass.
    at_most: Count,
}

impl OfDistributions for SamplesFollowPdf {
    const NAME: &'static str = "samples-follow-pdf";
    const SUMMARY: &'static str = "chi-square of samples against their density";
    type Judged = Judged;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(
        &self,
        context: &mut Context<'_>,
        distribution: &Distribution,
    ) -> Result<Self::Judged, CheckError> {
        let effort = context.effort(self.detects, self.at_most);
        let seed = context.seed.child(distribution.name());
        let mut source = Source::new(&mut *context.core, distribution, seed);
        let report = judge_count_source(&effort, &mut source)?;
        let cells = source.cells;
        let density = Density::of(context.core, distribution)?;
        Ok(Judged { name: distribution.name(), report, cells, density })
    }

    fn finding(judged: &[Self::Judged]) -> Finding {
        let samples: u64 = judged.iter().map(|judged| judged.report.samples).sum();
        let right = format!("{samples} samples fall where their densities say");
        Finding::measured(right, judged.iter().map(Judged::measure))
            .in_terms(" of a density, root mean square")
            .complaining(judged.iter().filter_map(Judged::complaint))
            .because_each(
                judged.iter().filter_map(Judged::cause),
                "predicts the counts of samples in all rings",
            )
    }
}

fn cells(distribution: &Distribution, turn: f64) -> SphereCells {
    let cells = match distribution.is_of_sphere() {
        true => SphereCells::sphere(CELLS.0, CELLS.1),
        false => SphereCells::hemisphere(CELLS.0, CELLS.1),
    };
    cells.with_kinks(distribution.kink().as_slice()).turned_by(turn)
}

/// A distribution of a core, in cells that are turned anew for each stage.
struct Source<'a> {
    core: &'a mut dyn Core,
    distribution: &'a Distribution,
    seed: Seed,
    cells: SphereCells,
    /// Whether the density of a cell integrates to 0.
    is_empty: Vec<bool>,
    /// Samples in each cell whose own density is 0.
    forbidden: Vec<u64>,
}

impl<'a> Source<'a> {
    fn new(core: &'a mut dyn Core, distribution: &'a Distribution, seed: Seed) -> Self {
        let cells = cells(distribution, 0.0);
        Self { core, distribution, seed, cells, is_empty: Vec::new(), forbidden: Vec::new() }
    }

    /// Asks for the density of samples in empty cells: quadrature misses slivers.
    fn count_forbidden(&mut self, samples: &[DVec3]) -> Result<(), CheckError> {
        let mut pdf = vec![0.0; samples.len()];
        self.distribution.pdf(self.core, samples, &mut pdf)?;
        for (direction, _) in samples.iter().zip(pdf).filter(|(_, pdf)| pdf.is_nan() || *pdf <= 0.0)
        {
            self.forbidden[self.cells.cell_of(*direction)] += 1;
        }
        Ok(())
    }
}

impl CountSource for Source<'_> {
    type Error = CheckError;

    fn expected(&mut self, stage: Stage) -> Result<CellProbabilities, CheckError> {
        let turn = TAU * uniform(&mut self.seed.child(stage).child("turn").stream());
        self.cells = cells(self.distribution, turn);
        let diligence =
            if self.distribution.is_of_sphere() { Diligence::KINKED } else { QUADRATURE };
        let probabilities = self.cells.probabilities(diligence, &mut |directions, values| {
            self.distribution.pdf(self.core, directions, values)
        })?;
        self.is_empty = probabilities.cells.iter().map(|probability| *probability == 0.0).collect();
        self.forbidden = vec![0; self.cells.len()];
        Ok(probabilities)
    }

    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts, CheckError> {
        let mut counts = self.cells.count([]);
        let mut in_empty_cells = Vec::new();
        let seed = self.seed.child(stage);
        self.distribution.draw(self.core, seed, samples, |drawn: &[Drawn]| {
            let directions = drawn.iter().map(|drawn| drawn.direction);
            let batch = self.cells.count(directions.clone());
            counts.absorbed += batch.absorbed;
            counts.cells.iter_mut().zip(batch.cells).for_each(|(all, more)| *all += more);
            let is_in_empty = |wi: &DVec3| self.is_empty[self.cells.cell_of(*wi)];
            in_empty_cells.extend(directions.flatten().filter(is_in_empty));
        })?;
        if !in_empty_cells.is_empty() {
            self.count_forbidden(&in_empty_cells)?;
        }
        Ok(counts)
    }

    fn forbidden(&self, cell: usize, _samples: u64) -> u64 {
        self.forbidden[cell]
    }
}

/// What came of one distribution.
pub struct Judged {
    name: String,
    report: CountReport,
    cells: SphereCells,
    density: Option<Density>,
}

impl Judged {
    /// X² per degree of freedom of the last stage.
    fn measure(&self) -> Measure {
        Measure::of("χ² per degree of freedom", &self.report).of_row(&self.name)
    }

    fn complaint(&self) -> Option<String> {
        match (self.report.verdict, self.report.doubt) {
            (Verdict::Pass, _) => None,
            (Verdict::Fail, _) => Some(format!("{}: {}", self.name, self.failure())),
            (_, Some(CountDoubt::QuadratureNotConverged)) => {
                Some(format!("{}: the integral of its density is not known well enough", self.name))
            }
            _ => {
                let missing = self.report.samples_missing.unwrap_or(0);
                Some(format!("{}: {missing} more samples are needed", self.name))
            }
        }
    }

    fn failure(&self) -> String {
        let report = &self.report;
        if let Some(cell) = report.improper_cell {
            return format!("the density is no number around {}", self.place(cell));
        }
        if let Some(forbidden) = report.forbidden {
            let (samples, place) = (forbidden.samples, self.place(forbidden.cell));
            return format!("{samples} samples around {place}, where the density is 0");
        }
        if self.residual_of_failures() > self.worst_residual().1 {
            let (failed, expected) = (report.absorbed_observed, figure(report.absorbed_expected));
            return format!("{failed} samples of {} fail instead of {expected}", self.drawn());
        }
        let words = format!("samples do not follow the density, {} off", percent(self.error()));
        match self.law() {
            Some(law) => format!("{words}; they are {}", law.words),
            None => format!("{words}; {}", self.worst_cell()),
        }
    }

    /// Samples of the last stage.
    fn drawn(&self) -> u64 {
        self.report.stages.last().map_or(0, |stage| stage.samples)
    }

    /// How far the number of failed samples is from what is expected, in standard deviations.
    fn residual_of_failures(&self) -> f64 {
        let expected = self.report.absorbed_expected;
        (self.report.absorbed_observed as f64 - expected).abs() / expected.max(1.0).sqrt()
    }

    /// The cell that is furthest from what is expected, and how far, in standard deviations.
    fn worst_residual(&self) -> (usize, f64) {
        let sizes = self.report.residuals.iter().map(|residual| residual.abs()).enumerate();
        sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
    }

    /// The root mean square error of the density that the statistic of the last stage stands for.
    fn error(&self) -> f64 {
        let Some(stage) = self.report.stages.last() else { return f64::NAN };
        ((stage.statistic - stage.freedom).max(0.0) / stage.samples as f64).sqrt()
    }

    /// `θ = 42°, φ = 10°`: the middle of a cell.
    fn place(&self, cell: usize) -> String {
        let ([low, high], [from, to]) = self.cells.bounds(cell);
        if low == -1.0 && high == 0.0 {
            return "the horizon and below".to_owned();
        }
        let theta = (0.5 * (low + high)).acos().to_degrees();
        let phi = (0.5 * (from + to)).to_degrees().rem_euclid(360.0);
        format!("θ = {}°, φ = {}°", figure(theta), figure(phi))
    }

    fn worst_cell(&self) -> String {
        let (cell, _) = self.worst_residual();
        let (observed, expected) = (self.report.observed[cell], figure(self.report.expected[cell]));
        format!("{observed} samples around {} instead of {expected}", self.place(cell))
    }

    /// The well-known law that the samples follow instead, if there is one.
    fn law(&self) -> Option<&'static LawOfHeights> {
        if self.cells.ring_count() > CELLS.0 + 1 {
            return None;
        }
        let sectors = self.cells.sector_count();
        let rings: Vec<u64> =
            self.report.observed.chunks(sectors).map(|ring| ring.iter().sum()).collect();
        let empty = |sector: usize| {
            self.report.observed.iter().skip(sector).step_by(sectors).all(|count| *count == 0)
        };
        if (0..sectors).any(empty) {
            return Some(&IN_PART_OF_THE_AZIMUTHS);
        }
        // The first ring is all below the horizon.
        LAWS.iter().find(|law| follows(law.below, &rings[1..]))
    }

    /// A wrong density, or else a wrong map.
    fn cause(&self) -> Option<&'static Cause> {
        let density = self.density.filter(|_| self.report.verdict == Verdict::Fail)?;
        density.mistake().or_else(|| density.mistake_of_map(self.law()?.law?))
    }
}

/// A law of heights: the share of samples below z.
struct LawOfHeights {
    words: &'static str,
    below: fn(f64) -> f64,
    /// As causes know it.
    law: Option<Law>,
}

static LAWS: &[LawOfHeights] = &[
    LawOfHeights { words: "uniform over the hemisphere", below: |z| z, law: Some(Law::Uniform) },
    LawOfHeights { words: "distributed as cos θ", below: |z| z * z, law: Some(Law::Cosine) },
    LawOfHeights { words: "distributed as cos² θ", below: |z| z * z * z, law: None },
    LawOfHeights {
        words: "uniform in the angle θ, too dense at the pole",
        below: |z| 1.0 - FRAC_2_PI * z.acos(),
        law: Some(Law::ThetaUniform),
    },
];

static IN_PART_OF_THE_AZIMUTHS: LawOfHeights = LawOfHeights {
    words: "nowhere in a part of the azimuths",
    below: |z| z,
    law: Some(Law::PartOfAzimuths),
};

/// Whether counts in rings of equal height fit a law.
fn follows(below: fn(f64) -> f64, rings: &[u64]) -> bool {
    let total = rings.iter().sum::<u64>() as f64;
    let count = rings.len() as f64;
    let edge = |ring: usize| below(ring as f64 / count);
    let term = |(ring, observed): (usize, &u64)| {
        let expected = total * (edge(ring + 1) - edge(ring));
        (*observed as f64 - expected).powi(2) / expected
    };
    let statistic: f64 = rings.iter().enumerate().map(term).sum();
    statistic <= chi_square_upper(NAMED_LEVEL, count - 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_density, drawing, interface, uniform};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use glam::DVec2;

    const SAMPLER: &str = "[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }\n\
                           detects = \"5 %\"\nat-most = \"1 M samples\"";
    const SURFACE: &str = "[expect]\ndistribution = { surface = { diffuse = 0.5 }, seen-from = [\"30 deg\"] }\n\
         detects = \"5 %\"\nat-most = \"1 M samples\"";

    fn found(text: &str, map: fn(DVec2) -> Option<DVec3>) -> Finding {
        let check: SamplesFollowPdf = check_of(text);
        judge(&check, &mut drawing(map, cosine_density))
    }

    fn statement(map: fn(DVec2) -> Option<DVec3>) -> String {
        failure(&found(SAMPLER, map)).to_owned()
    }

    #[test]
    fn samples_that_follow_their_density_pass_and_spend_of_the_budget() {
        let finding = found(SAMPLER, cosine);
        assert_passes(&finding);
        assert!(finding.hypotheses().count() > 0);
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

    #[test]
    fn one_number_used_twice_is_seen() {
        let statement = statement(|p| Some(at_height((1.0 - p.x).sqrt(), TAU * p.x)));
        assert!(statement.contains("samples do not follow the density"), "{statement}");
    }

    #[test]
    fn samples_below_the_horizon_are_named() {
        let statement = statement(|p| {
            let up = at_height((1.0 - p.x).sqrt(), TAU * p.y);
            Some(if p.x < 0.01 { -up } else { up })
        });
        assert!(statement.contains("the horizon and below, where the density is 0"), "{statement}");
    }

    /// In the middle of nothing, too small for quadrature.
    fn is_in_sliver(direction: DVec3) -> bool {
        direction.distance(DVec3::new(0.6, 0.0, -0.8)) < 1e-4
    }

    #[test]
    fn samples_in_a_sliver_that_quadrature_missed_are_not_forbidden() {
        let map = |p: DVec2| if p.x < 1e-4 { Some(DVec3::new(0.6, 0.0, -0.8)) } else { cosine(p) };
        let density = |wi| if is_in_sliver(wi) { 1.0 } else { cosine_density(wi) };
        assert_passes(&judge(&check_of::<SamplesFollowPdf>(SAMPLER), &mut drawing(map, density)));
        assert!(statement(map).contains("where the density is 0"), "{}", statement(map));
    }

    fn of_both_ways(reflected: f64) -> Finding {
        let check: SamplesFollowPdf = check_of(
            "[expect]\ndistribution = { surface = { rough-glass = { index = 1.5, roughness = 0.5 } }, \
             seen-from = [\"30 deg\"] }\ndetects = \"5 %\"\nat-most = \"1 M samples\"",
        );
        let density =
            |d: DVec3| (if d.z > 0.0 { 0.3 } else { 0.7 }) * cosine_density(d.with_z(d.z.abs()));
        judge(&check, &mut interface(reflected, density))
    }

    #[test]
    fn both_ways_are_counted_together() {
        assert_passes(&of_both_ways(0.3));
        let finding = of_both_ways(0.35);
        assert!(failure(&finding).contains("samples do not follow the density"), "{finding:?}");
    }

    #[test]
    fn samples_that_fail_without_the_density_knowing_are_seen() {
        let finding = found(SURFACE, |p| (p.x > 0.05).then(|| cosine(p)).flatten());
        assert_eq!(finding.verdict, Verdict::Fail);
        let finding = found(SURFACE, |p| (p.y * 97.0 % 1.0 > 0.2).then(|| cosine(p)).flatten());
        assert!(failure(&finding).contains("samples of 1060320 fail instead of"), "{finding:?}");
    }
}
