//! Bounding volume hierarchies: the same hits as without one, from a build that ends, with less
//! work.

mod builds_come_to_an_end;
pub(in crate::checks) mod comparison;
mod divides_long_scenes;
mod explanation;
#[cfg(test)]
pub(in crate::checks) mod fake;
mod is_faster;
mod order_does_not_matter;
mod overlaps_box;
pub(in crate::checks) mod question;
mod random_boxes;
mod reference;
mod same_hits_as_brute_force;
mod sizes_add_up;
mod slabs;
mod stops_behind_hits;
mod trial;
mod visits_few_nodes;

pub use builds_come_to_an_end::BuildsComeToAnEnd;
pub use divides_long_scenes::DividesLongScenes;
pub use is_faster::IsFaster;
pub use order_does_not_matter::OrderDoesNotMatter;
pub use overlaps_box::OverlapsBox;
pub use random_boxes::BoxesAreNeverMissed;
pub use same_hits_as_brute_force::SameHitsAsBruteForce;
pub use sizes_add_up::SizesAddUp;
pub use stops_behind_hits::StopsBehindHits;
pub use visits_few_nodes::VisitsFewNodes;
