//! Counts of samples against their pdf, in words, and the laws that samples follow instead.

use super::cell_source::CELLS;
use super::claimed_pdf::{ClaimedPdf, Law};
use crate::cause::Cause;
use crate::checks::Measure;
use crate::checks::phrase::{figure, percent};
use crate::checks::series::{OneLine, Series, SphereCounts};
use crate::stats::{CountDoubt, CountReport, SphereCells, Verdict, chi_square_upper};
use crate::text::number::count;
use std::f64::consts::FRAC_2_PI;

/// A law is named if the rings fit it at this level.
const NAMED_LEVEL: f64 = 1e-4;

/// What came of one distribution.
pub(crate) struct Judged {
    pub(super) name: String,
    pub(super) report: CountReport,
    pub(super) cells: SphereCells,
    pub(super) pdf: Option<ClaimedPdf>,
}

impl Judged {
    /// X² per degree of freedom of the last stage.
    pub(super) fn measure(&self) -> Measure {
        Measure::of("χ² per degree of freedom", &self.report).of_row(&self.name)
    }

    /// Of several distributions, the one that is nearest to its limit, or the furthest beyond.
    pub(super) fn furthest(judged: &[Self]) -> Option<&Self> {
        let fails = |one: &Self| one.report.verdict == Verdict::Fail;
        let excess = |one: &Self| {
            one.report.counted().map_or(f64::NAN, |stage| stage.statistic / stage.critical)
        };
        let order =
            |a: &&Self, b: &&Self| fails(a).cmp(&fails(b)).then(excess(a).total_cmp(&excess(b)));
        judged.iter().max_by(order)
    }

    /// What was counted where.
    pub(super) fn series(&self) -> Option<Series> {
        let (report, cells) = (&self.report, &self.cells);
        let stage = report.counted()?;
        Some(Series::Directions(SphereCounts {
            of: self.name.clone(),
            rings: OneLine::rounded(cells.ring_edges().iter().copied()),
            sectors: cells.sector_count(),
            offset: cells.offset(),
            observed: report.observed.iter().copied().collect(),
            expected: OneLine::rounded(report.expected.iter().copied()),
            failed: OneLine::rounded([report.absorbed_observed as f64, report.absorbed_expected]),
            rejected: report.rejected_cells().into_iter().collect(),
            chi_square: stage.statistic,
            degrees_of_freedom: stage.freedom,
            critical: stage.critical,
        }))
    }

    pub(super) fn complaint(&self) -> Option<String> {
        match (self.report.verdict, self.report.doubt) {
            (Verdict::Pass, _) => None,
            (Verdict::Fail, _) => Some(format!("{}: {}", self.name, self.failure())),
            (_, Some(CountDoubt::QuadratureNotConverged)) => {
                Some(format!("{}: the integral of its pdf is not known well enough", self.name))
            }
            _ => {
                let unseen = percent(self.report.resolution);
                let missing = self.report.samples_missing;
                let more =
                    missing.map(|n| format!(" without {}", count(n as usize, "more sample")));
                let more = more.unwrap_or_default();
                Some(format!("{}: an error of its pdf below {unseen} goes unseen{more}", self.name))
            }
        }
    }

    pub(super) fn failure(&self) -> String {
        let report = &self.report;
        if let Some(cell) = report.improper_cell {
            return format!("the pdf is not a number around {}", self.place(cell));
        }
        if let Some(forbidden) = report.forbidden {
            let (samples, place) = (forbidden.samples, self.place(forbidden.cell));
            return format!("{samples} samples around {place}, where the pdf is 0");
        }
        if self.residual_of_failures() > self.worst_residual().1 {
            let (failed, expected) = (report.absorbed_observed, figure(report.absorbed_expected));
            return format!("{failed} samples of {} fail instead of {expected}", self.drawn());
        }
        let words = format!("samples do not follow the pdf, {} off", percent(self.error()));
        match self.law() {
            Some(law) => format!("{words}; they are {}", law.words),
            None => format!("{words}; {}", self.worst_cell()),
        }
    }

    /// Samples of the stage that was counted.
    pub(super) fn drawn(&self) -> u64 {
        self.report.counted().map_or(0, |stage| stage.samples)
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

    /// The root mean square error of the pdf that the statistic stands for.
    pub(super) fn error(&self) -> f64 {
        let Some(stage) = self.report.counted() else { return f64::NAN };
        ((stage.statistic - stage.freedom).max(0.0) / stage.samples as f64).sqrt()
    }

    /// `θ = 42°, φ = 10°`: the middle of a cell.
    pub(super) fn place(&self, cell: usize) -> String {
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
    pub(super) fn law(&self) -> Option<&'static LawOfHeights> {
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

    /// A wrong pdf, or else a wrong map.
    pub(super) fn cause(&self) -> Option<&'static Cause> {
        let pdf = self.pdf.filter(|_| self.report.verdict == Verdict::Fail)?;
        pdf.mistake().or_else(|| pdf.mistake_of_map(self.law()?.law?))
    }
}

/// A law of heights: the share of samples below z.
pub(super) struct LawOfHeights {
    pub(super) words: &'static str,
    pub(super) below: fn(f64) -> f64,
    /// As causes know it.
    pub(super) law: Option<Law>,
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
