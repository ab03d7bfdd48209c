//! What every test answers, whatever it tests: its verdict, the number it judged, and the smallest
//! error it would have caught. A row of a finding needs no more, so that a check never asks which
//! test it was.

use super::{Hypothesis, Verdict};
use crate::text::spoken;
use serde::{Deserialize, Serialize};

/// The judgement of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    pub(crate) verdict: Verdict,
    pub(crate) measured: f64,
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
    /// The probability that chance alone brings the first stage as far from `expected`, or further, tolerance not
    /// counted: uniform over right cores. None where the test knows no such law.
    pub(crate) p_value: Option<f64>,
    /// Why there is no verdict, where it is not that more samples are needed.
    pub(crate) doubt: Option<Doubt>,
}

spoken! {
    /// Why a test cannot decide, however many samples there are.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Doubt {
        /// The variance may be infinite, or rests on events that have hardly been seen.
        HeavyTail = "a few samples carry the light, too few to say that it is too dark",
        /// The error of a picture rests on a few of its pixels.
        FewCarryTheError = "a few samples carry the light, too few to say how the error falls",
        /// Pictures of any number of samples are right.
        NoError = "pictures are right however few their samples: without noise there is no error to fall",
        /// So spiked a function that its quadrature would take a large error for rounding.
        Spiked = "not known well enough: its spikes are too narrow for the quadrature",
    }
}

impl Judgement {
    /// Without room, noise or chance: what a test knows of those is put in their place.
    pub(in crate::stats) const fn new(verdict: Verdict, measured: f64, expected: f64) -> Self {
        Self {
            verdict,
            measured,
            expected,
            allowed: 0.0,
            interval: None,
            smallest_detectable_error: None,
            hypothesis: None,
            p_value: None,
            doubt: None,
        }
    }
}

/// What a test found out.
pub trait Report {
    /// The number that the verdict is about.
    fn judgement(&self) -> Judgement;
}
