//! Arrangements that leave a split rule nothing to split by: the build ends, the hierarchy is not deep, and it is right.
//!
//! A build that recurses for ever takes its process with it, which is the runner's to notice. Not here: how long a
//! build takes.

use super::question::{Build, LeafSizes, scene_of};
use super::trial::{Trial, Tried};
use crate::cause;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::math::rng::Seed;
use crate::scene::procedural::{Layout, pathological, soup};
use crate::scene::{Mesh, SceneDescription};
use crate::text::Count;
use crate::text::number::figure;

check! {
    /// Every hierarchy over every arrangement is finite, shallow and right.
    pub(crate) struct BuildsComeToAnEnd {
        /// Triangles of each arrangement.
        triangles: Count,
        /// Rays by which each hierarchy is compared with brute force.
        rays: Count,
        /// Each split rule is tried with each of these.
        leaf_sizes: LeafSizes,
    }
    name: "builds-come-to-an-end",
    summary: "equal centroids, coincident triangles, huge ratios, next to nothing",
    needs: BUILD_SCENE | INTERSECT | OCCLUDED | BRUTE_FORCE,
}

const LAYOUTS: [(Layout, &str); 5] = [
    (Layout::IdenticalCentroids, "identical centroids"),
    (Layout::CoincidentTriangles, "coincident triangles"),
    (Layout::CoplanarLine, "a line of coplanar triangles"),
    (Layout::SizeRatio, "sizes of 1 to a million"),
    (Layout::GridOnOneAxis, "a grid on one axis"),
];
/// So many of them have all their centroids in one place.
const IN_ONE_PLACE: usize = 2;
/// Scenes that have next to nothing to divide.
const FEW: [(u32, &str); 3] = [(0, "no triangle"), (1, "one triangle"), (2, "two triangles")];

impl Check for BuildsComeToAnEnd {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let builds = Build::all(context.info.capabilities, &self.leaf_sizes);
        let mut results = Vec::new();
        for arrangement in self.arrangements() {
            results.push(self.put_to(context, &builds, arrangement)?);
        }
        Ok(judge(&results))
    }
}

/// A scene and its name.
struct Arrangement {
    name: &'static str,
    scene: SceneDescription,
}

/// What came of all hierarchies over one arrangement.
struct Outcome {
    name: &'static str,
    triangles: usize,
    tried: Vec<Tried>,
}

impl BuildsComeToAnEnd {
    fn arrangements(&self) -> impl Iterator<Item = Arrangement> {
        let triangles = u32::try_from(self.triangles.0).unwrap_or(u32::MAX);
        let awkward = LAYOUTS
            .into_iter()
            .map(move |(layout, name)| (name, pathological(layout, triangles, Seed(1))));
        let few = FEW.into_iter().map(|(count, name)| (name, soup(count, Seed(1))));
        awkward.chain(few).map(|(name, mesh)| Arrangement { name, scene: scene_or_nothing(mesh) })
    }

    fn put_to(
        &self,
        context: &mut Context<'_>,
        builds: &[Build],
        Arrangement { name, scene }: Arrangement,
    ) -> Result<Outcome, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let seed = context.seed.child(name);
        let trial = Trial::prepare(context, &scene, count, seed)?;
        let tried: Result<_, _> =
            builds.iter().map(|build| trial.put_to(context, *build)).collect();
        Ok(Outcome { name, triangles: scene.primitive_count(), tried: tried? })
    }
}

fn scene_or_nothing(mesh: Mesh) -> SceneDescription {
    if mesh.indices.is_empty() { SceneDescription::default() } else { scene_of(mesh) }
}

impl Outcome {
    /// Twice the depth of a balanced tree, and room for rules that peel off single triangles for a while.
    fn deepest_allowed(&self) -> f64 {
        2.0 * (self.triangles.max(1) as f64).log2() + 64.0
    }

    /// The deepest hierarchy; a core that does not know its depth says 0.
    fn deepest(&self) -> Option<&Tried> {
        self.tried.iter().max_by_key(|tried| tried.stats.max_depth)
    }

    fn depth(&self) -> f64 {
        self.deepest().map_or(0.0, |tried| tried.stats.max_depth as f64)
    }

    fn most_different(&self) -> Option<&Tried> {
        self.tried.iter().max_by_key(|tried| tried.differences.total())
    }

    fn measures(&self) -> [Measure; 2] {
        let differences: usize = self.tried.iter().map(|tried| tried.differences.total()).sum();
        [
            Measure::at_most("depth", self.depth(), self.deepest_allowed()),
            Measure::none("wrong answers", differences),
        ]
        .map(|measure| measure.of_row(self.name))
    }

    fn complaint(&self) -> Option<String> {
        let worst = self.most_different().filter(|tried| tried.differences.total() > 0);
        if let Some(worst) = worst {
            let (build, words) = (worst.build.name(), worst.differences.words());
            return Some(format!("{}: {build} differs from brute force, {words}", self.name));
        }
        let deepest = self.deepest()?;
        if self.depth() <= self.deepest_allowed() {
            return None;
        }
        Some(format!(
            "{}: {} is {} nodes deep for {} triangles, more than {}",
            self.name,
            deepest.build.name(),
            self.depth(),
            self.triangles,
            figure(self.deepest_allowed().floor())
        ))
    }
}

fn judge(results: &[Outcome]) -> Finding {
    let depth = match results.iter().map(Outcome::depth).fold(0.0, f64::max) {
        0.0 => "of unknown depth".to_owned(),
        deepest => format!("at most {deepest} nodes deep"),
    };
    let right =
        format!("{} arrangements end in hierarchies {depth}, all of them right", results.len());
    let caught = "would have caught a depth above 2 log2 n + 64, or one wrong hit";
    let evidence = deep_where_nothing_separates(results);
    Finding::of(right, caught, results.iter().flat_map(Outcome::measures).collect())
        .complaining(results.iter().filter_map(Outcome::complaint))
        .because_of(evidence.map(|evidence| (&cause::bvh::SPLIT_REPEATED, evidence)))
}

/// Only hierarchies over centroids in one place are too deep.
fn deep_where_nothing_separates(results: &[Outcome]) -> Option<String> {
    let is_too_deep = |outcome: &&Outcome| outcome.depth() > outcome.deepest_allowed();
    let deep: Vec<_> = results.iter().filter(is_too_deep).map(|outcome| outcome.name).collect();
    let in_one_place = |name: &&str| LAYOUTS[..IN_ONE_PLACE].iter().any(|layout| layout.1 == *name);
    let is_it = !deep.is_empty() && deep.iter().all(in_one_place);
    is_it.then(|| format!("hierarchies over {} alone are too deep", deep.join(" and ")))
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    fn found(slip: Slip) -> Finding {
        let check: BuildsComeToAnEnd =
            check_of("[expect]\ntriangles = 1000\nrays = 60\nleaf-sizes = [4]");
        judge(&check, &mut FakeCore(slip))
    }

    #[test]
    fn shallow_and_right_hierarchies_pass() {
        let finding = found(Slip::None);
        assert_passes(&finding);
        assert!(finding.statement.starts_with("8 arrangements end in hierarchies at most 9 nodes"));
    }

    #[test]
    fn a_list_is_too_deep() {
        let finding = found(Slip::IsAList);
        let statement = failure(&finding);
        assert!(
            statement.contains("is 1000 nodes deep for 1000 triangles, more than 83"),
            "{statement}"
        );
        assert!(finding.clues.is_empty(), "grids can be separated");
    }

    #[test]
    fn wrong_hits_in_an_awkward_arrangement_are_seen() {
        let finding = found(Slip::ShrinksBoxes);
        let statement = failure(&finding);
        assert!(statement.contains("a line of coplanar triangles: "), "{statement}");
        assert!(statement.contains("hits lost"), "{statement}");
    }
}
