//! One scene, with and without a BVH: what both checks of hits share.

use super::comparison::{Differences, Questions, Truth, closest_hits, compare};
use super::explanation::explain;
use super::question::{Build, generic_rays, rays_at_vertices, segments};
use crate::cause::Cause;
use crate::checks::{CheckError, Context, oracle};
use crate::contract::{Acceleration, BuildStats, BuiltScene, Hit, Ray};
use crate::math::rng::Seed;
use crate::scene::{Aabb, SceneDescription, Shape};
use glam::DVec3;

/// How far from its primitive a hit may lie, relative to the coordinates: a hundred roundings of single precision.
const ON_PRIMITIVE: f64 = 1e-5;

/// Rays by which brute force itself is tried: a mistake there shows in many of them.
const OVERWRITTEN_RAYS: usize = 500;

/// A scene, what is asked of it, and what brute force says.
pub struct Trial<'a> {
    scene: &'a SceneDescription,
    graded: (Questions, Truth),
    /// Rays at vertices: whether they are hit is a matter of rounding, also in a box.
    shown: (Questions, Truth),
}

pub struct Tried {
    pub build: Build,
    pub stats: BuildStats,
    pub differences: Differences,
    pub at_vertices: Differences,
    /// The mistake that makes such differences.
    pub cause: Option<&'static Cause>,
}

impl<'a> Trial<'a> {
    /// Asks brute force: `count` rays in general position, as many segments, and a quarter of that at vertices.
    pub(crate) fn prepare(
        context: &mut Context<'_>,
        scene: &'a SceneDescription,
        count: usize,
        seed: Seed,
    ) -> Result<Self, CheckError> {
        // An empty scene is asked about the unit cube.
        let bounds = scene.bounds().unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ONE });
        let stream = |purpose: &str| seed.child(purpose).stream();
        let generic = generic_rays(bounds, count, &mut stream("generic"));
        let at_vertices = rays_at_vertices(scene, bounds, count / 4, &mut stream("vertices"));
        let mut brute = context.core.build_scene(scene, Acceleration::BruteForce)?;
        let mut ask = |rays, purpose| {
            Self::ask_brute_force(brute.as_mut(), rays, bounds, seed.child(purpose))
        };
        Ok(Self {
            scene,
            graded: ask(generic, "segments")?,
            shown: ask(at_vertices, "segments at vertices")?,
        })
    }

    fn ask_brute_force(
        brute: &mut dyn BuiltScene,
        rays: Vec<Ray>,
        bounds: Aabb,
        seed: Seed,
    ) -> Result<(Questions, Truth), CheckError> {
        let hits = closest_hits(brute, &rays)?;
        let segments = segments(&rays, &hits, bounds, &mut seed.stream());
        let mut occluded = |changed: fn(&Ray) -> Ray| -> Result<Vec<bool>, CheckError> {
            let rays: Vec<_> = segments.iter().map(changed).collect();
            Ok(closest_hits(brute, &rays)?.iter().map(Hit::is_hit).collect())
        };
        let endless = occluded(|ray| Ray { t_max: f64::INFINITY, ..*ray })?;
        let from_origin = occluded(|ray| Ray { t_min: 0.0, ..*ray })?;
        let truth = Truth {
            segments: closest_hits(brute, &segments)?,
            endless,
            from_origin,
            overwritten: overwritten(brute, &rays, &hits)?,
            rays: hits,
        };
        Ok((Questions { rays, segments }, truth))
    }

    /// Asks the core with one BVH.
    pub(crate) fn put_to(
        &self,
        context: &mut Context<'_>,
        build: Build,
    ) -> Result<Tried, CheckError> {
        let mut built = context.core.build_scene(self.scene, build.acceleration())?;
        let stats = built.stats();
        let is_there = |ray: &Ray, hit: &Hit| lies_on_its_primitive(self.scene, ray, hit);
        let mut differences = |(questions, right): &(Questions, Truth)| {
            let found = questions.ask(built.as_mut())?;
            let differences = compare(questions, &found, right, &is_there);
            Ok::<_, CheckError>((found, differences))
        };
        let ((found, differences), (_, at_vertices)) =
            (differences(&self.graded)?, differences(&self.shown)?);
        let (questions, right) = &self.graded;
        let is_free = |segment: usize| meets_nothing(self.scene, &questions.segments[segment]);
        let cause = explain(&found, right, &differences, &is_free);
        Ok(Tried { build, stats, differences, at_vertices, cause })
    }

    /// Hits of brute force that are not the nearest.
    pub(crate) fn overwritten(&self) -> usize {
        self.graded.1.overwritten
    }

    /// Graded answers of each BVH.
    pub(crate) fn answers(&self) -> usize {
        self.graded.0.answers()
    }
}

/// How many hits are not the nearest, even without a BVH: the ray hits something else when it ends just before.
/// That it hits the same again is a rounding: a core may look for the nearest in single precision and answer in double,
/// and edge-on the two are further apart than any margin.
fn overwritten(
    brute: &mut dyn BuiltScene,
    rays: &[Ray],
    hits: &[Hit],
) -> Result<usize, CheckError> {
    let hitting = rays.iter().zip(hits).filter(|(_, hit)| hit.is_hit());
    let (shortened, ends): (Vec<_>, Vec<_>) = hitting
        .take(OVERWRITTEN_RAYS)
        .map(|(ray, hit)| (Ray { t_max: (1.0 - ON_PRIMITIVE) * hit.t, ..*ray }, hit))
        .unzip();
    let found = closest_hits(brute, &shortened)?;
    let names = |hit: &Hit| (hit.shape, hit.primitive);
    let is_other = |(found, end): &(&Hit, &Hit)| found.is_hit() && names(found) != names(end);
    Ok(found.iter().zip(ends).filter(is_other).count())
}

/// Whether nothing lies on the whole line of a ray, before its origin too: the core's own loop may lose hits.
fn meets_nothing(scene: &SceneDescription, ray: &Ray) -> bool {
    let meets = |direction| oracle::nearest(scene, &Ray::new(ray.origin, direction)).is_some();
    !meets(ray.direction) && !meets(-ray.direction)
}

/// Whether the point of a hit lies on the primitive that the hit names.
fn lies_on_its_primitive(scene: &SceneDescription, ray: &Ray, hit: &Hit) -> bool {
    if !hit.is_hit() {
        return false;
    }
    let point = ray.at(hit.t);
    let allowed = ON_PRIMITIVE * (point.length() + ray.origin.length() + 1.0);
    match scene.shape(hit.shape) {
        Shape::Mesh(mesh) => {
            distance_to_triangle(point, mesh.corners(hit.primitive as usize)) <= allowed
        }
        Shape::Sphere(sphere) => (point.distance(sphere.centre) - sphere.radius).abs() <= allowed,
    }
}

/// The larger of the distance to the plane and the distances beyond each edge.
fn distance_to_triangle(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let beyond =
        |from: DVec3, to: DVec3| (point - from).dot((to - from).cross(normal).normalize_or_zero());
    let edges = beyond(a, b).max(beyond(b, c)).max(beyond(c, a));
    (point - a).dot(normal).abs().max(edges)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_on_a_triangle_only_inside_its_edges() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert!(distance_to_triangle(DVec3::new(0.2, 0.2, 0.0), triangle) <= 0.0);
        assert!(distance_to_triangle(DVec3::new(0.8, 0.8, 0.0), triangle) > 0.4);
        assert!(distance_to_triangle(DVec3::new(0.2, 0.2, 0.3), triangle) > 0.29);
    }
}
