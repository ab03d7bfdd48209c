//! The size of a BVH, as the core tells it: leaves for all primitives, nodes for all leaves,
//! a depth that both allow.

use super::question::{Build, LeafSizes};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{BuildStats, CoreError};

/// The widest node there is.
const WIDEST: f64 = 16.0;

check! {
    /// Nodes, leaves and depth fit each other and the scene.
    pub(crate) struct SizesAddUp {
        /// Each split rule is tried with each of these.
        leaf_sizes: LeafSizes,
    }
    name: "sizes-add-up",
    summary: "nodes, leaves and depth of BVHs fit each other",
    needs: BUILD_SCENE,
}

impl Check for SizesAddUp {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let mut built = Vec::new();
        for build in Build::all(context.info.capabilities, &self.leaf_sizes) {
            let stats = context.core.build_scene(&scene, build.acceleration())?.stats();
            built.push(Sizes { build, stats, primitives: scene.primitive_count() });
        }
        if built.iter().all(|sizes| sizes.stats.nodes == 0) {
            let words = "it does not say how large its BVHs are";
            return Err(CoreError::Beyond(words.to_owned()).into());
        }
        Ok(finding(&built))
    }
}

struct Sizes {
    build: Build,
    stats: BuildStats,
    primitives: usize,
}

impl Sizes {
    fn inner(&self) -> f64 {
        self.stats.nodes as f64 - self.stats.leaves as f64
    }

    /// Children of an inner node, on average: every node but the root is a child.
    fn width(&self) -> f64 {
        (self.stats.nodes as f64 - 1.0) / self.inner()
    }

    fn measures(&self) -> Vec<Measure> {
        let (leaves, depth) = (self.stats.leaves as f64, self.stats.max_depth as f64);
        let primitives = self.primitives as f64;
        let held = leaves * f64::from(self.build.max_leaf_size);
        let mut measures = vec![
            Measure::at_most("leaves, which are nodes too", leaves, self.stats.nodes as f64),
            Measure::at_most("leaves", leaves, primitives),
            Measure::at_most("primitives, for the room in its leaves", primitives, held),
            Measure::at_most("depth", depth, self.inner() + 1.0),
            Measure::at_most("logarithm of leaves, for the depth", leaves.log(WIDEST), depth - 1.0),
        ];
        if leaves > 1.0 {
            let width = self.width();
            measures.extend([
                Measure::at_most("two children a node, for its children", 2.0, width),
                Measure::at_most("children of a node, on average", width, WIDEST),
            ]);
        }
        measures.into_iter().map(|measure| measure.of_row(self.build.name())).collect()
    }

    fn words(&self) -> String {
        format!(
            "{} nodes, {} of them leaves, {} deep",
            self.stats.nodes, self.stats.leaves, self.stats.max_depth
        )
    }
}

fn finding(built: &[Sizes]) -> Finding {
    let measures: Vec<_> = built.iter().flat_map(Sizes::measures).collect();
    let wrong = built.iter().find_map(|sizes| {
        let failed = sizes.measures().into_iter().find(Measure::failed)?;
        Some((sizes, failed))
    });
    let statement = match (wrong, built.first()) {
        (Some((sizes, failed)), _) => format!(
            "{} is {}, more than {}; the core tells of {}, over {} primitives",
            failed.name(),
            figure(failed.measured),
            figure(failed.expected),
            sizes.words(),
            sizes.primitives
        ),
        (None, Some(first)) => {
            format!("{} BVHs add up; the core's own has {}", built.len(), first.words())
        }
        (None, None) => "no BVH was built".to_owned(),
    };
    Finding::of(statement, "would have caught a number that the others forbid", measures)
}

#[cfg(test)]
mod tests {
    use super::super::question::scene_of;
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::math::rng::Seed;
    use crate::scene::procedural::soup;

    fn found(nodes: u64, leaves: u64, max_depth: u64) -> Result<Finding, CheckError> {
        let check: SizesAddUp = check_of("[expect]\nleaf-sizes = [4]");
        let stats = BuildStats { nodes, leaves, max_depth, bytes: 0 };
        let mut core = Fake { stats, ..Fake::default() };
        try_judge(&check, &mut core, Some(scene_of(soup(1000, Seed(1)))))
    }

    #[test]
    fn binary_and_wide_bvhs_pass() {
        assert_passes(&found(511, 256, 9).unwrap());
        assert_passes(&found(300, 262, 4).unwrap());
    }

    #[test]
    fn numbers_that_cannot_be_fail_and_are_told() {
        for (nodes, leaves, depth, words) in [
            (85, 256, 9, "leaves, which are nodes too (at most) is 256, more than 85"),
            (2001, 1001, 12, "leaves (at most) is 1001, more than 1000"),
            (199, 100, 9, "the room in its leaves (at most) is 1000, more than 400"),
            (511, 256, 300, "depth (at most) is 300"),
            (511, 256, 2, "logarithm of leaves"),
            (600, 256, 9, "two children a node"),
            (260, 256, 3, "children of a node, on average"),
        ] {
            let finding = found(nodes, leaves, depth).unwrap();
            assert!(failure(&finding).contains(words), "{words}: {}", finding.statement);
        }
    }

    #[test]
    fn a_core_that_does_not_say_is_not_judged() {
        assert!(found(0, 0, 0).unwrap_err().to_string().contains("does not say how large"));
    }
}
