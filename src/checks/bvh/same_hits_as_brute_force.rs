//! With a BVH and without one, a core meets the same things at the same places.

use super::explanation::shared;
use super::question::{Build, LeafSizes};
use super::trial::{Trial, Tried};
use crate::checks::phrase::one_in;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::text::Count;

check! {
    /// Closest and any hits of the case's scene agree with brute force for every split rule.
    pub(crate) struct SameHitsAsBruteForce {
        /// Rays, and as many segments.
        rays: Count,
        /// Each split rule is tried with each of these.
        leaf_sizes: LeafSizes,
    }
    name: "same-hits-as-brute-force",
    summary: "closest and any hits with a BVH against the loop",
    needs: BUILD_SCENE | INTERSECT | OCCLUDED | BRUTE_FORCE,
}

impl Check for SameHitsAsBruteForce {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        if scene.primitive_count() == 0 {
            return Err(CheckError::Broken("the scene has nothing to hit".to_owned()));
        }
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let seed = context.seed;
        let trial = Trial::prepare(context, &scene, count, seed)?;
        let builds = Build::all(context.info.capabilities, &self.leaf_sizes);
        let tried: Result<Vec<_>, _> =
            builds.into_iter().map(|build| trial.put_to(context, build)).collect();
        Ok(judge(&tried?, trial.answers(), trial.overwritten()))
    }
}

fn judge(tried: &[Tried], answers: usize, overwritten: usize) -> Finding {
    let mut measures: Vec<_> = tried.iter().flat_map(measures).collect();
    let name = "hits without a BVH that are not the nearest";
    measures.push(Measure::none(name, overwritten));
    let wrong = tried.iter().filter(|tried| tried.differences.total() > 0);
    let count = wrong.clone().count();
    let causes: Vec<_> = wrong.clone().map(|tried| tried.cause).collect();
    let bvhs = tried.len();
    let worst = wrong.max_by_key(|tried| tried.differences.total());
    let ways = worst.into_iter().flat_map(|worst| worst.differences.ways());
    let statement = match worst {
        None if overwritten > 0 => {
            format!("{overwritten} hits without a BVH are not the nearest")
        }
        None => format!("{answers} answers are the same with {bvhs} BVHs as without"),
        Some(worst) => format!(
            "{count} of {bvhs} BVHs disagree with brute force; {}: {} of {answers} answers differ, {}",
            worst.build.name(),
            worst.differences.total(),
            worst.differences.words()
        ),
    };
    let caught = format!("would have caught one wrong answer in {}", one_in(answers));
    Finding::of(statement, caught, measures).because_of(shared(&causes)).knowing_laws(ways)
}

/// The second is shown, not graded.
fn measures(tried: &Tried) -> [Measure; 2] {
    let shown = "answers that differ, rays at vertices (not graded)";
    [
        Measure::none("answers that differ", tried.differences.total()),
        Measure::none(shown, tried.at_vertices.total()).not_graded(),
    ]
    .map(|measure| measure.of_row(tried.build.name()))
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, try_judge};
    use crate::math::rng::Seed;
    use crate::scene::procedural;

    fn found(slip: Slip) -> Finding {
        let check: SameHitsAsBruteForce = check_of("[expect]\nrays = 2000\nleaf-sizes = [1, 4]");
        let scene = super::super::question::scene_of(procedural::soup(500, Seed(1)));
        try_judge(&check, &mut FakeCore(slip), Some(scene)).unwrap()
    }

    #[test]
    fn a_bvh_without_mistakes_passes_whatever_its_triangle_test_rounds() {
        assert_passes(&found(Slip::None));
        assert_passes(&found(Slip::ComparesFewDigits));
    }

    #[test]
    fn every_slip_is_seen_and_told() {
        for (slip, told, cause) in [
            (Slip::KeepsTheFirstHit, "hits beyond the nearest one", Some("second-child-skipped")),
            (Slip::ShrinksBoxes, "hits lost", None),
            (Slip::ShadowsWithoutEnd, "shadow rays stopped by nothing", Some("shadow-end-ignored")),
            (Slip::ForgetsTheEnd, "hits outside the segment", None),
            (Slip::NamesTheLeafOrder, "hits with the wrong primitive", Some("leaf-order-numbers")),
        ] {
            let finding = found(slip);
            assert!(failure(&finding).contains(told), "{slip:?}: {}", finding.statement);
            assert!(cause.is_none_or(|cause| causes(&finding) == [cause]), "{slip:?}");
        }
        let finding = found(Slip::KeepsTheFirstHit);
        assert!(finding.statement.contains("10 of 10 BVHs"));
        assert_eq!(finding.laws, ["hits beyond the nearest one"]);
    }
}
