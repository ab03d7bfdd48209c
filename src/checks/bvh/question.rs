//! What BVHs are asked: rays of every kind, and every way to build.

use crate::contract::{Acceleration, Capabilities, Hit, Ray, Split};
use crate::math::rng::{Stream, in_cube, uniform};
use crate::math::sphere::on_sphere;
use crate::scene::{Aabb, Material, Mesh, SceneDescription, Surface};
use crate::text::{Between, Several};
use glam::DVec3;

const RULES: [Split; 4] =
    [Split::Median, Split::MeanOfCentroids, Split::Midpoint, Split::SurfaceArea];

/// The most primitives a leaf may have, each tried alone.
pub(crate) type LeafSizes = Several<Between<1, 65535>>;

/// A way to build, and its name in statements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Build {
    split: Split,
    pub(crate) max_leaf_size: u32,
}

impl Build {
    /// Every split rule that the core can be asked for, with each leaf size.
    pub(crate) fn all(capabilities: Capabilities, leaf_sizes: &LeafSizes) -> Vec<Self> {
        let rules = if capabilities.contains(Capabilities::SPLIT_RULES) { &RULES[..] } else { &[] };
        let splits = [Split::CoresChoice].into_iter().chain(rules.iter().copied());
        let of = |split| leaf_sizes.iter().map(move |size| Self { split, max_leaf_size: size.0 });
        splits.flat_map(of).collect()
    }

    pub(crate) fn acceleration(self) -> Acceleration {
        Acceleration::Bvh { split: self.split, max_leaf_size: self.max_leaf_size, counted: false }
    }

    /// `split at the median, leaves of 4`
    pub(crate) fn name(self) -> String {
        let split = match self.split {
            Split::CoresChoice => "the core's own split",
            Split::Median => "split at the median",
            Split::MeanOfCentroids => "split at the mean of centroids",
            Split::Midpoint => "split at the midpoint",
            Split::SurfaceArea => "split by surface area",
        };
        format!("{split}, leaves of {}", self.max_leaf_size)
    }
}

pub(crate) fn scene_of(mesh: Mesh) -> SceneDescription {
    let white = Material {
        name: "white".into(),
        surface: Surface::Diffuse { reflectance: [0.8; 3] },
        emission: None,
    };
    SceneDescription { materials: vec![white], meshes: vec![mesh], ..SceneDescription::default() }
}

/// Half the rays cross the scene from outside, the rest start inside it, run along an axis or in a
/// plane of two. All are in general position: none is aimed at an edge.
pub(crate) fn generic_rays(bounds: Aabb, count: usize, stream: &mut Stream) -> Vec<Ray> {
    let around = with_room(bounds);
    let ray = |number: usize| match number % 6 {
        0..=2 => from_outside(bounds, stream),
        3 => Ray::new(point_in(around, stream), on_sphere(stream)),
        4 => along_axis(around, stream),
        _ => in_plane(around, stream),
    };
    (0..count).map(ray).collect()
}

/// Rays from outside at corners of triangles, where a rounding decides between neighbours.
pub(crate) fn rays_at_vertices(
    scene: &SceneDescription,
    bounds: Aabb,
    count: usize,
    stream: &mut Stream,
) -> Vec<Ray> {
    let vertices: Vec<_> = scene.meshes.iter().flat_map(|mesh| &mesh.positions).collect();
    if vertices.is_empty() {
        return Vec::new();
    }
    let ray = |_| {
        let vertex = *vertices[(uniform(stream) * vertices.len() as f64) as usize];
        let origin = from_outside(bounds, stream).origin;
        Ray::new(origin, (vertex - origin).normalize())
    };
    (0..count).map(ray).collect()
}

/// Some segment of each ray: it may begin before or behind the ray's hit, and end before or behind it.
pub(crate) fn segments(rays: &[Ray], hits: &[Hit], bounds: Aabb, stream: &mut Stream) -> Vec<Ray> {
    let size = bounds.diagonal().max(1.0);
    // Each line is asked twice, one segment after the other: what a core keeps of the first has to fit the second.
    let lines = rays.iter().zip(hits).step_by(2).flat_map(|line| [line; 2]);
    let segment = |(ray, hit): (&Ray, &Hit)| {
        let scale = if hit.is_hit() { hit.t } else { size };
        let ends = [uniform(stream), uniform(stream)].map(|share| 2.0 * scale * share);
        let starts_at_once = uniform(stream) < 0.5;
        let t_min = if starts_at_once { ray.t_min } else { ends[0].min(ends[1]) };
        Ray { t_min, t_max: ends[0].max(ends[1]), ..*ray }
    };
    lines.take(rays.len()).map(segment).collect()
}

fn point_in(bounds: Aabb, stream: &mut Stream) -> DVec3 {
    bounds.min + in_cube(stream) * (bounds.max - bounds.min)
}

/// Where `bounds` are flat, with room on both sides: whether a ray that starts in the plane of all triangles hits them
/// there is a matter of rounding.
fn with_room(bounds: Aabb) -> Aabb {
    let is_flat = bounds.min.cmpeq(bounds.max);
    let room = DVec3::select(is_flat, DVec3::splat(0.5 * bounds.diagonal().max(1.0)), DVec3::ZERO);
    Aabb { min: bounds.min - room, max: bounds.max + room }
}

fn from_outside(bounds: Aabb, stream: &mut Stream) -> Ray {
    let middle = 0.5 * (bounds.min + bounds.max);
    let origin = middle + bounds.diagonal().max(1.0) * on_sphere(stream);
    Ray::new(origin, (point_in(bounds, stream) - origin).normalize_or(DVec3::X))
}

fn axis(stream: &mut Stream) -> usize {
    (uniform(stream) * 3.0) as usize
}

/// Two components are zero, each of either sign: −0 is a number too.
fn along_axis(bounds: Aabb, stream: &mut Stream) -> Ray {
    let mut zeros = || if uniform(stream) < 0.5 { 0.0 } else { -0.0 };
    let mut direction = DVec3::new(zeros(), zeros(), zeros());
    direction[axis(stream)] = if uniform(stream) < 0.5 { 1.0 } else { -1.0 };
    Ray::new(point_in(bounds, stream) - bounds.diagonal().max(1.0) * direction, direction)
}

fn in_plane(bounds: Aabb, stream: &mut Stream) -> Ray {
    let mut direction = on_sphere(stream);
    direction[axis(stream)] = 0.0;
    let direction = direction.normalize_or(DVec3::X);
    Ray::new(point_in(bounds, stream) - bounds.diagonal().max(1.0) * direction, direction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;

    const UNIT: Aabb = Aabb { min: DVec3::ZERO, max: DVec3::ONE };

    #[test]
    fn no_ray_starts_in_the_plane_of_a_flat_scene() {
        let flat = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 0.0) };
        let rays = generic_rays(flat, 600, &mut Seed(2).stream());
        assert!(rays.iter().all(|ray| ray.origin.z != 0.0));
    }

    #[test]
    fn rules_are_asked_for_only_where_they_can_be() {
        let sizes = vec![Between(1), Between(4)].try_into().unwrap();
        assert_eq!(Build::all(Capabilities::empty(), &sizes).len(), 2);
        assert_eq!(Build::all(Capabilities::SPLIT_RULES, &sizes).len(), 10);
    }

    #[test]
    fn some_rays_run_along_an_axis_and_every_direction_is_unit() {
        let rays = generic_rays(UNIT, 600, &mut Seed(1).stream());
        let zeros = |ray: &Ray| ray.direction.to_array().iter().filter(|c| **c == 0.0).count();
        assert_eq!(rays.iter().filter(|ray| zeros(ray) == 2).count(), 100);
        assert_eq!(rays.iter().filter(|ray| zeros(ray) == 1).count(), 100);
        assert!(rays.iter().all(|ray| (ray.direction.length() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn segments_end_on_either_side_of_the_hit_and_never_before_they_begin() {
        let rays = generic_rays(UNIT, 400, &mut Seed(2).stream());
        let hits = vec![Hit { t: 1.0, primitive: 0, shape: 0, ..Hit::MISS }; rays.len()];
        let segments = segments(&rays, &hits, UNIT, &mut Seed(3).stream());
        assert!(segments.iter().all(|ray| ray.t_min <= ray.t_max));
        assert!(segments.iter().filter(|ray| ray.t_max < 1.0).count() > 50);
        assert!(segments.iter().filter(|ray| ray.t_min > 1.0).count() > 20);
    }
}
