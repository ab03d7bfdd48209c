//! What counting samples found out about a sampler.

use crate::stats::plan::{Escalation, Judgement, Scored};
use crate::stats::{Report, Stage, TestKind, Verdict};

/// One stage of counting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountStage {
    /// Which stage.
    pub stage: Stage,
    /// Samples drawn.
    pub samples: u64,
    /// X² = Σ (O − E)² / E over pooled cells.
    pub statistic: f64,
    /// Degrees of freedom.
    pub freedom: f64,
    /// What X² has to exceed to reject, quadrature error included.
    pub critical: f64,
    /// Probability of a larger X², were the density right.
    pub p_value: f64,
    /// N Σ δ²/p: how much of the statistic may be quadrature.
    pub quadrature_error: f64,
    /// Whether the stage rejects.
    pub rejects: bool,
}

impl Scored for CountStage {
    fn rejects(&self) -> bool {
        self.rejects
    }
}

/// Samples where there should be none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForbiddenSamples {
    /// The cell of most of them.
    pub cell: usize,
    /// How many fell in it.
    pub samples: u64,
}

/// Why counts prove nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountDoubt {
    /// The integral of the density over the cells is not known well enough.
    QuadratureNotConverged,
    /// An error of the promised size could have hidden in the noise.
    TooFewSamples,
}

/// The judgement of a sampler against its density. Counts are those of the last stage drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct CountReport {
    /// Pass, fail or inconclusive.
    pub verdict: Verdict,
    /// Why it is inconclusive.
    pub doubt: Option<CountDoubt>,
    /// Every stage drawn; a clean sampler has one.
    pub stages: Escalation<CountStage>,
    /// Samples in cells where the density is zero.
    pub forbidden: Option<ForbiddenSamples>,
    /// A cell whose probability is negative or not a number.
    pub improper_cell: Option<usize>,
    /// The smallest root-mean-square relative error of the density (weighted by the expectation)
    /// that would have been caught with probability 0.999.
    pub resolution: f64,
    /// The error that had to be.
    pub detects: f64,
    /// Samples in all stages.
    pub samples: u64,
    /// What the first stage lacks, if more samples would help.
    pub samples_missing: Option<u64>,
    /// Counted in each cell.
    pub observed: Vec<u64>,
    /// Expected in each cell.
    pub expected: Vec<f64>,
    /// (O − E)/√E of each cell, for pictures.
    pub residuals: Vec<f64>,
    /// Samples that failed, counted.
    pub absorbed_observed: u64,
    /// Samples that should have failed.
    pub absorbed_expected: f64,
    /// The integral of the density over all cells.
    pub mass: f64,
}

impl Report for CountReport {
    /// X² per degree of freedom, of the last stage.
    fn judgement(&self) -> Judgement {
        let last = self.stages.last();
        let per_freedom = |value: fn(&CountStage) -> f64| {
            last.map_or(f64::NAN, |s| value(s) / s.freedom.max(1.0))
        };
        Judgement {
            verdict: self.verdict,
            measured: per_freedom(|stage| stage.statistic),
            expected: 1.0,
            allowed: per_freedom(|stage| stage.critical) - 1.0,
            interval: None,
            smallest_detectable_error: Some(self.resolution),
            hypothesis: Some(self.stages.hypothesis(TestKind::Counts)),
        }
    }
}
