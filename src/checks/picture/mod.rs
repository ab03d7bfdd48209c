//! Whole pictures.

mod by_codes;
mod clues;
mod first_hits;
mod matches_as_png;
mod matches_reference;

pub use first_hits::{FirstHits, first_hits};
pub use matches_as_png::MatchesAsPng;
pub use matches_reference::MatchesReference;
