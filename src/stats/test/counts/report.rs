//! What counting samples found out about a sampler.

use super::FEWEST_EXPECTED;
use crate::stats::law::{chi_square_upper, detectable_noncentrality, normal_upper};
use crate::stats::plan::level::{MISS_LEVEL, STAGE_LEVEL};
use crate::stats::plan::{Escalation, Judgement, Scored};
use crate::stats::{Report, Stage, TestKind, Verdict};

/// One stage of counting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CountStage {
    pub(crate) stage: Stage,
    pub(crate) samples: u64,
    /// X² = Σ (O − E)² / E over pooled cells.
    pub(crate) statistic: f64,
    /// Degrees of freedom.
    pub(crate) freedom: f64,
    /// What X² may be by chance.
    pub(crate) allowed: f64,
    /// What X² has to exceed to reject, quadrature error included.
    pub(crate) critical: f64,
    /// Probability of a larger X², were the pdf right.
    pub(crate) p_value: f64,
    /// N Σ δ²/p: how much of the statistic may be quadrature.
    pub(crate) quadrature_error: f64,
    pub(crate) rejects: bool,
}

impl CountStage {
    /// How much more counts of samples that depend on each other may vary.
    fn dependence(&self) -> f64 {
        self.allowed / chi_square_upper(STAGE_LEVEL, self.freedom)
    }
}

impl Scored for CountStage {
    fn rejects(&self) -> bool {
        self.rejects
    }

    fn samples(&self) -> u64 {
        self.samples
    }

    /// By the noncentrality that is left of the statistic without quadrature and chance, which is larger where samples
    /// depend on each other.
    fn excess(&self) -> f64 {
        let length = self.statistic.sqrt() - self.quadrature_error.sqrt();
        let seen = length.max(0.0).powi(2) / self.dependence() - self.freedom;
        seen.max(0.0) / detectable_noncentrality(self.freedom, STAGE_LEVEL, MISS_LEVEL)
    }
}

/// Samples where there should be none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ForbiddenSamples {
    /// The cell of most of them.
    pub(crate) cell: usize,
    pub(crate) samples: u64,
}

/// Why counts prove nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CountDoubt {
    /// The integral of the pdf over the cells is not known well enough.
    QuadratureNotConverged,
    /// An error of the promised size could have hidden in the noise.
    TooFewSamples,
}

/// The judgement of a sampler against its pdf. Counts are those of the largest stage, the last of equals, or of the one
/// with forbidden samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CountReport {
    pub(crate) verdict: Verdict,
    /// Why it is inconclusive.
    pub(crate) doubt: Option<CountDoubt>,
    pub(crate) stages: Escalation<CountStage>,
    pub(crate) forbidden: Option<ForbiddenSamples>,
    /// A cell whose probability is negative or not a number.
    pub(crate) improper_cell: Option<usize>,
    /// The smallest root-mean-square relative error of the pdf (weighted by the expectation)
    /// that would have been caught with probability 0.999.
    pub(crate) resolution: f64,
    /// The error that had to be.
    pub(crate) detects: f64,
    /// Samples in all stages.
    pub(crate) samples: u64,
    /// What the first stage lacks, if more samples would help.
    pub(crate) samples_missing: Option<u64>,
    pub(crate) observed: Vec<u64>,
    pub(crate) expected: Vec<f64>,
    /// (O − E)/√E of each cell, for pictures.
    pub(crate) residuals: Vec<f64>,
    /// Samples that failed, counted.
    pub(crate) absorbed_observed: u64,
    /// Samples that should have failed.
    pub(crate) absorbed_expected: f64,
    /// The integral of the pdf over all cells.
    pub(crate) mass: f64,
}

impl CountReport {
    /// The stage that the counts are of.
    pub(crate) fn counted(&self) -> Option<&CountStage> {
        let total = self.observed.iter().sum::<u64>() + self.absorbed_observed;
        self.stages.iter().rev().find(|stage| stage.samples == total)
    }

    /// The cells that chance does not explain, each for itself, at the level of a stage shared by all cells: where the
    /// pdf is off. None unless all of them together are rejected.
    pub(crate) fn rejected_cells(&self) -> Vec<usize> {
        let Some(counted) = self.counted().filter(|_| self.verdict == Verdict::Fail) else {
            return Vec::new();
        };
        let dependence = counted.dependence();
        let critical = normal_upper(STAGE_LEVEL / (2 * self.observed.len()) as f64);
        let is_far = |cell: usize| {
            // A cell with few samples is no more certain than one of a pool.
            let variance = dependence * self.expected[cell].max(FEWEST_EXPECTED);
            let difference = self.observed[cell] as f64 - self.expected[cell];
            difference.is_nan() || difference.abs() > critical * variance.sqrt()
        };
        let is_known = |cell| {
            let forbidden = self.forbidden.is_some_and(|forbidden| forbidden.cell == cell);
            forbidden || self.improper_cell == Some(cell)
        };
        (0..self.observed.len()).filter(|cell| is_far(*cell) || is_known(*cell)).collect()
    }
}

impl Report for CountReport {
    /// X² per degree of freedom, of the stage that counts.
    fn judgement(&self) -> Judgement {
        let counted = self.counted();
        let per_freedom = |value: fn(&CountStage) -> f64| {
            counted.map_or(f64::NAN, |s| value(s) / s.freedom.max(1.0))
        };
        Judgement {
            allowed: per_freedom(|stage| stage.critical) - 1.0,
            smallest_detectable_error: Some(self.resolution),
            hypothesis: Some(self.stages.hypothesis(TestKind::Counts)),
            // Samples that depend on each other have another law.
            p_value: self
                .stages
                .first()
                .filter(|first| first.dependence() <= 1.0)
                .map(|s| s.p_value),
            ..Judgement::new(self.verdict, per_freedom(|stage| stage.statistic), 1.0)
        }
    }
}
