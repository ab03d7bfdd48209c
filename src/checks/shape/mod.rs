//! Rays against single primitives, and what a camera ray hits first.

mod agrees_with_exact_arithmetic;
mod degenerate_triangles;
mod exact_sphere;
mod exact_triangle;
#[cfg(test)]
mod fake;
mod far_spheres;
mod first_hits;
mod hits_primitive;
mod imitation;
mod leaves_its_surface;
mod no_ray_leaks;
mod shared_edges;

pub use agrees_with_exact_arithmetic::AgreesWithExactArithmetic;
pub use degenerate_triangles::DegenerateTriangles;
pub use far_spheres::FarSpheres;
pub use first_hits::{FirstHits, first_hits};
pub use hits_primitive::HitsPrimitive;
pub(in crate::checks) use imitation::{Answer, intersection};
pub use leaves_its_surface::LeavesItsSurface;
pub use no_ray_leaks::NoRayLeaks;
pub use shared_edges::SharedEdges;
