//! What every test answers, whatever it tests: its verdict, the number it judged, and the smallest
//! error it would have caught. A row of a finding needs no more, so that a check never asks which
//! test it was.

use super::{Hypothesis, Verdict};

/// The judgement of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// Pass, fail or inconclusive.
    pub(crate) verdict: Verdict,
    /// What the core gave.
    pub(crate) measured: f64,
    /// What it should be.
    pub(crate) expected: f64,
    /// How far from `expected` is still right, in the same unit, without noise.
    pub(crate) allowed: f64,
    /// 99.9 % interval of what was measured; none without noise.
    pub(crate) interval: Option<[f64; 2]>,
    /// The smallest relative error that would have been caught with probability 0.999; none where it is
    /// not known, or infinite.
    pub(crate) smallest_detectable_error: Option<f64>,
    /// What the ledger enters; none where chance has no part in it.
    pub(crate) hypothesis: Option<Hypothesis>,
}

/// What a test found out.
pub trait Report {
    /// The number that the verdict is about.
    fn judgement(&self) -> Judgement;
}
