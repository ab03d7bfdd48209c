//! How estimates get better with more samples.

mod error_falls_as_root_n;

pub use error_falls_as_root_n::ErrorFallsAsRootN;
