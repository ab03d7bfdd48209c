//! `furnace`: a test bench for path tracers.

pub mod math;
pub mod image;
pub mod stats;
pub mod scene;
pub mod contract;
pub mod cores;
