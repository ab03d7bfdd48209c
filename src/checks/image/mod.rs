//! Whole images against references.

mod by_codes;
mod clues;
mod matches_as_png;
mod matches_reference;

pub use matches_as_png::MatchesAsPng;
pub use matches_reference::MatchesReference;
