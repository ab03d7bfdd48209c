//! Part 2: building and walking the hierarchy.

use super::Cause;

/// See its headline.
pub static SECOND_CHILD_SKIPPED: Cause = Cause {
    name: "second-child-skipped",
    headline: "the second child is not visited once the first was hit",
    look_at: "the traversal, where the children of a node are visited",
    remedy: "Visit both children and keep the nearer hit; `a || b` skips b.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&SECOND_CHILD_SKIPPED];
