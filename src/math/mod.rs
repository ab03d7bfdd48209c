//! Mathematics that knows nothing of renderers.

pub mod frame;
mod precision;
pub mod quadrature;
pub mod rng;

pub use precision::Precision;
