//! Mathematics that knows nothing of renderers.

pub mod closed_form;
pub(crate) mod frame;
pub(crate) mod harmonics;
mod precision;
pub mod quadrature;
pub mod ratios;
pub mod rng;
pub mod sphere;

pub use precision::Precision;
