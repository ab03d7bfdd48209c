//! How many triangles are tested a ray, as meshes grow: counts, which no clock and no machine can change.

use super::tests_by_size::{ALL_TESTED, ANY_HIT_SLACK, Size, cause, growth, measure_size, rays_at};
use crate::cause::{Cause, bvh};
use crate::checks::phrase::figure;
use crate::checks::series::{OneLine, Series, TestsBySize};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::math::rng::Seed;
use crate::scene::Mesh;
use crate::scene::procedural::{bumpy_sphere, soup};
use crate::text::Count;
use serde::Deserialize;

/// Tests a ray may not grow faster than this power of the number of triangles: the loop has 1, BVHs about 0.2.
const STEEPEST: f64 = 0.5;
/// Where to split, which child comes first and whether boxes behind a hit are visited is free here, and so are leaves: a core
/// may test this many times the triangles of a plain BVH that is walked without order and to the ray's end.
const SLACK: f64 = 2.0;
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
    if let Some(size) = sizes.iter().find(|size| !size.is_real()) {
        let (tests, hits) = (figure(size.closest), figure(size.hits));
        return Finding::failure(format!(
            "the core counts {tests} primitive tests a ray and {hits} hits: its counts are not real"
        ))
        .because(&bvh::COUNTS_NOT_REAL, format!("{tests} tests, {hits} hits a ray"));
    }
    let slope = growth(sizes, |size| size.closest);
    let counts_boxes = sizes.iter().all(|size| size.boxes > 0.0);
    let slope_of_boxes = counts_boxes.then(|| growth(sizes, |size| size.boxes));
    let exponent = |what: &str, slope| {
        Measure::at_most(format!("growth of {what}: exponent of n"), slope, STEEPEST)
    };
    let measures: Vec<_> = [exponent("tests", slope)]
        .into_iter()
        .chain(slope_of_boxes.map(|slope| exponent("box tests", slope)))
        .chain(sizes.iter().flat_map(measures_of))
        .collect();
    let failed = measures.iter().any(Measure::failed);
    let cause = match slope_of_boxes {
        Some(boxes) if boxes >= ALL_TESTED && slope < STEEPEST => Some(&bvh::UNBALANCED),
        _ => cause(sizes, slope, failed),
    };
    let resolution = "would have caught growth as n^0.5, twice the tests of an unordered BVH, or \
                      shadow rays that search on";
    let boxes =
        slope_of_boxes.map_or_else(String::new, |s| format!(", of boxes as n^{}", figure(s)));
    let of_shadows = figure(growth(sizes, |size| size.any));
    let evidence =
        format!("tests grow as n^{}{boxes}, of shadow rays as n^{of_shadows}", figure(slope));
    Finding::of(statement(sizes, slope, cause), resolution, measures)
        .because_each(cause.filter(|_| failed), &evidence)
        .showing([series(sizes)])
}

fn series(sizes: &[Size]) -> Series {
    let tests = |of: fn(&Size) -> f64| OneLine::rounded(sizes.iter().map(of));
    Series::TestsBySize(TestsBySize {
        triangles: sizes.iter().map(|size| size.triangles as u64).collect(),
        closest: tests(|size| size.closest),
        any: tests(|size| size.any),
        boxes: tests(|size| size.boxes),
        plain: tests(|size| size.ordered),
    })
}

fn measures_of(size: &Size) -> [Measure; 2] {
    let (tests, ratio) = (SLACK * size.unshortened, size.any / size.closest);
    [
        Measure::at_most("tests a ray", size.closest, tests).in_unit("triangles"),
        Measure::at_most("tests of any hit over closest hit", ratio, ANY_HIT_SLACK),
    ]
    .map(|measure| measure.of_row(format!("{} triangles", size.triangles)))
}

fn statement(sizes: &[Size], slope: f64, cause: Option<&Cause>) -> String {
    let Some(largest) = sizes.last() else { return "no mesh was tried".to_owned() };
    let [tests, plain] = [largest.closest, largest.ordered].map(figure);
    let counted = format!(
        "{tests} of {} triangles are tested a ray, growing as n^{}; a plain median BVH tests {plain}",
        largest.triangles,
        figure(slope)
    );
    cause.map_or(counted.clone(), |cause| format!("{counted}; {}", cause.headline))
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, judge};

    fn found(slip: Slip, mesh: &str) -> Finding {
        let text = format!("[expect]\nmesh = \"{mesh}\"\nrays = 300");
        judge(&check_of::<VisitsFewNodes>(&text), &mut FakeCore(slip))
    }

    #[test]
    fn a_plain_bvh_passes_on_both_meshes() {
        let series = found(Slip::None, "soup").series;
        let [Series::TestsBySize(tests)] = &series[..] else { panic!("{series:?}") };
        assert_eq!(tests.triangles[..], [512, 2048, 8192, 32_768]);
        assert!(
            tests.closest.iter().zip(tests.plain.iter()).all(|(a, b)| (a / b - 1.0).abs() < 0.5)
        );
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
    fn what_grows_too_fast_fails_and_is_named() {
        for (slip, mesh, cause) in [
            (Slip::TestsEverything, "bumpy-sphere", &bvh::BVH_NOT_USED),
            // It tests few triangles.
            (Slip::IsAList, "bumpy-sphere", &bvh::UNBALANCED),
            (Slip::SearchesShadows, "soup", &bvh::SHADOWS_SEARCH_ON),
            (Slip::ShadowsByTheLoop, "soup", &bvh::SHADOWS_WITHOUT_BVH),
            (Slip::ShadowsByTheLoopToTheFirst, "soup", &bvh::SHADOWS_WITHOUT_BVH),
        ] {
            let finding = found(slip, mesh);
            assert_eq!(causes(&finding), [cause.name]);
            assert!(finding.statement.ends_with(cause.headline), "{}", finding.statement);
        }
    }

    #[test]
    fn boxes_visited_for_nothing_are_named_though_they_pass() {
        let finding = found(Slip::NeverShortens, "soup");
        assert_passes(&finding);
        let headline = bvh::SEGMENT_NOT_SHORTENED.headline;
        assert!(finding.statement.ends_with(headline), "{}", finding.statement);
    }

    #[test]
    fn counts_that_are_not_real_fail() {
        let size = Size { triangles: 512.0, hits: 0.5, ordered: 20.0, ..Size::default() };
        assert!(failure(&super::judge(&[size])).contains("its counts are not real"));
    }
}
