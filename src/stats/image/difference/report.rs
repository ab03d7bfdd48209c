//! What the comparison of two single pictures found out.

use super::Pattern;
use crate::stats::image::{Extent, Impossible};
use crate::stats::plan::{Judgement, Report, Verdict};
use serde::Serialize;

/// Pixels that are wrong on their own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OddPixels {
    pub(crate) impossible: Option<Impossible>,
    /// Column of the first, or of the one farthest off.
    pub(crate) x: usize,
    /// Its row, from the top.
    pub(crate) y: usize,
    pub(crate) pixels: usize,
    /// How far the farthest is off, in standard errors; negative if too dark.
    pub(crate) sigmas: Option<f64>,
}

/// What one pattern says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PatternReport {
    pub(crate) pattern: Pattern,
    pub(crate) cells: usize,
    /// The cell that stood out most.
    pub(crate) worst: Option<Extent>,
    /// Its difference: relative to the light of the reference, or in pixels for edges.
    pub(crate) difference: f64,
    /// How far what stood out lies outside its band in either confirmation, in standard errors.
    pub(crate) t: [f64; 2],
    /// Whether both reject.
    pub(crate) rejects: bool,
    /// Where both reject: the cells that stand out by themselves.
    pub(crate) odd: Vec<OddCell>,
}

/// A cell that the first stage suspects for itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OddCell {
    /// Red, green, blue, luminance: its number.
    pub(crate) component: usize,
    pub(crate) extent: Extent,
    /// How far it lies outside its band, in standard errors.
    pub(crate) t: f64,
    /// How often it would by chance.
    pub(crate) p: f64,
}

/// The comparison of two single pictures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DifferenceReport {
    /// [`Verdict::Fail`] if they differ by proof; [`Verdict::Pass`] if not; [`Verdict::Inconclusive`]
    /// if the pictures have too few pixels to prove anything.
    pub(crate) verdict: Verdict,
    /// Whether they are equal to the last bit.
    pub(crate) equal: bool,
    /// Values that no picture has: a difference without statistics.
    pub(crate) impossible: Option<OddPixels>,
    /// Pixels that stand out of the known noise.
    pub(crate) outliers: Option<OddPixels>,
    pub(crate) patterns: Vec<PatternReport>,
    /// Luminance of the picture over that of the reference.
    pub(crate) ratio: f64,
    /// The smallest relative error of the whole picture's luminance that would have been seen with
    /// probability 0.999.
    pub(crate) resolution: f64,
}

impl DifferenceReport {
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
        let smallest_detectable_error = Some(self.resolution).filter(|error| error.is_finite());
        Judgement { smallest_detectable_error, ..Judgement::new(self.verdict, self.ratio, 1.0) }
    }
}
