//! Adaptive sampling.

mod rule;
mod sample_counts;
mod stops_by_its_law;
mod stops_where_it_should;

pub use sample_counts::SampleCounts;
pub use stops_by_its_law::StopsByItsLaw;
pub use stops_where_it_should::StopsWhereItShould;
