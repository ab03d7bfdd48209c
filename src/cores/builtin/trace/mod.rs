//! From a ray to the surface that it meets: geometry, the tree over it, and the walk through the tree.
//!
//! A [`Segment`] is a ray made ready, a [`Tracer`] walks it through a [`Tree`], and [`Geometry`] tells what is
//! found there. Nothing here knows of materials or light.

mod bounds;
mod build;
mod collapse;
mod geometry;
mod item;
mod segment;
mod simd;
mod sphere;
mod surface_area;
mod tracer;
mod traverse;
mod tree;

#[cfg(test)]
mod equivalence;

pub(crate) use build::Plan;
pub(crate) use collapse::{brute_force, build_bvh};
pub use geometry::Surface;
pub(crate) use geometry::{Geometry, clearance_of};
pub(crate) use segment::Segment;
pub(crate) use tracer::Tracer;
pub(crate) use tree::Tree;
