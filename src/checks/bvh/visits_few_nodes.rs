//! How many triangles are tested a ray, as meshes grow: counts, which no clock and no machine can change.

use super::reference::SLACK;
use super::tests_by_size::{ALL_TESTED, ANY_HIT_SLACK, Size, cause, growth, measure_size, rays_at};
use crate::cause::{Cause, bvh};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::math::rng::Seed;
use crate::scene::Mesh;
use crate::scene::procedural::{bumpy_sphere, soup};
use crate::text::Count;
use serde::Deserialize;

/// Tests a ray may not grow faster than this power of the number of triangles: the loop has 1, hierarchies about 0.2.
const STEEPEST: f64 = 0.5;
check! {
    /// The number of tests grows slowly with the mesh.
    pub(crate) struct VisitsFewNodes {
        mesh: Meshes,
        rays: Count,
    }
    name: "visits-few-nodes",
    summary: "tests per ray against the size of the mesh",
    needs: BUILD_SCENE | INTERSECT | OCCLUDED | TRAVERSAL_STATS,
}

/// A mesh of any size.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Meshes {
    /// 512 to 32 768 triangles anywhere.
    Soup,
    /// 320 to 20 480 triangles on a closed surface.
    BumpySphere,
}

impl Meshes {
    fn all(self) -> [Mesh; 4] {
        match self {
            Self::Soup => [512, 2048, 8192, 32_768].map(|triangles| soup(triangles, Seed(1))),
            Self::BumpySphere => [2, 3, 4, 5].map(bumpy_sphere),
        }
    }
}

impl Check for VisitsFewNodes {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let mut sizes = Vec::new();
        for mesh in self.mesh.all() {
            let rays = rays_at(&mesh, count, context.seed);
            sizes.push(measure_size(context, mesh, &rays)?);
        }
        Ok(judge(&sizes))
    }
}

fn judge(sizes: &[Size]) -> Finding {
    let is_real = |size: &&Size| size.closest >= size.hits;
    if let Some(size) = sizes.iter().find(|size| !is_real(size)) {
        let (tests, hits) = (figure(size.closest), figure(size.hits));
        return Finding::failure(format!(
            "the core counts {tests} primitive tests a ray and {hits} hits: its counts are not real"
        ))
        .because(&bvh::COUNTS_NOT_REAL, format!("{tests} tests, {hits} hits a ray"));
    }
    let slope = growth(sizes, |size| size.closest);
    let mut measures = vec![Measure::at_most("growth of tests: exponent of n", slope, STEEPEST)];
    let counts_boxes = sizes.iter().all(|size| size.boxes > 0.0);
    let slope_of_boxes = growth(sizes, |size| size.boxes);
    if counts_boxes {
        let name = "growth of box tests: exponent of n";
        measures.push(Measure::at_most(name, slope_of_boxes, STEEPEST));
    }
    for size in sizes {
        let row = format!("{} triangles", size.triangles);
        let (tests, ratio) = (SLACK * size.ordered, size.any / size.closest);
        measures.extend([
            Measure::at_most("tests a ray", size.closest, tests).of_row(&row).in_unit("triangles"),
            Measure::at_most("tests of any hit over closest hit", ratio, ANY_HIT_SLACK)
                .of_row(&row),
        ]);
    }
    let failed = measures.iter().any(Measure::failed);
    let is_unbalanced = counts_boxes && slope_of_boxes >= ALL_TESTED && slope < STEEPEST;
    let cause = match is_unbalanced {
        true => Some(&bvh::UNBALANCED),
        false => cause(sizes, slope, failed),
    };
    let statement = statement(sizes, slope, cause);
    let resolution =
        "would have caught growth as n^0.5, four times the tests, or shadow rays that search on";
    let finding = Finding::of(statement, resolution, measures);
    match cause {
        Some(cause) if failed => {
            let [primitives, boxes] = [slope, slope_of_boxes].map(figure);
            let boxes =
                if counts_boxes { format!(", of boxes as n^{boxes}") } else { String::new() };
            finding.because(cause, format!("tests grow as n^{primitives}{boxes}"))
        }
        _ => finding,
    }
}

fn statement(sizes: &[Size], slope: f64, cause: Option<&Cause>) -> String {
    let Some(largest) = sizes.last() else { return "no mesh was tried".to_owned() };
    let [tests, plain] = [largest.closest, largest.ordered].map(figure);
    let counted = format!(
        "{tests} of {} triangles are tested a ray, growing as n^{}; a plain median hierarchy tests {plain}",
        largest.triangles,
        figure(slope)
    );
    cause.map_or(counted.clone(), |cause| format!("{counted}; {}", cause.headline))
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};

    fn found(slip: Slip, mesh: &str) -> Finding {
        let text = format!("[expect]\nmesh = \"{mesh}\"\nrays = 300");
        judge(&check_of::<VisitsFewNodes>(&text), &mut FakeCore(slip))
    }

    #[test]
    fn a_plain_hierarchy_passes_on_both_meshes() {
        assert_passes(&found(Slip::None, "soup"));
        assert_passes(&found(Slip::None, "bumpy-sphere"));
    }

    #[test]
    fn the_counts_are_those_of_the_independent_program() {
        // bvh_counts.log: a soup of 32 768 takes 48.5 tests a ray, on another soup and other rays.
        let finding = found(Slip::None, "soup");
        let tests = finding.measures.iter().find(|m| m.row == "32768 triangles").unwrap();
        assert!((tests.measured / 48.5 - 1.0).abs() < 0.15, "{}", tests.measured);
    }

    #[test]
    fn testing_everything_fails_and_is_named() {
        let finding = found(Slip::TestsEverything, "bumpy-sphere");
        let statement = failure(&finding);
        assert!(statement.contains("the BVH is not used"), "{statement}");
        assert_eq!(finding.clues[0].cause, "bvh-not-used");
    }

    #[test]
    fn a_list_is_unbalanced_though_it_tests_few_triangles() {
        let finding = found(Slip::IsAList, "bumpy-sphere");
        failure(&finding);
        assert_eq!(finding.clues[0].cause, "bvh-unbalanced");
    }

    #[test]
    fn boxes_visited_for_nothing_are_named_though_they_pass() {
        let finding = found(Slip::NeverShortens, "soup");
        assert_passes(&finding);
        assert!(
            finding.statement.ends_with(bvh::SEGMENT_NOT_SHORTENED.headline),
            "{}",
            finding.statement
        );
    }

    #[test]
    fn shadow_rays_that_search_on_fail() {
        let finding = found(Slip::SearchesShadows, "soup");
        let statement = failure(&finding);
        assert!(statement.ends_with(bvh::SHADOWS_SEARCH_ON.headline), "{statement}");
        assert_eq!(finding.clues[0].cause, "shadows-search-on");
    }

    #[test]
    fn counts_that_are_not_real_fail() {
        let size = Size {
            triangles: 512.0,
            closest: 0.0,
            any: 0.0,
            boxes: 0.0,
            hits: 0.5,
            ordered: 20.0,
            unordered: 25.0,
            unshortened: 30.0,
        };
        assert!(failure(&super::judge(&[size])).contains("its counts are not real"));
    }
}
