//! Bounding volume hierarchies (BVHs): the same hits as without one, from a build that ends, with less work.

mod arrangement;
mod box_row;
mod builds_come_to_an_end;
pub(in crate::checks) mod comparison;
mod exact_overlap;
mod explanation;
#[cfg(test)]
pub(in crate::checks) mod fake;
mod is_faster;
mod order;
mod order_does_not_matter;
mod overlaps_box;
pub(in crate::checks) mod question;
mod random_boxes;
mod random_segments;
mod reference;
mod same_hits_as_brute_force;
mod sizes_add_up;
mod slabs;
mod tests_by_size;
mod tests_per_ray;
mod trial;
mod visits_few_nodes;

use super::checks;

checks! {
    overlaps_box::OverlapsBox,
    random_boxes::BoxesAreNeverMissed,
    same_hits_as_brute_force::SameHitsAsBruteForce,
    order_does_not_matter::OrderDoesNotMatter,
    sizes_add_up::SizesAddUp,
    builds_come_to_an_end::BuildsComeToAnEnd,
    visits_few_nodes::VisitsFewNodes,
    tests_per_ray::TestsPerRay,
    is_faster::IsFaster,
}
