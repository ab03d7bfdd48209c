//! What screen-and-confirm found out about a picture.

use super::cells::{COMPONENTS, Component, Extent, Scale};
use crate::image::Image;
use crate::stats::plan::{Doubt, Hypothesis, Judgement, Report, Stage, TestKind, Verdict};
use serde::Serialize;

/// A value that no picture has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Impossible {
    /// Neither large nor small.
    NotANumber,
    /// Beyond all numbers.
    Infinite,
    /// Below darkness.
    Negative,
}

impl Impossible {
    /// What is wrong with a value, if anything is.
    fn of(value: f32) -> Option<Self> {
        match value {
            v if v.is_nan() => Some(Self::NotANumber),
            v if v.is_infinite() => Some(Self::Infinite),
            v if v < 0.0 => Some(Self::Negative),
            _ => None,
        }
    }

    /// What is wrong with the first impossible pixel among those that count, its column and row, and how many there
    /// are.
    pub(super) fn first_in(
        image: &Image,
        counts: impl Fn(usize) -> bool,
    ) -> Option<(Self, [usize; 2], usize)> {
        let wrong = |pixel: &[f32; 3]| pixel.iter().find_map(|value| Self::of(*value));
        let pixels = image.pixels.iter().enumerate().filter(|(i, _)| counts(*i));
        let mut found = pixels.filter_map(|(i, pixel)| Some((i, wrong(pixel)?)));
        let (first, kind) = found.next()?;
        Some((kind, [first % image.width, first / image.width], 1 + found.count()))
    }
}

/// Pixels that are impossible in some run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImpossiblePixels {
    /// What is wrong with the first.
    pub(crate) kind: Impossible,
    pub(crate) x: usize,
    /// Its row, from the top.
    pub(crate) y: usize,
    /// How many there are in that run.
    pub(crate) pixels: usize,
    pub(crate) stage: Stage,
    pub(crate) run: u32,
}

/// A cell, as the screen sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellScore {
    pub(crate) scale: Scale,
    pub(crate) component: Component,
    pub(crate) extent: Extent,
    pub(crate) mean: f64,
    /// Of the reference; 0 for the difference of two renders.
    pub(crate) expected: f64,
    /// How far a correct core may be from `expected`: rounding, and the noise of the reference.
    pub(crate) band: f64,
    /// How far outside the band the mean is, in standard errors of the screen's runs.
    pub(crate) t: f64,
    /// How often a correct core would be so far off in this cell.
    pub(crate) p: f64,
}

/// A confirmation on fresh runs of the cells frozen at one scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Confirmation {
    /// How far the frozen combination of cells lies outside its band, in standard errors of these
    /// runs or of the other confirmation's, whichever are larger.
    pub(crate) t: f64,
    pub(crate) rejects: bool,
    /// Whether it rejects by its own spread and not by what is known of it: light may have been missed.
    pub(crate) may_lack_its_tail: bool,
}

/// What one scale says.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleReport {
    pub(crate) scale: Scale,
    /// How many, times components.
    pub(crate) cells: usize,
    /// The most extreme first; none inside its band.
    pub(crate) worst: Vec<CellScore>,
    /// What |t| of a cell had to exceed to be suspected.
    pub(crate) critical: f64,
    /// Both confirmations, if anything was suspected at any scale and this one has cells outside
    /// their bands.
    pub(crate) confirmations: Option<[Confirmation; 2]>,
    /// Whether both reject.
    pub(crate) rejects: bool,
}

impl ScaleReport {
    /// How many times further out than what is suspected a gross error is.
    const GROSS: f64 = 3.0;

    /// Whether runs call it too dark that may all have missed the same light.
    pub(super) fn may_lack_its_tail(&self) -> bool {
        let is_confirmed = |key: &Confirmation| key.rejects || key.may_lack_its_tail;
        !self.rejects && self.confirmations.is_some_and(|keys| keys.iter().all(is_confirmed))
    }

    /// Whether a cell is suspected.
    pub(super) fn stands_out(&self) -> bool {
        self.worst.first().is_some_and(|cell| cell.t.abs() > self.critical)
    }

    /// Takes what both confirmations say.
    pub(super) fn confirm(&mut self, confirmations: [Confirmation; 2]) {
        self.rejects = confirmations.iter().all(|confirmation| confirmation.rejects);
        self.confirmations = Some(confirmations);
    }

    /// Whether so many large cells are that far out that no light which few samples find can be what they lack.
    pub(super) fn is_gross_all_over(&self) -> bool {
        let limit = Self::GROSS * self.critical;
        let gross = self.worst.iter().filter(|cell| cell.t.abs() > limit).count();
        self.scale.is_large() && self.cells > COMPONENTS && 4 * gross > self.cells
    }

    /// Whether a large cell is so far out that few runs confirm it, whatever its light.
    pub(super) fn is_gross(&self) -> bool {
        let limit = Self::GROSS * self.critical;
        self.scale.is_large() && self.worst.first().is_some_and(|cell| cell.t.abs() > limit)
    }
}

/// Measured over expected, over the whole picture, with 99.9 % confidence. The noise of the
/// reference is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlobalRatio {
    pub(crate) component: Component,
    pub(crate) ratio: f64,
    pub(crate) interval: [f64; 2],
}

/// Measured over expected luminance of a part of the picture, counted from the top left, with 99.9 % confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartRatio {
    pub(crate) column: usize,
    pub(crate) row: usize,
    pub(crate) ratio: f64,
    pub(crate) interval: [f64; 2],
}

/// The judgement of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageReport {
    /// Pass, fail or inconclusive.
    pub verdict: Verdict,
    /// Why a suspicion that fresh runs confirm is left open, if one is.
    pub doubt: Option<Doubt>,
    /// NaN, infinity or negative light: fails without statistics.
    pub impossible: Option<ImpossiblePixels>,
    /// Column and row of pixels that stay black in every run while pixels like them do not; at most
    /// 64.
    pub dead_pixels: Vec<[usize; 2]>,
    /// From the finest to the coarsest.
    pub scales: Vec<ScaleReport>,
    /// The scale that rejects most strongly.
    pub worst_scale: Option<Scale>,
    /// How much too bright or too dark the picture is, for each component.
    pub ratios: Vec<GlobalRatio>,
    /// The same of its parts: columns and rows of [`PARTS`](super::PARTS) each.
    pub parts: Vec<PartRatio>,
    /// The smallest relative error of the whole picture's luminance that would have been caught
    /// with probability 0.999.
    pub resolution: f64,
    /// The error that had to be.
    pub detects: f64,
    /// Runs drawn.
    pub runs: u32,
    /// Mean of all runs.
    pub mean: Image,
    /// Standard error of `mean`.
    pub standard_error: Image,
}

impl ImageReport {
    /// Whether the screen suspected it, so that there were confirmations.
    pub(super) fn suspected(&self) -> bool {
        self.scales.iter().any(|scale| scale.confirmations.is_some())
    }
}

impl Report for ImageReport {
    /// The luminance of the whole picture, over that of the reference; NaN of an impossible picture.
    fn judgement(&self) -> Judgement {
        let luminance = self.ratios.iter().find(|ratio| ratio.component == Component::Luminance);
        let ratio = luminance.map_or(f64::NAN, |luminance| luminance.ratio);
        Judgement {
            interval: luminance.map(|luminance| luminance.interval),
            smallest_detectable_error: Some(self.resolution),
            doubt: self.doubt,
            hypothesis: Some(Hypothesis::new(TestKind::Picture, self.suspected())),
            ..Judgement::new(self.verdict, ratio, 1.0)
        }
    }
}
