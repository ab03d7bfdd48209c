//! Part 2: ray-box tests, building and traversing the BVH.

use super::{Cause, causes};

causes! {
    PLANES_NOT_SWAPPED = "planes-not-swapped":
        "the two planes of an axis are not swapped where the direction is negative",
        at "the box test, where the crossings of the slabs are put together",
        fix "The smaller of an axis' two crossings is the entry, the larger the exit.";
    PARALLEL_AXES_SKIPPED = "parallel-axes-skipped":
        "an axis that the ray does not move along is skipped, wherever the ray is on it",
        at "the box test, where a component of the direction is 0",
        fix "A ray that runs beside the two planes of an axis misses the box.";
    BOX_SEGMENT_IGNORED = "box-segment-ignored":
        "the box test does not look at t_min and t_max",
        at "the box test, where the crossings of the slabs are put together",
        fix "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.";
    BOX_START_IGNORED = "box-start-ignored":
        "the box test does not look at t_min",
        at "the box test, where the crossings of the slabs are put together",
        fix "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.";
    BOX_END_IGNORED = "box-end-ignored":
        "the box test does not look at t_max",
        at "the box test, where the crossings of the slabs are put together",
        fix "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.";
    BOX_MISSED_FROM_INSIDE = "box-missed-from-inside":
        "the entry has to lie behind t_min, so that rays from inside miss",
        at "the box test, where the crossings of the slabs are put together",
        fix "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.";
    BOX_MISSED_BY_END_INSIDE = "box-missed-by-end-inside":
        "the exit has to lie before t_max, so that segments which end inside miss",
        at "the box test, where the crossings of the slabs are put together",
        fix "Hit if max(entries) ≤ min(exits), the exit is not before t_min and the entry not after t_max.";
    FLAT_BOX_MISSED = "flat-box-missed":
        "entry < exit is asked for, so that flat boxes are never hit",
        at "the box test, where the crossings of the slabs are put together",
        fix "Compare with ≤: a flat box is entered and left at the same t.";
    BOX_WITHOUT_Z = "box-without-z":
        "the box test does not look at the z axis",
        at "the box test, where the crossings of the slabs are put together",
        fix "Intersect the intervals of all three axes.";
    BOX_WITHOUT_Y = "box-without-y":
        "the box test does not look at the y axis",
        at "the box test, where the crossings of the slabs are put together",
        fix "Intersect the intervals of all three axes.";
    BOX_WITHOUT_X = "box-without-x":
        "the box test does not look at the x axis",
        at "the box test, where the crossings of the slabs are put together",
        fix "Intersect the intervals of all three axes.";
    SECOND_CHILD_SKIPPED = "second-child-skipped":
        "the second child is not visited once the first was hit",
        at "the traversal, where the children of a node are visited",
        fix "Visit both children and keep the nearer hit; `a || b` skips b.";
    HIERARCHY_NOT_USED = "hierarchy-not-used":
        "every triangle is tested: the hierarchy is not used",
        at "the traversal and the leaves",
        fix "Test the box of a node first, and only the primitives of the leaves that are reached.";
    SHADOWS_SEARCH_ON = "shadows-search-on":
        "shadow rays go on after something is hit",
        at "the any-hit query",
        fix "Return as soon as anything is hit: `a || b` is right here.";
    SEGMENT_NOT_SHORTENED = "segment-not-shortened":
        "boxes are visited though a nearer hit is known",
        at "the traversal, where the children of a node are visited",
        fix "Shorten the ray's t_max to the nearest hit so far before the next box is tested.";
    CHILDREN_UNORDERED = "children-unordered":
        "the farther child is visited first as often as the nearer one",
        at "the traversal, where the children of a node are visited",
        fix "Visit the child first whose box the ray enters first.";
    COUNTS_NOT_REAL = "counts-not-real":
        "the core counts fewer primitive tests than it has hits",
        at "the traversal, where tests are counted",
        fix "Count every call of a primitive's intersection test.";
    BOX_OF_CENTROIDS = "box-of-centroids":
        "the boxes of nodes hold the centroids of their primitives, not the primitives",
        at "the build, where the box of a node is made",
        fix "Unite the boxes of the primitives; the centroids are only for the split.";
    PRIMITIVES_LOST = "primitives-lost":
        "some primitives are in no leaf: a range ends one short",
        at "the build, where a range is handed to the children",
        fix "A range [begin, end) is cut into [begin, middle) and [middle, end).";
    SPLIT_REPEATED = "split-repeated":
        "a split that separates nothing is made again and again",
        at "the build, where a node is divided",
        fix "If one side is empty, cut the range in half, or make a leaf.";
    Z_NEVER_SPLIT = "z-never-split":
        "nodes are never divided along z",
        at "the build, where a node is divided",
        fix "Compare the extents of all three axes.";
    SHORTEST_AXIS = "shortest-axis":
        "nodes are divided along their shortest axis",
        at "the build, where a node is divided",
        fix "Divide along the axis on which the centroids reach furthest.";
    RANGE_OVERWRITTEN = "range-overwritten":
        "the box test overwrites the segment of the ray",
        at "the traversal, where the box of a node is tested",
        fix "Hand copies of t_min and t_max to the box test; it writes where the ray enters and leaves.";
    HIT_OVERWRITTEN = "hit-overwritten":
        "a farther hit overwrites a nearer one",
        at "the loop over the primitives of a leaf",
        fix "Shorten t_max to each hit, or keep a hit only if it is nearer than the best so far.";
    LEAF_ORDER_NUMBERS = "leaf-order-numbers":
        "hits carry the number of a primitive in the order of the leaves, not in the scene",
        at "the hit, where the primitive is named",
        fix "Carry the primitive's own number through the build.";
    SHADOW_SECOND_CHILD_SKIPPED = "shadow-second-child-skipped":
        "shadow rays look into one child of a node only",
        at "the any-hit query, where the children of a node are visited",
        fix "A miss in the first child says nothing about the second: `a || b`.";
    SHADOW_END_IGNORED = "shadow-end-ignored":
        "shadow rays do not end: what lies behind t_max stops them too",
        at "the any-hit query, where the children of a node are visited",
        fix "Only what lies inside (t_min, t_max) occludes.";
    SHADOWS_HIT_BOXES = "shadows-hit-boxes":
        "shadow rays are stopped by boxes, whether or not a primitive is hit",
        at "the any-hit query, where the children of a node are visited",
        fix "A box only says that something may be hit: test the primitives of the leaf.";
    HITS_LOST = "hierarchy-loses-hits":
        "the hierarchy misses what the loop over all triangles hits",
        at "the boxes of nodes, the test against them, and what is skipped because of it",
        fix "A node's box encloses everything below it; a box may be missed only if all of it is.";
    UNBALANCED = "hierarchy-unbalanced":
        "the hierarchy is as deep as a list: the boxes that are tested grow with the number of triangles",
        at "the build, where a node is divided",
        fix "Divide so that both sides get a share of the primitives; the middle of the sorted centroids always does.";
}
