//! How noisy estimates are, and how they get better with more samples.

mod error_falls_as_root_n;
mod reported_variance;
mod variance_is_known;

pub use error_falls_as_root_n::ErrorFallsAsRootN;
pub use reported_variance::ReportsItsVariance;
pub use variance_is_known::VarianceIsKnown;
