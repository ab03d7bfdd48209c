//! BSDFs: directions in the local shading frame, their pdfs and their weights, in single precision.

mod bsdf;
mod conductor;
mod glass;
mod microfacets;
mod rough_glass;
mod scattering;
pub(crate) mod warp;

pub(crate) use bsdf::{Bsdf, rgb};
