//! Rays against single primitives, and what a camera ray hits first.

mod agrees_with_exact_arithmetic;
mod awkward;
mod body;
mod degenerate_triangles;
mod encounter;
mod exact_sphere;
mod exact_triangle;
mod far_spheres;
mod first_hits;
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

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<hits_primitive::HitsPrimitive>(),
    CheckKind::of::<agrees_with_exact_arithmetic::AgreesWithExactArithmetic>(),
    CheckKind::of::<far_spheres::FarSpheres>(),
    CheckKind::of::<degenerate_triangles::DegenerateTriangles>(),
    CheckKind::of::<leaves_its_surface::LeavesItsSurface>(),
    CheckKind::of::<shared_edges::SharedEdges>(),
    CheckKind::of::<no_ray_leaks::NoRayLeaks>(),
    CheckKind::of::<first_hits::FirstHits>(),
];
