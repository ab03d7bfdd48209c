//! Whole images against references.

mod by_codes;
mod clues;
mod conventions;
mod matches_as_png;
mod matches_reference;
mod parts;
mod shot;
mod told;

use super::checks;

checks! {
    matches_reference::MatchesReference,
    matches_as_png::MatchesAsPng,
}
