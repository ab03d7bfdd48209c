//! Whole images against references.

mod by_codes;
mod clues;
mod matches_as_png;
mod matches_reference;

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<matches_reference::MatchesReference>(),
    CheckKind::of::<matches_as_png::MatchesAsPng>(),
];
