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

/// See its headline.
pub static BOX_OF_CENTROIDS: Cause = Cause {
    name: "box-of-centroids",
    headline: "the boxes of nodes hold the centroids of their primitives, not the primitives",
    look_at: "the build, where the box of a node is made",
    remedy: "Unite the boxes of the primitives; the centroids are only for the split.",
};

/// See its headline.
pub static PRIMITIVES_LOST: Cause = Cause {
    name: "primitives-lost",
    headline: "some primitives are in no leaf: a range ends one short",
    look_at: "the build, where a range is handed to the children",
    remedy: "A range [begin, end) is cut into [begin, middle) and [middle, end).",
};

/// See its headline.
pub static SPLIT_REPEATED: Cause = Cause {
    name: "split-repeated",
    headline: "a split that separates nothing is made again and again",
    look_at: "the build, where a node is divided",
    remedy: "If one side is empty, cut the range in half, or make a leaf.",
};

/// See its headline.
pub static Z_NEVER_SPLIT: Cause = Cause {
    name: "z-never-split",
    headline: "nodes are never divided along z",
    look_at: "the build, where a node is divided",
    remedy: "Compare the extents of all three axes.",
};

/// See its headline.
pub static SHORTEST_AXIS: Cause = Cause {
    name: "shortest-axis",
    headline: "nodes are divided along their shortest axis",
    look_at: "the build, where a node is divided",
    remedy: "Divide along the axis on which the centroids reach furthest.",
};

/// See its headline.
pub static RANGE_OVERWRITTEN: Cause = Cause {
    name: "range-overwritten",
    headline: "the box test overwrites the segment of the ray",
    look_at: "the traversal, where the box of a node is tested",
    remedy: "Hand copies of t_min and t_max to the box test; it writes where the ray enters and leaves.",
};

/// See its headline.
pub static HIT_OVERWRITTEN: Cause = Cause {
    name: "hit-overwritten",
    headline: "a farther hit overwrites a nearer one",
    look_at: "the loop over the primitives of a leaf",
    remedy: "Shorten t_max to each hit, or keep a hit only if it is nearer than the best so far.",
};

/// See its headline.
pub static LEAF_ORDER_NUMBERS: Cause = Cause {
    name: "leaf-order-numbers",
    headline: "hits carry the number of a primitive in the order of the leaves, not in the scene",
    look_at: "the hit, where the primitive is named",
    remedy: "Carry the primitive's own number through the build.",
};

/// See its headline.
pub static SHADOW_SECOND_CHILD_SKIPPED: Cause = Cause {
    name: "shadow-second-child-skipped",
    headline: "shadow rays look into one child of a node only",
    look_at: "the any-hit query, where the children of a node are visited",
    remedy: "A miss in the first child says nothing about the second: `a || b`.",
};

/// See its headline.
pub static SHADOW_END_IGNORED: Cause = Cause {
    name: "shadow-end-ignored",
    headline: "shadow rays do not end: what lies behind t_max stops them too",
    look_at: "the any-hit query, where the children of a node are visited",
    remedy: "Only what lies inside (t_min, t_max) occludes.",
};

/// See its headline.
pub static SHADOWS_HIT_BOXES: Cause = Cause {
    name: "shadows-hit-boxes",
    headline: "shadow rays are stopped by boxes, whether or not a primitive is hit",
    look_at: "the any-hit query, where the children of a node are visited",
    remedy: "A box only says that something may be hit: test the primitives of the leaf.",
};

/// See its headline.
pub static HITS_LOST: Cause = Cause {
    name: "hierarchy-loses-hits",
    headline: "the hierarchy misses what the loop over all triangles hits",
    look_at: "the boxes of nodes, the test against them, and what is skipped because of it",
    remedy: "A node's box encloses everything below it; a box may be missed only if all of it is.",
};

/// See its headline.
pub static UNBALANCED: Cause = Cause {
    name: "hierarchy-unbalanced",
    headline: "the hierarchy is as deep as a list: the boxes that are tested grow with the number of triangles",
    look_at: "the build, where a node is divided",
    remedy: "Divide so that both sides get a share of the primitives; the middle of the sorted centroids always does.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &SECOND_CHILD_SKIPPED,
    &HIERARCHY_NOT_USED,
    &SHADOWS_SEARCH_ON,
    &SEGMENT_NOT_SHORTENED,
    &CHILDREN_UNORDERED,
    &COUNTS_NOT_REAL,
    &BOX_OF_CENTROIDS,
    &PRIMITIVES_LOST,
    &SPLIT_REPEATED,
    &Z_NEVER_SPLIT,
    &SHORTEST_AXIS,
    &RANGE_OVERWRITTEN,
    &HIT_OVERWRITTEN,
    &LEAF_ORDER_NUMBERS,
    &SHADOW_SECOND_CHILD_SKIPPED,
    &SHADOW_END_IGNORED,
    &SHADOWS_HIT_BOXES,
    &HITS_LOST,
    &UNBALANCED,
];
