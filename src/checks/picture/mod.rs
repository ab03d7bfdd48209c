//! Whole pictures.

mod clues;
mod first_hits;
mod matches_reference;

pub use first_hits::FirstHits;
pub use matches_reference::MatchesReference;
