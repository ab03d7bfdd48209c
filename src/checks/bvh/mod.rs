//! Bounding volume hierarchies: the same hits as without one, from a build that ends, with less work.

mod builds_come_to_an_end;
mod comparison;
#[cfg(test)]
mod fake;
mod question;
mod reference;
mod same_hits_as_brute_force;
mod trial;
mod visits_few_nodes;

pub use builds_come_to_an_end::BuildsComeToAnEnd;
pub use same_hits_as_brute_force::SameHitsAsBruteForce;
pub use visits_few_nodes::VisitsFewNodes;
