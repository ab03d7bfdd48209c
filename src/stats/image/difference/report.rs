//! What the comparison of two single pictures found out.

use super::Pattern;
use crate::stats::image::{Extent, Impossible};
use crate::stats::plan::{Judgement, Report, Verdict};
use serde::Serialize;

/// Pixels that are wrong on their own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OddPixels {
    /// What no picture has, if it is that.
    pub impossible: Option<Impossible>,
    /// Column of the first, or of the one farthest off.
    pub x: usize,
    /// Its row, from the top.
    pub y: usize,
    /// How many there are.
    pub pixels: usize,
    /// How far the farthest is off, in standard errors; negative if too dark.
    pub sigmas: Option<f64>,
}

/// What one pattern says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PatternReport {
    /// What was looked for.
    pub pattern: Pattern,
    /// Cells that were judged.
    pub cells: usize,
    /// The cell that stood out most.
    pub worst: Option<Extent>,
    /// Its difference: relative to the light of the reference, or in pixels for edges.
    pub difference: f64,
    /// How far what stood out lies outside its band in either confirmation, in standard errors.
    pub t: [f64; 2],
    /// Whether both reject.
    pub rejects: bool,
}

/// The comparison of two single pictures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DifferenceReport {
    /// [`Verdict::Fail`] if they differ by proof; [`Verdict::Pass`] if not; [`Verdict::Inconclusive`]
    /// if the pictures have too few pixels to prove anything.
    pub verdict: Verdict,
    /// Whether they are equal to the last bit.
    pub equal: bool,
    /// Values that no picture has: a difference without statistics.
    pub impossible: Option<OddPixels>,
    /// Pixels that stand out of the known noise.
    pub outliers: Option<OddPixels>,
    /// From the finest to the coarsest.
    pub patterns: Vec<PatternReport>,
    /// Luminance of the picture over that of the reference.
    pub ratio: f64,
    /// The smallest relative error of the whole picture's luminance that would have been seen with
    /// probability 0.999.
    pub resolution: f64,
}

impl DifferenceReport {
    /// Of pictures that are equal to the last bit.
    pub(super) fn of_equals() -> Self {
        Self {
            verdict: Verdict::Pass,
            equal: true,
            impossible: None,
            outliers: None,
            patterns: Vec::new(),
            ratio: 1.0,
            resolution: 0.0,
        }
    }
}

impl Report for DifferenceReport {
    /// The luminance of the whole picture, over that of the reference. No ledger: nothing is told
    /// apart but two files.
    fn judgement(&self) -> Judgement {
        Judgement {
            verdict: self.verdict,
            measured: self.ratio,
            expected: 1.0,
            allowed: 0.0,
            interval: None,
            smallest_detectable_error: Some(self.resolution).filter(|error| error.is_finite()),
            hypothesis: None,
        }
    }
}
