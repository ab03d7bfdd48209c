//! Adaptive sampling.

mod sample_counts;
mod stops_where_it_should;

pub use sample_counts::SampleCounts;
pub use stops_where_it_should::StopsWhereItShould;
