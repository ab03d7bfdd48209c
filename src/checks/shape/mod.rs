//! Rays against single primitives, and what a camera ray hits first.

mod agrees_with_exact_arithmetic;
mod awkward;
mod body;
mod degenerate_triangles;
mod encounter;
mod entry;
mod exact_sphere;
mod exact_triangle;
mod far_spheres;
mod first_hits;
mod hit_row;
mod hits_primitive;
mod imitation;
mod lattice;
mod leaks;
mod leaves_its_surface;
mod no_ray_leaks;
mod shared_edges;
mod sphere_range;
mod view;

pub(crate) use first_hits::first_hits;
#[cfg(test)]
pub(in crate::checks) use imitation::as_hit;
pub(in crate::checks) use imitation::{Answer, intersection};

use super::checks;

checks! {
    hits_primitive::HitsPrimitive,
    agrees_with_exact_arithmetic::AgreesWithExactArithmetic,
    far_spheres::FarSpheres,
    degenerate_triangles::DegenerateTriangles,
    leaves_its_surface::LeavesItsSurface,
    shared_edges::SharedEdges,
    no_ray_leaks::NoRayLeaks,
    first_hits::FirstHits,
}
