//! Whole pictures.

mod matches_reference;

pub use matches_reference::MatchesReference;
