//! Mathematics that knows nothing of renderers.

mod precision;
pub mod rng;

pub use precision::Precision;
