//! What is compared: brute force, and a BVH by each rule.

use furnace::contract::{Acceleration, BuiltScene, Core, Hit, Ray, Split, TraversalStats};
use furnace::cores::builtin::Builtin;
use furnace::scene::SceneDescription;

/// A structure to trace.
#[derive(Clone, Copy)]
pub struct Rule {
    /// As the table has it.
    pub name: &'static str,
    acceleration: Acceleration,
}

impl Rule {
    const fn bvh(name: &'static str, split: Split) -> Self {
        Self { name, acceleration: Acceleration::Bvh { split, max_leaf_size: 4, counted: true } }
    }

    /// Whether this is what the others are compared with.
    pub fn is_brute_force(&self) -> bool {
        self.acceleration == Acceleration::BruteForce
    }
}

/// Brute force first.
pub const RULES: [Rule; 5] = [
    Rule { name: "brute-force", acceleration: Acceleration::BruteForce },
    Rule::bvh("median", Split::Median),
    Rule::bvh("mean-of-centroids", Split::MeanOfCentroids),
    Rule::bvh("midpoint", Split::Midpoint),
    Rule::bvh("surface-area", Split::SurfaceArea),
];

/// Builds by `rule` with the given core.
pub fn build<'a>(
    core: &'a mut Builtin,
    scene: &SceneDescription,
    rule: Rule,
) -> Box<dyn BuiltScene + 'a> {
    core.build_scene(scene, rule.acceleration).expect("builtin builds any mesh")
}

/// Room for the answers to `count` rays.
pub fn no_hits(count: usize) -> Vec<Hit> {
    vec![Hit::MISS; count]
}

/// Nearest hits of all rays.
pub fn trace(built: &mut dyn BuiltScene, rays: &[Ray], hits: &mut [Hit]) -> TraversalStats {
    built.intersect(rays, hits).expect("builtin intersects")
}
