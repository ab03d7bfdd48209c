//! Triangles tested a ray in meshes of several sizes, and what the counts look like.

use super::question::scene_of;
use super::reference::{ReferenceBvh, Walk};
use crate::cause::{Cause, bvh};
use crate::checks::{CheckError, Context};
use crate::contract::{Acceleration, Hit, Ray};
use crate::math::rng::{Seed, in_cube};
use crate::math::sphere::on_sphere;
use crate::scene::{Aabb, Mesh};
use glam::DVec3;

/// Shadow rays may test this many times the triangles that closest hits test: they can stop earlier.
pub(super) const ANY_HIT_SLACK: f64 = 1.2;

/// Growth that is no better than the loop's.
pub(super) const ALL_TESTED: f64 = 0.9;

/// Counts this close, relative, are those of the same walk.
const SAME_WALK: f64 = 0.1;

/// From a sphere around the mesh at the inner four fifths of its box.
pub(super) fn rays_at(mesh: &Mesh, count: usize, seed: Seed) -> Vec<Ray> {
    let stream = &mut seed.child("rays").stream();
    let bounds = Aabb::around(mesh.positions.iter().copied());
    let Aabb { min, max } = bounds.unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ONE });
    let (middle, half) = (0.5 * (min + max), 0.5 * (max - min));
    let mut ray = || {
        let origin = middle + 3.0 * half.max_element() * on_sphere(stream);
        let within = 1.6 * in_cube(stream) - 0.8;
        Ray::new(origin, (middle + within * half - origin).normalize())
    };
    (0..count).map(|_| ray()).collect()
}

/// Triangles tested a ray, in one mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Size {
    pub(super) triangles: f64,
    pub(super) closest: f64,
    pub(super) any: f64,
    /// Boxes tested a ray; 0 if the core does not count them.
    pub(super) boxes: f64,
    pub(super) hits: f64,
    /// The plain BVH's, for each way to walk.
    pub(super) ordered: f64,
    pub(super) unordered: f64,
    pub(super) unshortened: f64,
}

pub(super) fn measure_size(
    context: &mut Context<'_>,
    mesh: Mesh,
    rays: &[Ray],
) -> Result<Size, CheckError> {
    let reference = ReferenceBvh::new(&mesh);
    let triangles = mesh.indices.len() as f64;
    let scene = scene_of(mesh);
    let mut built = context.core.build_scene(&scene, Acceleration::COUNTED)?;
    let (mut hits, mut occluded) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
    let closest = built.intersect(rays, &mut hits)?;
    let any = built.occluded(rays, &mut occluded)?;
    let per_ray = |tests: u64| tests as f64 / rays.len() as f64;
    Ok(Size {
        triangles,
        closest: per_ray(closest.primitive_tests),
        any: per_ray(any.primitive_tests),
        boxes: per_ray(closest.box_tests),
        hits: per_ray(hits.iter().filter(|hit| hit.is_hit()).count() as u64),
        ordered: reference.tests_per_ray(rays, Walk::Ordered),
        unordered: reference.tests_per_ray(rays, Walk::Unordered),
        unshortened: reference.tests_per_ray(rays, Walk::Unshortened),
    })
}

impl Size {
    /// Fewer tests than hits cannot be.
    pub(super) fn is_real(&self) -> bool {
        self.closest >= self.hits
    }

    /// Shadow rays test too many, and not because everything does.
    fn shadows_search_on(&self) -> bool {
        let is_plain = self.closest <= self.unordered;
        is_plain && self.any / self.closest > ANY_HIT_SLACK
    }
}

/// The slope of the least-squares line through (ln n, ln y).
pub(super) fn growth(sizes: &[Size], tests: impl Fn(&Size) -> f64) -> f64 {
    let points = || sizes.iter().map(|size| (size.triangles.ln(), tests(size).ln()));
    let count = sizes.len() as f64;
    let mean_x = points().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = points().map(|(_, y)| y).sum::<f64>() / count;
    let covariance: f64 = points().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / points().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
}

/// What the counts look like. A walk that is not the best is told of even where it passes.
pub(super) fn cause(sizes: &[Size], slope: f64, failed: bool) -> Option<&'static Cause> {
    let shadows_search = sizes.last().is_some_and(Size::shadows_search_on);
    if failed && slope >= ALL_TESTED {
        Some(&bvh::BVH_NOT_USED)
    } else if failed && is_like_a_loop(growth(sizes, |size| size.any), slope) {
        Some(&bvh::SHADOWS_WITHOUT_BVH)
    } else if failed && shadows_search {
        Some(&bvh::SHADOWS_SEARCH_ON)
    } else {
        walk_of(sizes)
    }
}

/// Whether tests of shadow rays grow rather as a loop's than as those of the tree that other rays walk: a loop that ends at
/// the first hit is a little less than linear.
fn is_like_a_loop(of_shadows: f64, of_tree: f64) -> bool {
    of_shadows >= (of_tree + 1.0) / 2.0
}

/// Which walk has the same counts at every size, if it is not the best.
fn walk_of(sizes: &[Size]) -> Option<&'static Cause> {
    let is_like = |counts: fn(&Size) -> f64| {
        sizes.iter().all(|size| (size.closest / counts(size) - 1.0).abs() <= SAME_WALK)
    };
    if is_like(|size| size.ordered) {
        None
    } else if is_like(|size| size.unshortened) {
        Some(&bvh::SEGMENT_NOT_SHORTENED)
    } else if is_like(|size| size.unordered) {
        Some(&bvh::CHILDREN_UNORDERED)
    } else {
        None
    }
}
