//! Part 2: box, build, traversal.

use super::Fault;
use crate::cause::bvh;
use crate::cores::textbook::change::Change;

const BOX: &str = "bvh/ray-box-overlap-is-right";
const FLAT_BOX: &str = "bvh/flat-boxes-are-hit";
const SOUP: &str = "bvh/triangle-soup-hits-match-brute-force";
const BUILDS: &str = "bvh/builds-terminate-on-any-triangles";
const LONG: &str = "bvh/splits-follow-the-longest-axis";
const TESTS: &str = "bvh/triangle-soup-tests-per-ray-grow-slowly";
const CLOSED: &str = "bvh/closed-mesh-hits-match-brute-force";
const LAYERS: &str = "bvh/nodes-behind-a-hit-are-skipped";

/// In the order of the lecture.
pub const FAULTS: &[Fault] = &[
    Fault {
        change: Change::PlanesNotSwapped,
        name: "box-planes-not-swapped",
        part: 2,
        summary: "t0 and t1 are not swapped for negative directions",
        caught_by: BOX,
        cause: &bvh::PLANES_NOT_SWAPPED,
    },
    Fault {
        change: Change::BoxSegmentIgnored,
        name: "box-segment-ignored",
        part: 2,
        summary: "min_t and max_t are not looked at",
        caught_by: BOX,
        cause: &bvh::BOX_SEGMENT_IGNORED,
    },
    Fault {
        change: Change::BoxMissedFromInside,
        name: "box-missed-from-inside",
        part: 2,
        summary: "t0 < min_t is rejected: a ray from inside misses",
        caught_by: BOX,
        cause: &bvh::BOX_MISSED_FROM_INSIDE,
    },
    Fault {
        change: Change::BoxMissedByEndInside,
        name: "box-missed-by-end-inside",
        part: 2,
        summary: "t1 > max_t is rejected: a ray that ends inside misses",
        caught_by: BOX,
        cause: &bvh::BOX_MISSED_BY_END_INSIDE,
    },
    Fault {
        change: Change::FlatBoxMissed,
        name: "flat-box-missed",
        part: 2,
        summary: "t0 < t1 is asked for: flat boxes are missed",
        caught_by: FLAT_BOX,
        cause: &bvh::FLAT_BOX_MISSED,
    },
    Fault {
        change: Change::ParallelAxesSkipped,
        name: "parallel-axes-skipped",
        part: 2,
        summary: "an axis on which the direction is 0 is not looked at",
        caught_by: BOX,
        cause: &bvh::PARALLEL_AXES_SKIPPED,
    },
    Fault {
        change: Change::BoxWithoutZ,
        name: "box-without-z",
        part: 2,
        summary: "the z axis is left out",
        caught_by: BOX,
        cause: &bvh::BOX_WITHOUT_Z,
    },
    Fault {
        change: Change::NodeBoxOfCentroids,
        name: "node-box-of-centroids",
        part: 2,
        summary: "the node keeps the box of the centroids",
        caught_by: SOUP,
        cause: &bvh::BOX_OF_CENTROIDS,
    },
    Fault {
        change: Change::LastPrimitiveLost,
        name: "last-primitive-lost",
        part: 2,
        summary: "the range of a leaf ends one short",
        caught_by: SOUP,
        cause: &bvh::PRIMITIVES_LOST,
    },
    Fault {
        change: Change::SplitRepeated,
        name: "split-repeated",
        part: 2,
        summary: "a split that leaves one side empty is repeated (500 levels here; for ever there)",
        caught_by: BUILDS,
        cause: &bvh::SPLIT_REPEATED,
    },
    Fault {
        change: Change::NeverSplitsZ,
        name: "never-splits-z",
        part: 2,
        summary: "the loop over axes ends before z",
        caught_by: LONG,
        cause: &bvh::Z_NEVER_SPLIT,
    },
    Fault {
        change: Change::ShortestAxis,
        name: "shortest-axis",
        part: 2,
        summary: "min_element in place of max_element",
        caught_by: LONG,
        cause: &bvh::SHORTEST_AXIS,
    },
    Fault {
        change: Change::SecondChildSkipped,
        name: "second-child-skipped",
        part: 2,
        summary: "`hit = a || b`: the second child is skipped once the first was hit",
        caught_by: SOUP,
        cause: &bvh::SECOND_CHILD_SKIPPED,
    },
    Fault {
        change: Change::RangeOverwritten,
        name: "range-overwritten",
        part: 2,
        summary: "the ray's own min_t and max_t are handed to the box test, which writes to them",
        caught_by: SOUP,
        cause: &bvh::RANGE_OVERWRITTEN,
    },
    Fault {
        change: Change::HitOverwritten,
        name: "hit-overwritten",
        part: 2,
        summary: "max_t is not updated, and the last hit is kept",
        caught_by: SOUP,
        cause: &bvh::HIT_OVERWRITTEN,
    },
    Fault {
        change: Change::LeafTestsAll,
        name: "leaf-tests-everything",
        part: 2,
        summary: "a leaf loops over all primitives",
        caught_by: LAYERS,
        cause: &bvh::HIERARCHY_NOT_USED,
    },
    Fault {
        change: Change::LeafOrderNumbers,
        name: "leaf-order-numbers",
        part: 2,
        summary: "hits name the place in the leaves, not the primitive",
        caught_by: CLOSED,
        cause: &bvh::LEAF_ORDER_NUMBERS,
    },
    Fault {
        change: Change::ChildrenUnordered,
        name: "children-unordered",
        part: 2,
        summary: "the left child is always visited first",
        caught_by: LAYERS,
        cause: &bvh::CHILDREN_UNORDERED,
    },
    Fault {
        change: Change::SegmentNotShortened,
        name: "segment-not-shortened",
        part: 2,
        summary: "boxes are tested against the whole ray, whatever was hit",
        caught_by: LAYERS,
        cause: &bvh::SEGMENT_NOT_SHORTENED,
    },
    Fault {
        change: Change::ShadowSecondChildSkipped,
        name: "shadow-second-child-skipped",
        part: 2,
        summary: "any-hit returns what the first child says",
        caught_by: SOUP,
        cause: &bvh::SHADOW_SECOND_CHILD_SKIPPED,
    },
    Fault {
        change: Change::ShadowEndIgnored,
        name: "shadow-end-ignored",
        part: 2,
        summary: "any-hit does not look at max_t",
        caught_by: SOUP,
        cause: &bvh::SHADOW_END_IGNORED,
    },
    Fault {
        change: Change::ShadowsSearchOn,
        name: "shadows-search-on",
        part: 2,
        summary: "any-hit evaluates both children",
        caught_by: TESTS,
        cause: &bvh::SHADOWS_SEARCH_ON,
    },
    Fault {
        change: Change::ShadowsHitBoxes,
        name: "shadows-hit-boxes",
        part: 2,
        summary: "any-hit returns true for a leaf whose box is hit",
        caught_by: SOUP,
        cause: &bvh::SHADOWS_HIT_BOXES,
    },
];
