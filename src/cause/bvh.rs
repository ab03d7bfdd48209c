//! Part 2: building and walking the hierarchy.

use super::Cause;

/// See its headline.
pub static SECOND_CHILD_SKIPPED: Cause = Cause {
    name: "second-child-skipped",
    headline: "the second child is not visited once the first was hit",
    look_at: "the traversal, where the children of a node are visited",
    remedy: "Visit both children and keep the nearer hit; `a || b` skips b.",
};

/// See its headline.
pub static HIERARCHY_NOT_USED: Cause = Cause {
    name: "hierarchy-not-used",
    headline: "every triangle is tested: the hierarchy is not used",
    look_at: "the traversal and the leaves",
    remedy: "Test the box of a node first, and only the primitives of the leaves that are reached.",
};

/// See its headline.
pub static SHADOWS_SEARCH_ON: Cause = Cause {
    name: "shadows-search-on",
    headline: "shadow rays go on after something is hit",
    look_at: "the any-hit query",
    remedy: "Return as soon as anything is hit: `a || b` is right here.",
};

/// See its headline.
pub static SEGMENT_NOT_SHORTENED: Cause = Cause {
    name: "segment-not-shortened",
    headline: "boxes are visited though a nearer hit is known",
    look_at: "the traversal, where the children of a node are visited",
    remedy: "Shorten the ray's t_max to the nearest hit so far before the next box is tested.",
};

/// See its headline.
pub static CHILDREN_UNORDERED: Cause = Cause {
    name: "children-unordered",
    headline: "the farther child is visited first as often as the nearer one",
    look_at: "the traversal, where the children of a node are visited",
    remedy: "Visit the child first whose box the ray enters first.",
};

/// See its headline.
pub static COUNTS_NOT_REAL: Cause = Cause {
    name: "counts-not-real",
    headline: "the core counts fewer primitive tests than it has hits",
    look_at: "the traversal, where tests are counted",
    remedy: "Count every call of a primitive's intersection test.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &SECOND_CHILD_SKIPPED,
    &HIERARCHY_NOT_USED,
    &SHADOWS_SEARCH_ON,
    &SEGMENT_NOT_SHORTENED,
    &CHILDREN_UNORDERED,
    &COUNTS_NOT_REAL,
];
