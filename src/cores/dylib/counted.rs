//! Ray tests that belong to the bench and count themselves, lent to foreign cores.
//!
//! A core that uses these for its traversal cannot miscount, and its hits are right whatever its own triangle routine
//! does; what is measured is its BVH alone. Plain and independent of every core: it has to be right, not fast.
//!
//! A library lives in the process of its counters and can reach them. So each is kept under a seal, and what was found
//! is kept beside how often: an answer that no counted test found is none of these tests' ([`Answers::unfounded`]). What
//! stays open is a core that looks by itself and has only what it found found again; its counts are too good.

use crate::contract::{BoxHit, CoreError, Hit, Ray, TraversalStats};
use crate::scene::{Mesh, SceneDescription, Sphere};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::hash::{BuildHasher, RandomState};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// How often each primitive was found by a test, by shape and number.
type Found = BTreeMap<(u32, u32), u64>;

/// The primitives of a scene, and how often they were tested.
#[derive(Debug)]
pub(crate) struct CountedScene {
    meshes: Vec<Mesh>,
    spheres: Vec<Sphere>,
    box_tests: Counter,
    primitive_tests: Counter,
    found: Mutex<Found>,
}

/// A number that only goes up, until it is taken.
#[derive(Debug)]
struct Counter {
    count: AtomicU64,
    /// The same number times `key`, beyond a first value that nobody knows.
    sealed: AtomicU64,
    key: u64,
    first: u64,
}

impl Counter {
    fn new() -> Self {
        let secrets = RandomState::new();
        let [key, first] = [secrets.hash_one("key") | 1, secrets.hash_one("first")];
        Self { count: AtomicU64::new(0), sealed: AtomicU64::new(first), key, first }
    }

    fn add_one(&self) {
        self.count.fetch_add(1, Ordering::Relaxed);
        self.sealed.fetch_add(self.key, Ordering::Relaxed);
    }

    /// The number since the last call, and starts anew; none if somebody else has set it.
    fn take(&self) -> Option<u64> {
        let count = self.count.swap(0, Ordering::Relaxed);
        let sealed = self.sealed.swap(self.first, Ordering::Relaxed);
        (sealed.wrapping_sub(self.first) == count.wrapping_mul(self.key)).then_some(count)
    }
}

/// What a core answers to rays.
pub(super) trait Answers {
    /// How many answers no test has found.
    fn unfounded(&self, found: &Found) -> u64;
}

impl Answers for [Hit] {
    fn unfounded(&self, found: &Found) -> u64 {
        let mut named = Found::new();
        for hit in self.iter().filter(|hit| hit.is_hit()) {
            *named.entry((hit.shape, hit.primitive)).or_default() += 1;
        }
        let beyond =
            |(name, times): (&_, &u64)| times.saturating_sub(found.get(name).copied().unwrap_or(0));
        named.iter().map(beyond).sum()
    }
}

impl Answers for [bool] {
    fn unfounded(&self, found: &Found) -> u64 {
        let occluded = self.iter().filter(|occluded| **occluded).count() as u64;
        occluded.saturating_sub(found.values().sum())
    }
}

impl CountedScene {
    pub(crate) fn new(scene: &SceneDescription) -> Self {
        Self {
            meshes: scene.meshes.clone(),
            spheres: scene.spheres.clone(),
            box_tests: Counter::new(),
            primitive_tests: Counter::new(),
            found: Mutex::default(),
        }
    }

    /// Whether any test was asked for since counts were taken.
    pub(super) fn has_counted(&self) -> bool {
        self.primitive_tests.count.load(Ordering::Relaxed) > 0
    }

    /// The tests that led to these answers, one a ray, and starts anew. Fails if they are not what was counted, or did
    /// not lead there.
    pub(super) fn take_counts<A: Answers + ?Sized>(
        &self,
        answers: &A,
        rays: usize,
    ) -> Result<TraversalStats, CoreError> {
        let found = std::mem::take(&mut *self.found.lock().unwrap_or_else(PoisonError::into_inner));
        let [boxes, primitives] = [&self.box_tests, &self.primitive_tests].map(Counter::take);
        let (Some(box_tests), Some(primitive_tests)) = (boxes, primitives) else {
            return Err(CoreError::breach(
                "the counters of the counted tests were set by somebody else",
            ));
        };
        if primitive_tests < found.values().sum() {
            return Err(CoreError::breach("the counters of the counted tests were set back"));
        }
        match answers.unfounded(&found) {
            0 => Ok(TraversalStats { rays: rays as u64, box_tests, primitive_tests }),
            unfounded => Err(CoreError::breach(format!(
                "{unfounded} of {rays} answers were found without the counted tests"
            ))),
        }
    }

    /// Tests one primitive; a shape or primitive that does not exist is never hit.
    pub(crate) fn hit_primitive(&self, shape: u32, primitive: u32, ray: &Ray) -> Option<Hit> {
        self.primitive_tests.add_one();
        let shape_index = shape as usize;
        let hit = match self.meshes.get(shape_index) {
            Some(mesh) => hit_triangle(mesh, primitive as usize, ray)?,
            None => hit_sphere(self.spheres.get(shape_index - self.meshes.len())?, ray)?,
        };
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        *found.entry((shape, primitive)).or_default() += 1;
        Some(Hit { shape, primitive, ..hit })
    }

    pub(crate) fn hit_box(&self, min: DVec3, max: DVec3, ray: &Ray) -> Option<BoxHit> {
        self.box_tests.add_one();
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
        let hit = scene.hit_primitive(0, 0, &ray).unwrap();
        assert!(scene.hit_primitive(7, 0, &ray).is_none());
        assert!(scene.hit_box(DVec3::ZERO, DVec3::ONE, &ray).is_some());
        assert!(scene.has_counted());
        let counts = scene.take_counts(&[hit][..], 1).unwrap();
        assert!(!scene.has_counted());
        assert_eq!((counts.rays, counts.box_tests, counts.primitive_tests), (1, 1, 2));
        assert_eq!(scene.take_counts(&[Hit::MISS][..0], 0), Ok(TraversalStats::default()));
    }

    fn complaint<A: Answers + ?Sized>(scene: &CountedScene, answers: &A) -> String {
        scene.take_counts(answers, 2).unwrap_err().to_string()
    }

    #[test]
    fn an_answer_that_no_test_found_is_told() {
        let (scene, ray) = (scene(), Ray::new(DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z));
        let hit = scene.hit_primitive(0, 0, &ray).unwrap();
        let told = complaint(&scene, &[hit, hit][..]);
        assert!(told.contains("1 of 2 answers were found without"), "{told}");
        assert!(complaint(&scene, &[true, false][..]).contains("1 of 2 answers"));
    }

    #[test]
    fn counters_that_were_set_are_told() {
        let (scene, ray) = (scene(), Ray::new(DVec3::new(0.2, 0.3, 1.0), DVec3::NEG_Z));
        scene.hit_primitive(0, 0, &ray).unwrap();
        scene.primitive_tests.count.store(0, Ordering::Relaxed);
        assert!(complaint(&scene, &[false][..]).contains("set by somebody else"));
        scene.hit_primitive(0, 0, &ray).unwrap();
        scene.primitive_tests.take().unwrap();
        assert!(complaint(&scene, &[false][..]).contains("were set back"));
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
