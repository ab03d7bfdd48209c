//! Part 2: box, build, traversal.

use super::faults;
use crate::cause::bvh;
use crate::contract::Ray;
use crate::cores::textbook as lesson;
use lesson::build::Builder;
use lesson::bvh::Primitive;
use lesson::slab::{intersect_box, slab};
use lesson::split::{self, Item};

const BOX: &str = "bvh/ray-box-overlap-is-right";
const FLAT_BOX: &str = "bvh/flat-boxes-are-hit";
const SOUP: &str = "bvh/triangle-soup-hits-match-brute-force";
const BUILDS: &str = "bvh/builds-terminate-on-any-triangles";
const LONG: &str = "bvh/splits-follow-the-longest-axis";
const TESTS: &str = "bvh/triangle-soup-tests-per-ray-grow-slowly";
const CLOSED: &str = "bvh/closed-mesh-hits-match-brute-force";
const LAYERS: &str = "bvh/nodes-behind-a-hit-are-skipped";

faults! { part 2;
    "box-planes-not-swapped": "t0 and t1 are not swapped for negative directions",
        fails BOX, told bvh::PLANES_NOT_SWAPPED,
        slab = |bounds, ray, axis| {
            let (enter, exit) = slab(bounds, ray, axis)?;
            Some(if ray.direction[axis] < 0.0 { (exit, enter) } else { (enter, exit) })
        };
    "box-segment-ignored": "min_t and max_t are not looked at",
        fails BOX, told bvh::BOX_SEGMENT_IGNORED,
        slabs_overlap = |enter, exit, _| enter <= exit;
    "box-missed-from-inside": "t0 < min_t is rejected: a ray from inside misses",
        fails BOX, told bvh::BOX_MISSED_FROM_INSIDE,
        slabs_overlap = |enter, exit, ray| {
            enter <= exit && enter <= ray.t_max && enter >= ray.t_min
        };
    "box-missed-by-end-inside": "t1 > max_t is rejected: a ray that ends inside misses",
        fails BOX, told bvh::BOX_MISSED_BY_END_INSIDE,
        slabs_overlap = |enter, exit, ray| enter <= exit && exit <= ray.t_max && exit >= ray.t_min;
    "flat-box-missed": "t0 < t1 is asked for: flat boxes are missed",
        fails FLAT_BOX, told bvh::FLAT_BOX_MISSED,
        slabs_overlap = |enter, exit, ray| enter < exit && enter <= ray.t_max && exit >= ray.t_min;
    "parallel-axes-skipped": "an axis on which the direction is 0 is not looked at",
        fails BOX, told bvh::PARALLEL_AXES_SKIPPED,
        slab = |bounds, ray, axis| match ray.direction[axis] == 0.0 {
            true => Some(EVERYWHERE),
            false => slab(bounds, ray, axis),
        };
    "box-without-z": "the z axis is left out",
        fails BOX, told bvh::BOX_WITHOUT_Z,
        slab = |bounds, ray, axis| match axis {
            2 => Some(EVERYWHERE),
            _ => slab(bounds, ray, axis),
        };
    "node-box-of-centroids": "the node keeps the box of the centroids",
        fails SOUP, told bvh::BOX_OF_CENTROIDS,
        node_bounds = split::centroid_bounds;
    "last-primitive-lost": "the range of a leaf ends one short",
        fails SOUP, told bvh::PRIMITIVES_LOST,
        leaf = |first, count| first..first + count.max(2) - 1;
    "split-repeated":
        "a split that leaves one side empty is repeated (500 levels here; for ever there)",
        fails BUILDS, told bvh::SPLIT_REPEATED,
        divide = divide_again_and_again;
    "never-splits-z": "the loop over axes ends before z",
        fails LONG, told bvh::Z_NEVER_SPLIT,
        longest_axis = |extent| extent.truncate().max_position(),
        compared_axes = |_| 0..2;
    "shortest-axis": "min_element in place of max_element",
        fails LONG, told bvh::SHORTEST_AXIS,
        longest_axis = |extent| extent.min_position(),
        compared_axes = |extent| extent.min_position()..extent.min_position() + 1;
    "second-child-skipped": "`hit = a || b`: the second child is skipped once the first was hit",
        fails SOUP, told bvh::SECOND_CHILD_SKIPPED,
        right_is_nearer = |_, _| false,
        is_worth_a_visit = |search, _| search.found.is_none();
    "range-overwritten":
        "the ray's own min_t and max_t are handed to the box test, which writes to them",
        fails SOUP, told bvh::RANGE_OVERWRITTEN,
        enter = |search, bounds| {
            let (enter, exit) = intersect_box(bounds, &search.segment, search.steps)?;
            (search.segment.t_min, search.segment.t_max) = (enter, exit);
            Some(enter)
        };
    "hit-overwritten": "max_t is not updated, and the last hit is kept",
        fails SOUP, told bvh::HIT_OVERWRITTEN,
        keep = |search, primitive, crossing| search.found = Some((primitive, crossing));
    "leaf-tests-everything": "a leaf loops over all primitives",
        fails LAYERS, told bvh::BVH_NOT_USED,
        tested_for_leaf = |_, primitives| 0..primitives;
    "leaf-order-numbers": "hits name the place in the leaves, not the primitive",
        fails CLOSED, told bvh::LEAF_ORDER_NUMBERS,
        in_leaf_order = |primitives, order| {
            let renumbered =
                |(number, index): (u32, &usize)| Primitive { number, ..primitives[*index] };
            (0..).zip(order).map(renumbered).collect()
        };
    "children-unordered": "the left child is always visited first",
        fails "bvh/nearer-children-are-visited-first", told bvh::CHILDREN_UNORDERED,
        right_is_nearer = |_, _| false;
    "segment-not-shortened": "boxes are tested against the whole ray, whatever was hit",
        fails LAYERS, told bvh::SEGMENT_NOT_SHORTENED,
        enter = |search, bounds| {
            intersect_box(bounds, search.ray, search.steps).map(|(enter, _)| enter)
        },
        is_worth_a_visit = |_, _| true;
    "shadow-second-child-skipped": "any-hit returns what the first child says",
        fails SOUP, told bvh::SHADOW_SECOND_CHILD_SKIPPED,
        any_below_children = |bvh, [left, _], ray, stats| bvh.any_below(left, ray, stats);
    "shadow-end-ignored": "any-hit does not look at max_t",
        fails SOUP, told bvh::SHADOW_END_IGNORED,
        any = |bvh, ray, stats| lesson::bvh::any(bvh, &Ray { t_max: f64::INFINITY, ..*ray }, stats);
    "shadow-start-ignored": "any-hit starts at 0, not at min_t",
        fails SOUP, told bvh::SHADOW_START_IGNORED,
        any = |bvh, ray, stats| lesson::bvh::any(bvh, &Ray { t_min: 0.0, ..*ray }, stats);
    "shadows-search-on": "any-hit evaluates both children",
        fails TESTS, told bvh::SHADOWS_SEARCH_ON,
        any_below_children = |bvh, [left, right], ray, stats| {
            bvh.any_below(left, ray, stats) | bvh.any_below(right, ray, stats)
        };
    "shadows-hit-boxes": "any-hit returns true for a leaf whose box is hit",
        fails SOUP, told bvh::SHADOWS_HIT_BOXES,
        any_in_leaf = |_, _, _, _| true;
}

/// A slab that every line is in.
const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// An empty child, and everything in the other, again and again. Here it comes to an end, so that
/// the process lives to tell.
fn divide_again_and_again(
    builder: &Builder<'_>,
    items: &mut [Item],
    depth: usize,
) -> Option<usize> {
    if items.len() <= builder.max_leaf_size {
        return None;
    }
    let left_count = split::partition(builder.split, items, builder.steps);
    match left_count % items.len() {
        0 => (depth < 500).then_some(0),
        left_count => Some(left_count),
    }
}
