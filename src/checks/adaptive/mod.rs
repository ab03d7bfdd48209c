//! Adaptive sampling.

mod sample_counts;

pub use sample_counts::SampleCounts;
