//! Ray tests that belong to the bench and count themselves, lent to foreign cores.
//!
//! A core that uses these for its traversal cannot miscount, and its hits are right whatever its own triangle routine
//! does; what is measured is its BVH alone. Plain and independent of every core: it has to be right, not fast.

use crate::contract::{BoxHit, Hit, Ray, TraversalStats};
use crate::scene::{Mesh, SceneDescription, Sphere};
use glam::{DVec2, DVec3};
use std::sync::atomic::{AtomicU64, Ordering};

/// The primitives of a scene, and how often they were tested.
#[derive(Debug)]
pub(crate) struct CountedScene {
    meshes: Vec<Mesh>,
    spheres: Vec<Sphere>,
    box_tests: AtomicU64,
    primitive_tests: AtomicU64,
}

impl CountedScene {
    pub(crate) fn new(scene: &SceneDescription) -> Self {
        Self {
            meshes: scene.meshes.clone(),
            spheres: scene.spheres.clone(),
            box_tests: AtomicU64::new(0),
            primitive_tests: AtomicU64::new(0),
        }
    }

    /// The tests since the last call, and starts anew.
    pub(crate) fn take_counts(&self, rays: u64) -> TraversalStats {
        TraversalStats {
            rays,
            box_tests: self.box_tests.swap(0, Ordering::Relaxed),
            primitive_tests: self.primitive_tests.swap(0, Ordering::Relaxed),
        }
    }

    /// Tests one primitive; a shape or primitive that does not exist is never hit.
    pub(crate) fn hit_primitive(&self, shape: u32, primitive: u32, ray: &Ray) -> Option<Hit> {
        self.primitive_tests.fetch_add(1, Ordering::Relaxed);
        let shape_index = shape as usize;
        let hit = match self.meshes.get(shape_index) {
            Some(mesh) => hit_triangle(mesh, primitive as usize, ray)?,
            None => hit_sphere(self.spheres.get(shape_index - self.meshes.len())?, ray)?,
        };
        Some(Hit { shape, primitive, ..hit })
    }

    pub(crate) fn hit_box(&self, min: DVec3, max: DVec3, ray: &Ray) -> Option<BoxHit> {
        self.box_tests.fetch_add(1, Ordering::Relaxed);
        let (mut t_enter, mut t_exit) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (enter, exit) = slab(min[axis], max[axis], ray.origin[axis], ray.direction[axis])?;
            t_enter = t_enter.max(enter);
            t_exit = t_exit.min(exit);
        }
        let overlaps = t_enter <= t_exit && t_enter <= ray.t_max && t_exit >= ray.t_min;
        overlaps.then_some(BoxHit { t_enter, t_exit, hit: 1, reserved: 0 })
    }
}

/// Where a line lies between two parallel planes; along them it lies there for ever or never.
fn slab(low: f64, high: f64, origin: f64, direction: f64) -> Option<(f64, f64)> {
    if direction == 0.0 {
        return (low <= origin && origin <= high).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (a, b) = ((low - origin) / direction, (high - origin) / direction);
    Some((a.min(b), a.max(b)))
}

fn is_inside(ray: &Ray, t: f64) -> bool {
    ray.t_min < t && t < ray.t_max
}

/// Möller and Trumbore 1997, both sides; edges belong to the triangle.
fn hit_triangle(mesh: &Mesh, number: usize, ray: &Ray) -> Option<Hit> {
    let corner_indices = mesh.indices.get(number)?;
    let [a, b, c] = corner_indices.map(|index| mesh.positions[index as usize]);
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    let from_a = ray.origin - a;
    let q = from_a.cross(ab);
    let (u, v) = (from_a.dot(p) / determinant, ray.direction.dot(q) / determinant);
    let t = ac.dot(q) / determinant;
    // A determinant of zero makes infinities and NaN, which fail here.
    if !(u >= 0.0 && v >= 0.0 && u + v <= 1.0 && is_inside(ray, t)) {
        return None;
    }
    let geometric_normal = ab.cross(ac).try_normalize()?;
    let shading_normal = if mesh.normals.is_empty() {
        geometric_normal
    } else {
        let [na, nb, nc] = corner_indices.map(|index| mesh.normals[index as usize]);
        ((1.0 - u - v) * na + u * nb + v * nc).normalize_or(geometric_normal)
    };
    Some(Hit { t, geometric_normal, shading_normal, uv: DVec2::new(u, v), ..Hit::MISS })
}

/// The nearer crossing inside the segment.
fn hit_sphere(sphere: &Sphere, ray: &Ray) -> Option<Hit> {
    let from_centre = ray.origin - sphere.centre;
    let a = ray.direction.length_squared();
    let half_b = from_centre.dot(ray.direction);
    let nearest = from_centre - half_b / a * ray.direction;
    let discriminant = a * (sphere.radius * sphere.radius - nearest.length_squared());
    (discriminant >= 0.0).then_some(())?;
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    let c = from_centre.length_squared() - sphere.radius * sphere.radius;
    let (first, second) = (c / q, q / a);
    let roots = [first.min(second), first.max(second)];
    let t = roots.into_iter().find(|t| is_inside(ray, *t))?;
    let outward = (ray.at(t) - sphere.centre).normalize();
    let normal = if sphere.inward { -outward } else { outward };
    Some(Hit { t, geometric_normal: normal, shading_normal: normal, uv: DVec2::ZERO, ..Hit::MISS })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> CountedScene {
        let mesh = Mesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            indices: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let sphere = Sphere {
            name: String::new(),
            centre: DVec3::new(0.0, 0.0, -5.0),
            radius: 1.0,
            inward: true,
            material: 0,
        };
        CountedScene::new(&SceneDescription {
            meshes: vec![mesh],
            spheres: vec![sphere],
            ..SceneDescription::default()
        })
    }

    #[test]
    fn each_test_is_counted_once_and_counts_start_anew() {
        let scene = scene();
        let ray = Ray::new(DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z);
        assert!(scene.hit_primitive(0, 0, &ray).is_some());
        assert!(scene.hit_primitive(7, 0, &ray).is_none());
        assert!(scene.hit_box(DVec3::ZERO, DVec3::ONE, &ray).is_some());
        let counts = scene.take_counts(1);
        assert_eq!((counts.rays, counts.box_tests, counts.primitive_tests), (1, 1, 2));
        assert_eq!(scene.take_counts(0), TraversalStats::default());
    }

    #[test]
    fn a_triangle_is_hit_with_its_weights_and_its_own_normal() {
        let ray = Ray::new(DVec3::new(0.2, 0.3, 2.0), DVec3::NEG_Z);
        let hit = scene().hit_primitive(0, 0, &ray).unwrap();
        assert_eq!((hit.t, hit.uv, hit.shading_normal), (2.0, DVec2::new(0.2, 0.3), DVec3::Z));
    }

    #[test]
    fn an_inward_sphere_has_its_normals_inward() {
        let hit = scene().hit_primitive(1, 0, &Ray::new(DVec3::ZERO, DVec3::NEG_Z)).unwrap();
        assert_eq!((hit.t, hit.geometric_normal), (4.0, DVec3::NEG_Z));
    }

    #[test]
    fn a_ray_in_the_plane_of_a_triangle_misses_it() {
        let ray = Ray::new(DVec3::NEG_X, DVec3::X);
        assert!(scene().hit_primitive(0, 0, &ray).is_none());
    }
}
