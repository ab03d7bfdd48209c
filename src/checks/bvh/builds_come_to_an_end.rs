//! Arrangements that leave a split rule nothing to split by: the build ends, the BVH is not deep, and it is right.
//!
//! A build that recurses for ever takes its process with it, which is the runner's to notice. Not here: how long a
//! build takes.

use super::arrangement::{IN_ONE_PLACE, without_a_split};
use super::question::{Build, LeafSizes};
use super::trial::{Trial, Tried};
use crate::cause;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::scene::SceneDescription;
use crate::text::Count;
use crate::text::number::figure;

check! {
    /// Every BVH over every arrangement is finite, shallow and right.
    pub(crate) struct BuildsComeToAnEnd {
        /// Triangles of each arrangement.
        triangles: Count,
        /// Rays by which each BVH is compared with brute force.
        rays: Count,
        /// Each split rule is tried with each of these.
        leaf_sizes: LeafSizes,
    }
    name: "builds-come-to-an-end",
    summary: "equal centroids, coincident triangles, huge ratios, next to nothing",
    needs: BUILD_SCENE | INTERSECT | OCCLUDED | BRUTE_FORCE,
}

impl Check for BuildsComeToAnEnd {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let builds = Build::all(context.info.capabilities, &self.leaf_sizes);
        let mut results = Vec::new();
        for (name, scene) in without_a_split(self.triangles) {
            results.push(self.put_to(context, &builds, name, &scene)?);
        }
        Ok(judge(&results))
    }
}

/// What came of all BVHs over one arrangement.
struct Outcome {
    name: &'static str,
    triangles: usize,
    tried: Vec<Tried>,
}

impl BuildsComeToAnEnd {
    fn put_to(
        &self,
        context: &mut Context<'_>,
        builds: &[Build],
        name: &'static str,
        scene: &SceneDescription,
    ) -> Result<Outcome, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let seed = context.seed.child(name);
        let trial = Trial::prepare(context, scene, count, seed)?;
        let tried = builds.iter().map(|build| trial.put_to(context, *build));
        let tried = tried.collect::<Result<_, _>>()?;
        Ok(Outcome { name, triangles: scene.primitive_count(), tried })
    }
}

impl Outcome {
    /// Twice the depth of a balanced tree, and room for rules that peel off single triangles for a while.
    fn deepest_allowed(&self) -> f64 {
        2.0 * (self.triangles.max(1) as f64).log2() + 64.0
    }

    /// The deepest BVH; a core that does not know its depth says 0.
    fn deepest(&self) -> Option<&Tried> {
        self.tried.iter().max_by_key(|tried| tried.stats.max_depth)
    }

    fn depth(&self) -> f64 {
        self.deepest().map_or(0.0, |tried| tried.stats.max_depth as f64)
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
        let most_different = self.tried.iter().max_by_key(|tried| tried.differences.total());
        if let Some(worst) = most_different.filter(|tried| tried.differences.total() > 0) {
            let (build, words) = (worst.build.name(), worst.differences.words());
            return Some(format!("{}: {build} differs from brute force, {words}", self.name));
        }
        let deepest = self.deepest().filter(|_| self.depth() > self.deepest_allowed())?;
        let (name, build, depth, triangles) =
            (self.name, deepest.build.name(), self.depth(), self.triangles);
        let allowed = figure(self.deepest_allowed().floor());
        Some(format!(
            "{name}: {build} is {depth} nodes deep for {triangles} triangles, more than {allowed}"
        ))
    }
}

fn judge(results: &[Outcome]) -> Finding {
    let depth = match results.iter().map(Outcome::depth).fold(0.0, f64::max) {
        0.0 => "of unknown depth".to_owned(),
        deepest => format!("at most {deepest} nodes deep"),
    };
    let right = format!("{} arrangements end in BVHs {depth}, all of them right", results.len());
    let caught = "would have caught a depth above 2 log2 n + 64, or one wrong hit";
    let evidence = deep_where_nothing_separates(results);
    Finding::of(right, caught, results.iter().flat_map(Outcome::measures).collect())
        .complaining(results.iter().filter_map(Outcome::complaint))
        .because_of(evidence.map(|evidence| (&cause::bvh::SPLIT_REPEATED, evidence)))
}

/// Only BVHs over centroids in one place are too deep.
fn deep_where_nothing_separates(results: &[Outcome]) -> Option<String> {
    let is_too_deep = |outcome: &&Outcome| outcome.depth() > outcome.deepest_allowed();
    let deep: Vec<_> = results.iter().filter(is_too_deep).map(|outcome| outcome.name).collect();
    let is_it = !deep.is_empty() && deep.iter().all(|name| IN_ONE_PLACE.contains(name));
    is_it.then(|| format!("BVHs over {} alone are too deep", deep.join(" and ")))
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
    fn shallow_and_right_bvhs_pass() {
        let finding = found(Slip::None);
        assert_passes(&finding);
        assert!(finding.statement.starts_with("8 arrangements end in BVHs at most 9 nodes"));
    }

    #[test]
    fn a_list_is_too_deep() {
        let finding = found(Slip::IsAList);
        let told = "is 1000 nodes deep for 1000 triangles, more than 83";
        assert!(failure(&finding).contains(told), "{finding:?}");
        assert!(finding.clues.is_empty(), "grids can be separated");
    }

    #[test]
    fn wrong_hits_in_an_awkward_arrangement_are_seen() {
        let finding = found(Slip::ShrinksBoxes);
        for told in ["a line of coplanar triangles: ", "hits lost"] {
            assert!(failure(&finding).contains(told), "{finding:?}");
        }
    }
}
