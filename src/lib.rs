//! `furnace`: a test bench for path tracers.

pub mod agreement;
pub mod case;
pub mod cause;
pub mod checks;
pub mod cli;
pub mod contract;
pub mod cores;
pub mod diagnosis;
pub mod disk;
pub mod faults;
pub mod image;
pub mod math;
pub mod project;
pub mod reference;
pub mod report;
pub mod run;
pub mod scene;
pub mod stats;
pub mod text;
pub mod worker;
