//! Mathematics that knows nothing of renderers.

pub mod rng;
