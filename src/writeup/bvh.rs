//! The table of part 2: how long the rays of an image take with the BVH and without it, and how many tests.

use super::cast::{Cast, MESHES, Role};
use crate::contract::validate::Validated;
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, Core, CoreError, Hit, Ray, TraversalStats,
};
use crate::render::{Shot, camera_rays};
use crate::scene::SceneDescription;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Brute force is timed on ever more rays until they take so long, or are all.
const LONG_ENOUGH: f64 = 0.25;
/// The first that it is timed on.
const FIRST_RAYS: usize = 16;
/// The quickest of so many passes counts, for other work on the machine can only add to a time; and fewer of those that
/// took so long together.
const PASSES: usize = 3;
const LONG_TOGETHER: f64 = 2.0;
/// How far apart two distances to one hit may be, as a share.
const SAME_HIT: f64 = 1e-4;

/// A mesh, and what is known of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mesh {
    pub(super) role: Role,
}

impl Mesh {
    pub(super) fn all() -> impl Iterator<Item = Self> {
        MESHES.iter().map(|role| Self { role: *role })
    }

    pub(super) fn shot(&self, cast: &Cast, size: [u32; 2]) -> Result<Shot, String> {
        Ok(Shot { size: Some(size), normals: true, ..cast.shot(self.role)? })
    }
}

/// What was measured on a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) struct Timed {
    pub(super) triangles: usize,
    pub(super) rays: usize,
    pub(super) build_seconds: f64,
    pub(super) with: Traced,
    /// Or why it is not known.
    pub(super) without: Result<Traced, String>,
    /// Rays of brute force whose hit the BVH does not share.
    pub(super) different: usize,
}

/// Rays through one structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) struct Traced {
    pub(super) seconds: f64,
    /// On how many rays it was timed.
    pub(super) rays: usize,
    /// Primitives and boxes tested for a ray; none where the core does not count them.
    pub(super) tests: Option<[f64; 2]>,
}

impl Timed {
    /// How many times faster a ray is with the BVH.
    pub(super) fn speed_up(&self) -> Option<f64> {
        let a_ray = |traced: &Traced| traced.seconds / traced.rays as f64;
        self.without.as_ref().ok().map(|without| a_ray(without) / a_ray(&self.with))
    }
}

/// Traces the camera rays of a scene with the core's BVH and, as far as the core can, without.
///
/// # Errors
/// If the core does not answer.
pub(super) fn time(
    core: &mut dyn Core,
    scene: &SceneDescription,
    shot: &Shot,
) -> Result<Timed, CoreError> {
    let capabilities = core.info().capabilities;
    // The figures of normals tell of those that are not unit.
    let mut core = Validated::mending(core);
    let camera = shot.camera(scene).map_err(CoreError::Beyond)?;
    let rays = camera_rays(&camera);
    let counts = capabilities.contains(Capabilities::TRAVERSAL_STATS);
    let begun = Instant::now();
    let mut built = core.build_scene(scene, Acceleration::DEFAULT)?;
    let build_seconds = begun.elapsed().as_secs_f64();
    let (hits, with) = trace(built.as_mut(), &rays, counts)?;
    drop(built);
    let (without, different) = match without(&mut core, scene, &rays, counts) {
        Ok((sample, traced)) => (Ok(traced), different(&sample, &hits)),
        Err(error) => (Err(error.to_string()), 0),
    };
    let triangles = scene.primitive_count();
    Ok(Timed { triangles, rays: rays.len(), build_seconds, with, without, different })
}

/// A hit, and the number of its ray.
type Sample = Vec<(usize, Hit)>;

fn without(
    core: &mut dyn Core,
    scene: &SceneDescription,
    rays: &[Ray],
    counts: bool,
) -> Result<(Sample, Traced), CoreError> {
    let missing = Capabilities::BRUTE_FORCE.difference(core.info().capabilities);
    if !missing.is_empty() {
        return Err(CoreError::Unsupported(missing));
    }
    let mut built = core.build_scene(scene, Acceleration::BruteForce)?;
    let mut count = FIRST_RAYS.min(rays.len());
    loop {
        let numbers: Vec<_> = (0..count).map(|i| i * rays.len() / count).collect();
        let some: Vec<_> = numbers.iter().map(|number| rays[*number]).collect();
        let (hits, traced) = trace(built.as_mut(), &some, counts)?;
        if traced.seconds >= LONG_ENOUGH || count == rays.len() {
            return Ok((numbers.into_iter().zip(hits).collect(), traced));
        }
        count = (4 * count).min(rays.len());
    }
}

fn trace(
    scene: &mut dyn BuiltScene,
    rays: &[Ray],
    counts: bool,
) -> Result<(Vec<Hit>, Traced), CoreError> {
    let mut hits = vec![Hit::MISS; rays.len()];
    let (mut seconds, mut together) = (f64::INFINITY, 0.0);
    let mut stats = TraversalStats::default();
    for _ in 0..PASSES {
        let begun = Instant::now();
        stats = scene.intersect(rays, &mut hits)?;
        let pass = begun.elapsed().as_secs_f64();
        (seconds, together) = (seconds.min(pass), together + pass);
        if together > LONG_TOGETHER {
            break;
        }
    }
    let tests = counts.then(|| tests(stats, rays.len()));
    Ok((hits, Traced { seconds, rays: rays.len(), tests }))
}

fn tests(stats: TraversalStats, rays: usize) -> [f64; 2] {
    [stats.primitive_tests, stats.box_tests].map(|tests| tests as f64 / rays as f64)
}

fn different(sample: &Sample, hits: &[Hit]) -> usize {
    let is_same = |one: &Hit, other: &Hit| match (one.is_hit(), other.is_hit()) {
        (true, true) => (one.t - other.t).abs() <= SAME_HIT * one.t.abs(),
        (one, other) => one == other,
    };
    sample.iter().filter(|(number, hit)| !is_same(hit, &hits[*number])).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::BuildStats;
    use std::time::Duration;

    /// Is held up in its first pass.
    struct HeldUp(usize);

    impl BuiltScene for HeldUp {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        fn intersect(&mut self, _: &[Ray], _: &mut [Hit]) -> Result<TraversalStats, CoreError> {
            self.0 += 1;
            if self.0 == 1 {
                std::thread::sleep(Duration::from_millis(400));
            }
            Ok(TraversalStats { rays: 1, primitive_tests: 2, box_tests: 3 })
        }
    }

    #[test]
    fn a_pass_that_was_held_up_does_not_count() {
        let ray = Ray {
            origin: Default::default(),
            direction: Default::default(),
            t_min: 0.0,
            t_max: 1.0,
        };
        let mut scene = HeldUp(0);
        let (hits, traced) = trace(&mut scene, &[ray], true).unwrap();
        assert_eq!((hits.len(), scene.0, traced.tests), (1, PASSES, Some([2.0, 3.0])));
        assert!(traced.seconds < 0.4, "{traced:?}");
    }
}
