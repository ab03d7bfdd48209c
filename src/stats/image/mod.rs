//! Whether pictures show the same: by the law of their noise, their 8-bit codes, or against each other; and
//! which mistake turns one into the other.

mod brightness;
mod cell_noise;
mod cells;
mod codes;
mod comparison;
mod dead_pixels;
mod difference;
mod draw;
mod lack;
pub(crate) mod misfit;
mod report;
mod screen;
mod screening;
#[cfg(test)]
mod simulation;
mod target;

pub(crate) use brightness::PARTS;
pub(crate) use cells::{Component, Extent, Scale};
pub(crate) use codes::{
    CodeReference, CodeReport, CodeSettings, Deciphered, NoiseSource, judge_codes,
};
pub use comparison::Question;
pub(crate) use comparison::{Clipped, Ends, Measured, flip_map};
pub(crate) use comparison::{CodesCompared, Comparison, Side, compare};
pub(crate) use difference::{DifferenceReport, OddCell, OddPixels, Pattern, PatternReport, Sample};
pub(crate) use draw::ImageDraw;
pub use draw::ImageEffort;
pub(crate) use report::CellScore;
pub(crate) use report::{GlobalRatio, ImageReport, Impossible, PartRatio, ScaleReport};
pub use screen::{Reference, judge_image, judge_image_pair};
