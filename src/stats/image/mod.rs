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
pub(crate) mod misfit;
mod report;
mod screen;
mod screening;
#[cfg(test)]
mod simulation;
mod target;

pub use cells::{Component, Extent, Scale};
pub use codes::{CodeReference, CodeReport, CodeSettings, Deciphered, NoiseSource, judge_codes};
pub(crate) use comparison::{Clipped, Ends, Measured, flip_map};
pub use comparison::{CodesCompared, Comparison, Question, Side, compare};
pub use difference::{DifferenceReport, OddPixels, Pattern, PatternReport, Sample};
pub use draw::{ImageDraw, ImageEffort};
pub(crate) use report::CellScore;
pub use report::{GlobalRatio, ImageReport, Impossible, ScaleReport};
pub use screen::{Reference, judge_image, judge_image_pair};
