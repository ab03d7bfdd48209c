//! Part 2: the slab test, BVH construction and traversal.

use super::{Cause, causes};

causes! {
    PLANES_NOT_SWAPPED = "planes-not-swapped":
        "the slab test does not swap the near and far planes for negative directions",
        at "the slab test, where the intervals of the axes are combined",
        fix "The smaller of an axis' two crossings is t_enter, the larger t_exit.";
    PARALLEL_AXES_SKIPPED = "parallel-axes-skipped":
        "the slab test skips axes to which the ray is perpendicular, even if its origin is outside the slab",
        at "the slab test, where a direction component is 0",
        fix "A ray parallel to a slab and outside it misses the box.";
    BOX_SEGMENT_IGNORED = "box-segment-ignored":
        "the slab test ignores t_min and t_max",
        at "the slab test, where the intervals of the axes are combined",
        fix "The box is hit if max(t_enter) ≤ min(t_exit), t_exit ≥ t_min and t_enter ≤ t_max.";
    BOX_START_IGNORED = "box-start-ignored":
        "the slab test ignores t_min",
        at "the slab test, where the intervals of the axes are combined",
        fix "The box is hit if max(t_enter) ≤ min(t_exit), t_exit ≥ t_min and t_enter ≤ t_max.";
    BOX_END_IGNORED = "box-end-ignored":
        "the slab test ignores t_max",
        at "the slab test, where the intervals of the axes are combined",
        fix "The box is hit if max(t_enter) ≤ min(t_exit), t_exit ≥ t_min and t_enter ≤ t_max.";
    BOX_MISSED_FROM_INSIDE = "box-missed-from-inside":
        "the slab test requires t_enter ≥ t_min, so rays that start inside the box miss",
        at "the slab test, where the intervals of the axes are combined",
        fix "The box is hit if max(t_enter) ≤ min(t_exit), t_exit ≥ t_min and t_enter ≤ t_max.";
    BOX_MISSED_BY_END_INSIDE = "box-missed-by-end-inside":
        "the slab test requires t_exit ≤ t_max, so rays that end inside the box miss",
        at "the slab test, where the intervals of the axes are combined",
        fix "The box is hit if max(t_enter) ≤ min(t_exit), t_exit ≥ t_min and t_enter ≤ t_max.";
    FLAT_BOX_MISSED = "flat-box-missed":
        "the slab test requires t_enter < t_exit, so flat boxes are never hit",
        at "the slab test, where the intervals of the axes are combined",
        fix "Compare with ≤: for a flat box t_enter = t_exit.";
    BOX_WITHOUT_Z = "box-without-z":
        "the slab test ignores the z axis",
        at "the slab test, where the intervals of the axes are combined",
        fix "Intersect the intervals of all three axes.";
    BOX_WITHOUT_Y = "box-without-y":
        "the slab test ignores the y axis",
        at "the slab test, where the intervals of the axes are combined",
        fix "Intersect the intervals of all three axes.";
    BOX_WITHOUT_X = "box-without-x":
        "the slab test ignores the x axis",
        at "the slab test, where the intervals of the axes are combined",
        fix "Intersect the intervals of all three axes.";
    SECOND_CHILD_SKIPPED = "second-child-skipped":
        "traversal returns a hit though a nearer one is left, as where the second child is skipped once the first is hit",
        at "BVH traversal, where the children of a node are visited",
        fix "Visit both children and keep the closer hit; `a || b` skips b.";
    BVH_NOT_USED = "bvh-not-used":
        "the BVH culls nothing: every triangle is tested",
        at "BVH traversal and its leaves",
        fix "Test a node's box first, then only the primitives of the leaves that are reached.";
    SHADOWS_SEARCH_ON = "shadows-search-on":
        "shadow rays do not stop at the first hit",
        at "the any-hit query of shadow rays",
        fix "Return as soon as anything is hit: here `a || b` is right.";
    SHADOWS_WITHOUT_BVH = "shadows-without-bvh":
        "shadow rays do not use the BVH: one primitive after the other is tested",
        at "the any-hit query of shadow rays",
        fix "Traverse the BVH as for the nearest hit, and return as soon as anything is hit.";
    SEGMENT_NOT_SHORTENED = "t-max-not-shortened":
        "traversal visits nodes behind the closest hit: it does not shorten t_max, or visits the farther child first",
        at "BVH traversal, where the children of a node are visited",
        fix "Visit the nearer child first, and set the ray's t_max to the closest hit so far before testing the next box.";
    CHILDREN_UNORDERED = "children-unordered":
        "traversal does not visit the nearer child first",
        at "BVH traversal, where the children of a node are visited",
        fix "Visit the child first whose box the ray enters first.";
    COUNTS_NOT_REAL = "counts-not-real":
        "the core reports fewer primitive tests than hits",
        at "BVH traversal, where tests are counted",
        fix "Count every call of a primitive's intersection test.";
    BOX_OF_CENTROIDS = "box-of-centroids":
        "node bounds enclose the primitives' centroids, not the primitives",
        at "BVH construction, where a node's bounds are computed",
        fix "Take the union of the primitives' bounds; centroids serve only to choose the split.";
    PRIMITIVES_LOST = "primitives-lost":
        "some primitives are in no leaf: a range ends one short",
        at "BVH construction, where a range is passed to the children",
        fix "Split a range [begin, end) into [begin, middle) and [middle, end).";
    SPLIT_REPEATED = "split-repeated":
        "splits that separate nothing recurse without end",
        at "BVH construction, where a node is split",
        fix "If one side is empty, split at the median, or make a leaf.";
    Z_NEVER_SPLIT = "z-never-split":
        "z is never the splitting axis",
        at "BVH construction, where a node is split",
        fix "Compare the extents of all three axes.";
    SHORTEST_AXIS = "shortest-axis":
        "the splitting axis is the shortest axis, not the longest",
        at "BVH construction, where a node is split",
        fix "Split along the axis with the largest extent of centroids.";
    RANGE_OVERWRITTEN = "t-range-overwritten":
        "the nearest-hit traversal loses hits that shadow rays find, as where the slab test overwrites the ray's t_min and t_max",
        at "BVH traversal, where a node's box is tested",
        fix "Pass copies of t_min and t_max to the slab test: it writes t_enter and t_exit into them.";
    HIT_OVERWRITTEN = "hit-overwritten":
        "a farther hit overwrites a closer one",
        at "the loop over the primitives of a leaf, or the test of a primitive, where it sets t_max",
        fix "Set t_max to each hit, or keep a hit only if it is closer than the best so far.";
    LEAF_ORDER_NUMBERS = "leaf-order-numbers":
        "hits report the primitive's index in leaf order, not in the scene",
        at "the intersection record, where the primitive is identified",
        fix "Keep each primitive's own index through BVH construction.";
    SHADOW_SECOND_CHILD_SKIPPED = "shadow-second-child-skipped":
        "shadow rays miss what other rays hit, as where they visit only one child of a node",
        at "the any-hit traversal of shadow rays: which nodes and which kinds of shapes it visits",
        fix "Visit all that a nearest hit visits until one is hit: a miss in the first child (`a || b`), or of one kind of shape, says nothing about the rest.";
    SHADOW_END_IGNORED = "shadow-end-ignored":
        "shadow rays ignore t_max: surfaces behind their end occlude",
        at "the any-hit traversal of shadow rays, where the children of a node are visited",
        fix "Only hits inside (t_min, t_max) occlude.";
    SHADOW_START_IGNORED = "shadow-start-ignored":
        "shadow rays ignore t_min: surfaces before their start occlude",
        at "the any-hit traversal of shadow rays, where t_min goes to boxes and primitives",
        fix "Only hits inside (t_min, t_max) occlude.";
    SHADOWS_HIT_BOXES = "shadows-hit-boxes":
        "shadow rays count a hit bounding box as an occluder",
        at "the any-hit traversal of shadow rays, where the children of a node are visited",
        fix "A hit box only says that something may be hit: test the primitives of the leaf.";
    HITS_LOST = "bvh-loses-hits":
        "BVH traversal misses primitives that brute force hits",
        at "node bounds, the slab test, and the subtrees it skips",
        fix "A node's bounds enclose everything below it; skip a subtree only if the ray misses all of them.";
    UNBALANCED = "bvh-unbalanced":
        "the BVH degenerates into a list: box tests per ray grow linearly with the number of triangles",
        at "BVH construction, where a node is split",
        fix "Both sides of a split need their share of the primitives; a median split always gives it.";
    RECURSION_ENDLESS = "bvh-recursion-endless":
        "BVH construction recurses without end and overflows the stack, as where centroids are equal",
        at "BVH construction, where primitives are divided between two children",
        fix "If one side of a split is empty, divide the list in the middle, or make a leaf.";
    ANY_HIT_CRASHES = "any-hit-crashes":
        "the any-hit function of shadow rays crashes, the nearest-hit function does not",
        at "the any-hit functions of shadow rays, that of the BVH and those of the shapes",
        fix "A leaf without a hit returns: it has no children. A shape's hit record has to be there before it is written.";
}
