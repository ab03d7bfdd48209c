//! `furnace`: a test bench for path tracers.

pub mod contract;
pub mod cores;
pub mod image;
pub mod math;
pub mod scene;
pub mod stats;
pub mod text;
