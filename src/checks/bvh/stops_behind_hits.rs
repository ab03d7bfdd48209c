//! Layers behind layers, seen from both ends: what lies behind the first hit need not be tested, whichever end the
//! ray comes from. Counts, which no clock and no machine can change.

use super::question::scene_of;
use super::reference::{ReferenceBvh, SLACK, Walk};
use crate::cause::{Cause, bvh};
use crate::checks::phrase::{at_most, figure};
use crate::checks::{Check, CheckError, Context, Finding};
use crate::contract::{Acceleration, BuiltScene, Capabilities, Hit, Ray};
use crate::math::rng::{Seed, uniform};
use crate::scene::Mesh;
use crate::stats::Verdict;
use crate::text::Count;
use glam::DVec3;
use serde::Deserialize;

/// Squares one behind the other, each of so many cells along a side.
const LAYERS: u32 = 64;
const CELLS: u32 = 4;

/// The number of tests does not grow with what is hidden.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StopsBehindHits {
    /// From each end.
    rays: Count,
}

impl Check for StopsBehindHits {
    const NAME: &'static str = "stops-behind-hits";
    const SUMMARY: &'static str = "tests per ray where layers hide each other, from both ends";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE | Capabilities::INTERSECT | Capabilities::TRAVERSAL_STATS
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let (mesh, seed) = (layers(), context.seed);
        let reference = ReferenceBvh::new(&mesh);
        let scene = scene_of(mesh);
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut ends = Vec::new();
        for (name, from_above) in [("from below", false), ("from above", true)] {
            let rays = rays(count, from_above, seed.child(name));
            let tests = tests_per_ray(built.as_mut(), &rays)?;
            ends.push(End { name, tests, plain: reference.tests_per_ray(&rays, Walk::Ordered) });
        }
        Ok(judge(&ends))
    }
}

/// Triangles in z = 0, 1, 2, …
fn layers() -> Mesh {
    let mut mesh = Mesh::default();
    for layer in 0..LAYERS {
        for cell in 0..CELLS * CELLS {
            let first = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
            let corner = |dx: u32, dy: u32| {
                let at = [cell % CELLS + dx, cell / CELLS + dy].map(f64::from);
                DVec3::new(at[0], at[1], f64::from(layer))
            };
            mesh.positions.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
            mesh.indices.extend([[0, 1, 2], [0, 2, 3]].map(|face| face.map(|v| first + v)));
        }
    }
    mesh
}

/// Steeply through all layers.
fn rays(count: usize, from_above: bool, seed: Seed) -> Vec<Ray> {
    let stream = &mut seed.stream();
    let mut at = |z: f64| {
        let inside = [(); 2].map(|()| f64::from(CELLS) * (0.1 + 0.8 * uniform(stream)));
        DVec3::new(inside[0], inside[1], z)
    };
    let mut ray = || {
        let (low, high) = (at(-3.0), at(f64::from(LAYERS) + 3.0));
        let (from, to) = if from_above { (high, low) } else { (low, high) };
        Ray::new(from, (to - from).normalize())
    };
    (0..count).map(|_| ray()).collect()
}

/// Primitives tested a ray.
pub fn tests_per_ray(scene: &mut dyn BuiltScene, rays: &[Ray]) -> Result<f64, CheckError> {
    let mut hits = vec![Hit::MISS; rays.len()];
    let stats = scene.intersect(rays, &mut hits)?;
    Ok(stats.primitive_tests as f64 / rays.len() as f64)
}

/// Rays from one end.
struct End {
    name: &'static str,
    tests: f64,
    /// Of a plain hierarchy.
    plain: f64,
}

impl End {
    fn is_slow(&self) -> bool {
        self.tests > SLACK * self.plain
    }
}

fn judge(ends: &[End]) -> Finding {
    let measures: Vec<_> = ends
        .iter()
        .map(|end| at_most(format!("tests a ray {}", end.name), end.tests, SLACK * end.plain))
        .collect();
    let told = |end: &End| {
        format!("{} {}, a plain hierarchy {}", figure(end.tests), end.name, figure(end.plain))
    };
    let told = ends.iter().map(told).collect::<Vec<_>>().join("; ");
    let failed = measures.iter().any(|measure| measure.verdict == Verdict::Fail);
    let cause = if failed { cause(ends) } else { None };
    let why = cause.map_or_else(String::new, |cause| format!(": {}", cause.headline));
    let statement = format!("triangles tested a ray of {LAYERS} layers: {told}{why}");
    Finding::of(statement, "would have caught a fifth of what is hidden being tested", measures)
        .because_each(cause, &told)
}

/// In order from one end only, from none, or never mind the boxes.
fn cause(ends: &[End]) -> Option<&'static Cause> {
    let triangles = f64::from(2 * CELLS * CELLS * LAYERS);
    let slow = ends.iter().filter(|end| end.is_slow()).count();
    if ends.iter().all(|end| end.tests >= triangles) {
        Some(&bvh::HIERARCHY_NOT_USED)
    } else if slow == ends.len() {
        Some(&bvh::SEGMENT_NOT_SHORTENED)
    } else {
        Some(&bvh::CHILDREN_UNORDERED)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    fn found(slip: Slip) -> Finding {
        judge(&check_of::<StopsBehindHits>("[expect]\nrays = 200"), &mut FakeCore(slip))
    }

    #[test]
    fn an_ordered_walk_passes() {
        assert_passes(&found(Slip::None));
    }

    #[test]
    fn walks_that_test_what_is_hidden_fail_and_are_named() {
        for (slip, cause) in [
            (Slip::NeverShortens, "t-max-not-shortened"),
            (Slip::NeverOrders, "children-unordered"),
            (Slip::TestsEverything, "bvh-not-used"),
        ] {
            let finding = found(slip);
            assert!(failure(&finding).contains("layers"), "{finding:?}");
            assert_eq!(finding.clues[0].cause, cause);
        }
    }
}
