//! Bounding volume hierarchies: the same hits as without one, from a build that ends, with less
//! work.

mod arrangement;
mod builds_come_to_an_end;
pub(in crate::checks) mod comparison;
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

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<overlaps_box::OverlapsBox>(),
    CheckKind::of::<random_boxes::BoxesAreNeverMissed>(),
    CheckKind::of::<same_hits_as_brute_force::SameHitsAsBruteForce>(),
    CheckKind::of::<order_does_not_matter::OrderDoesNotMatter>(),
    CheckKind::of::<sizes_add_up::SizesAddUp>(),
    CheckKind::of::<builds_come_to_an_end::BuildsComeToAnEnd>(),
    CheckKind::of::<visits_few_nodes::VisitsFewNodes>(),
    CheckKind::of::<tests_per_ray::TestsPerRay>(),
    CheckKind::of::<is_faster::IsFaster>(),
];
