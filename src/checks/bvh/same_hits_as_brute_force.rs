//! With a hierarchy and without one, a core meets the same things at the same places.

use super::explanation::shared;
use super::question::{Build, LeafSizes};
use super::trial::{Trial, Tried};
use crate::checks::phrase::figure;
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
    summary: "closest and any hits with a hierarchy against the loop",
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
    let name = "hits without a hierarchy that are not the nearest";
    measures.push(Measure::none(name, overwritten));
    let wrong = tried.iter().filter(|tried| tried.differences.total() > 0);
    let count = wrong.clone().count();
    let causes: Vec<_> = wrong.clone().map(|tried| tried.cause).collect();
    let hierarchies = tried.len();
    let statement = match wrong.max_by_key(|tried| tried.differences.total()) {
        None if overwritten > 0 => {
            format!("{overwritten} hits without a hierarchy are not the nearest")
        }
        None => format!("{answers} answers are the same with {hierarchies} hierarchies as without"),
        Some(worst) => format!(
            "{count} of {hierarchies} hierarchies disagree with brute force; {}: {} of {answers} answers differ, {}",
            worst.build.name(),
            worst.differences.total(),
            worst.differences.words()
        ),
    };
    // 6.9 = −ln 0.001: so rare a mistake shows in none of the answers once in a thousand times.
    let rare = figure((answers as f64 / 6.9).floor());
    Finding::of(statement, format!("would have caught one wrong answer in {rare}"), measures)
        .because_of(shared(&causes))
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
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::math::rng::Seed;
    use crate::scene::procedural;

    fn found(slip: Slip) -> Finding {
        let check: SameHitsAsBruteForce = check_of("[expect]\nrays = 2000\nleaf-sizes = [1, 4]");
        let scene = super::super::question::scene_of(procedural::soup(500, Seed(1)));
        try_judge(&check, &mut FakeCore(slip), Some(scene)).unwrap()
    }

    #[test]
    fn a_hierarchy_without_mistakes_passes() {
        assert_passes(&found(Slip::None));
    }

    #[test]
    fn roundings_of_the_triangle_test_are_nobodys_fault() {
        assert_passes(&found(Slip::ComparesFewDigits));
    }

    #[test]
    fn the_first_hit_instead_of_the_nearest_is_seen() {
        let finding = found(Slip::KeepsTheFirstHit);
        let statement = failure(&finding);
        assert!(statement.contains("10 of 10 hierarchies"), "{statement}");
        assert!(statement.contains("hits beyond the nearest one"), "{statement}");
        assert_eq!(finding.clues[0].cause, "second-child-skipped");
    }

    #[test]
    fn a_box_that_is_too_small_loses_hits() {
        let finding = found(Slip::ShrinksBoxes);
        assert!(failure(&finding).contains("hits lost"), "{finding:?}");
    }

    #[test]
    fn an_any_hit_that_ignores_the_end_of_the_segment_is_seen() {
        let finding = found(Slip::ShadowsWithoutEnd);
        let statement = failure(&finding);
        assert!(statement.ends_with("shadow rays stopped by nothing"), "{statement}");
        assert_eq!(finding.clues[0].cause, "shadow-end-ignored");
    }

    #[test]
    fn hits_behind_the_end_of_the_segment_are_seen() {
        let finding = found(Slip::ForgetsTheEnd);
        assert!(failure(&finding).contains("hits outside the segment"), "{finding:?}");
    }

    #[test]
    fn the_number_of_the_leaf_instead_of_the_triangle_is_seen() {
        let finding = found(Slip::NamesTheLeafOrder);
        assert!(failure(&finding).contains("hits with the wrong primitive"), "{finding:?}");
        assert_eq!(finding.clues[0].cause, "leaf-order-numbers");
    }
}
