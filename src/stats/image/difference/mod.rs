//! Whether two pictures differ, when each was rendered once: no seeds, no further runs.
//!
//! What takes the place of runs is the picture itself. It is cut into units of 8 by 8 pixels, and
//! the units are dealt to three stages along diagonals. The first stage chooses what to look at:
//! the cells of four sizes that stand out, and whether the picture follows the slopes of the
//! reference, which is what a displacement does. The other two confirm it, each with the spread of
//! its own units, studentised. A difference is proven if both do: the price of having looked at
//! thousands of cells is paid by that split, as in [`super::judge_image`].
//!
//! The noise of both pictures is in the spread, so neither has to be known. What has to be true is
//! that the noise of units is independent, also between the two pictures: pictures rendered with
//! one random sequence for every pixel, or denoised over more than a few pixels, break that. An
//! error that is smooth over units only widens the spread that it is held against, so a test that
//! does not know how smooth it is errs towards silence.
//!
//! Where the variance of both pictures is known, it is a second key: a difference has to stand out
//! of the known noise too; and then single pixels can be judged. Two pictures of the same thing are
//! told apart with probability 4e-10 for each pattern, and 1e-9 for the pixels.

mod pattern;
mod pixel;
mod report;
mod unit;

#[cfg(test)]
mod tests;

pub(crate) use pattern::Pattern;
pub(crate) use report::{DifferenceReport, OddCell, OddPixels, PatternReport};

use super::cells::COMPONENTS;
use crate::image::Image;
use crate::stats::plan::level::{CONFIRM_LEVEL, MISS_LEVEL};
use crate::stats::{Verdict, student_upper};
use pattern::{Cell, Choice, Score, confirm};
use unit::Units;

/// Stages that units are dealt to: one to choose, two to confirm.
const STAGES: usize = 3;

/// A cell is shown as odd where so many of all cells would be by chance.
const ODD: f64 = 0.01;

/// One picture, and how well it is known.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    pub(crate) image: &'a Image,
    /// The variance of each value of `image`, if it is known.
    pub(crate) variance: Option<&'a Image>,
    /// Half a step of each value, where the file holds whole numbers.
    pub(crate) rounding: Option<&'a Image>,
}

#[cfg(test)]
impl<'a> Sample<'a> {
    /// A picture of which nothing more is known.
    pub(crate) fn of(image: &'a Image) -> Self {
        Self { image, variance: None, rounding: None }
    }
}

/// Judges whether `picture` shows what `reference` shows. `counted` says which pixels do; all, if
/// none.
pub(crate) fn judge_difference(
    picture: Sample<'_>,
    reference: Sample<'_>,
    counted: Option<&[bool]>,
) -> DifferenceReport {
    judge_at(picture, reference, counted, CONFIRM_LEVEL)
}

/// The same with another level for each confirmation, so that tests can count false alarms.
fn judge_at(
    picture: Sample<'_>,
    reference: Sample<'_>,
    counted: Option<&[bool]>,
    level: f64,
) -> DifferenceReport {
    assert!(picture.image.same_size(reference.image), "two pictures of one size");
    let odd = pixel::impossible(picture.image, counted);
    if odd.is_none() && picture.image == reference.image {
        return DifferenceReport::of_equals();
    }
    let units = Units::new(picture, reference, counted);
    let patterns = Pattern::ALL.map(|pattern| judge_pattern(pattern, &units, level)).to_vec();
    let outliers = pixel::outliers(picture, reference, counted);
    let rejected = odd.is_some() || outliers.is_some() || patterns.iter().any(|p| p.rejects);
    let resolution = resolution(&units, level);
    DifferenceReport {
        verdict: Verdict::of_test(rejected, resolution.is_finite()),
        equal: false,
        impossible: odd,
        outliers,
        patterns,
        ratio: units.ratio(),
        resolution,
    }
}

/// Chooses by the first stage, and confirms by the other two.
fn judge_pattern(pattern: Pattern, units: &Units, level: f64) -> PatternReport {
    let cells = pattern.cells(units);
    let choices = pattern.choices(&cells);
    let scores = [1, 2].map(|stage| confirm(&cells, &choices, stage));
    let rejects = |score: &Score| score.t > student_upper(level, score.freedom);
    let rejects = !choices.is_empty() && scores.iter().all(rejects);
    let worst = choices.first();
    PatternReport {
        pattern,
        cells: cells.len(),
        worst: worst.map(|choice| cells[choice.cell].extent()),
        difference: worst.map_or(0.0, |choice| cells[choice.cell].relative(choice)),
        t: scores.map(|score| score.t.clamp(-1e9, 1e9)),
        rejects,
        odd: if rejects { odd_cells(&cells, &choices) } else { Vec::new() },
    }
}

/// The cells of light that stand out by themselves, the most extreme first.
fn odd_cells(cells: &[Cell<'_>], choices: &[Choice]) -> Vec<OddCell> {
    let tests = (cells.len() * COMPONENTS) as f64;
    let odd = |choice: &Choice| {
        let cell = &cells[choice.cell];
        let (t, p) = (choice.t.min(1e9), cell.tail(choice));
        let (component, extent) = (choice.component()?, cell.extent());
        (p * tests < ODD).then_some(OddCell { component, extent, t, p })
    };
    choices.iter().filter_map(odd).collect()
}

/// The relative error of the whole picture's luminance that both confirmations would have seen with
/// probability 1 − [`MISS_LEVEL`]; infinity where there are too few units to see anything.
fn resolution(units: &Units, level: f64) -> f64 {
    let luminance = COMPONENTS - 1;
    let cells = Pattern::Whole.cells(units);
    let Some(whole) = cells.first() else { return f64::INFINITY };
    let seen = |stage: usize| {
        let moments = whole.moments(stage, luminance);
        let error = moments.standard_error().max(whole.known_error(stage, luminance));
        let freedom = moments.count() as f64 - 1.0;
        let critical = student_upper(level, freedom);
        let spread = (1.0 + 0.5 * critical * critical / freedom).sqrt();
        let sigmas = critical + student_upper(MISS_LEVEL, freedom) * spread;
        (whole.band(stage, luminance) + sigmas * error) / whole.scale(stage, luminance)
    };
    seen(1).max(seen(2))
}
