//! How surfaces scatter: directions in a local frame, their densities and their weights, in single precision.

mod bsdf;
mod conductor;
mod facets;
mod glass;
mod rough_glass;
mod scattering;
pub mod warp;

pub use bsdf::{Bsdf, rgb};
