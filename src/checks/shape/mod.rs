//! Rays against single primitives and boxes.

mod agrees_with_exact_arithmetic;
mod degenerate_triangles;
mod exact_sphere;
mod exact_triangle;
#[cfg(test)]
mod fake;
mod far_spheres;
mod hits_primitive;
mod imitation;
mod leaves_its_surface;
mod overlaps_box;
mod random_boxes;
mod shared_edges;
mod slabs;

pub use agrees_with_exact_arithmetic::AgreesWithExactArithmetic;
pub use degenerate_triangles::DegenerateTriangles;
pub use far_spheres::FarSpheres;
pub use hits_primitive::HitsPrimitive;
pub(in crate::checks) use imitation::{Answer, intersection};
pub use leaves_its_surface::LeavesItsSurface;
pub use overlaps_box::OverlapsBox;
pub use random_boxes::BoxesAreNeverMissed;
pub use shared_edges::SharedEdges;
