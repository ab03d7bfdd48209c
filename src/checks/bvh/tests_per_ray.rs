//! Triangles tested a ray where an arrangement shows what a BVH does wrong, against a plain BVH. Counts,
//! which no clock and no machine can change.

use super::arrangement::{Arrangement, TRIANGLES, View, across_long_boxes, through_layers};
use super::question::scene_of;
use super::reference::{ReferenceBvh, SLACK, Walk};
use crate::cause::{Cause, bvh};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Hit};
use crate::text::Count;

/// Even a BVH that never divides along the length passes by more than half of the triangles.
const UNUSED: f64 = 0.5;

check! {
    /// The number of tests is that of a plain BVH, or not much larger.
    pub(crate) struct TestsPerRay {
        arrangement: Arrangement,
        /// From each side.
        rays: Count,
    }
    name: "tests-per-ray",
    summary: "tests per ray where layers hide each other, or boxes are long",
    needs: BUILD_SCENE | INTERSECT | TRAVERSAL_STATS,
}

impl Check for TestsPerRay {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let views = match self.arrangement {
            Arrangement::Layers => through_layers(count, context.seed),
            Arrangement::LongBoxes => across_long_boxes(count, context.seed),
        };
        let tried: Result<Vec<_>, _> = views.into_iter().map(|view| view.put_to(context)).collect();
        Ok(self.judge(&tried?))
    }
}

/// Other leaves than those of a plain BVH change the tests of the same walk by up to this factor.
const OTHER_LEAVES: f64 = 3.0;

/// A BVH that splits the shortest axis needs about 0.7 of the tests of one that divides nothing; counts that are about
/// the latter's are not of an axis.
const DIVIDES_NOTHING: f64 = 0.8;

/// What came of it.
struct Tried {
    name: &'static str,
    tests: f64,
    /// Of a plain BVH.
    plain: f64,
    /// Of a plain BVH whose walk never shortens the ray.
    unshortened: f64,
    /// Of a plain BVH that leaves the triangles where they are listed.
    unsorted: f64,
}

impl View {
    fn put_to(self, context: &mut Context<'_>) -> Result<Tried, CheckError> {
        let bvh = ReferenceBvh::new(&self.mesh);
        let [plain, unshortened] =
            [Walk::Ordered, Walk::Unshortened].map(|walk| bvh.tests_per_ray(&self.rays, walk));
        let unsorted = ReferenceBvh::unsorted(&self.mesh).tests_per_ray(&self.rays, Walk::Ordered);
        let scene = scene_of(self.mesh);
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut hits = vec![Hit::MISS; self.rays.len()];
        let stats = built.intersect(&self.rays, &mut hits)?;
        let tests = stats.primitive_tests as f64 / self.rays.len() as f64;
        Ok(Tried { name: self.name, tests, plain, unshortened, unsorted })
    }
}

impl Tried {
    fn is_slow(&self) -> bool {
        self.tests > SLACK * self.plain
    }

    /// As a walk that nothing shortens does.
    fn meets_all_layers(&self) -> bool {
        self.tests >= self.unshortened / OTHER_LEAVES
    }

    /// More tests would be of nodes that lie across the layers, however they are walked.
    fn divides_layers(&self) -> bool {
        self.tests <= OTHER_LEAVES * self.unshortened
    }

    fn measure(&self) -> Measure {
        Measure::at_most("tests a ray", self.tests, SLACK * self.plain).of_row(self.name)
    }

    fn words(&self) -> String {
        let [tests, plain] = [self.tests, self.plain].map(figure);
        format!("{tests} {}, a plain BVH {plain}", self.name)
    }
}

impl TestsPerRay {
    fn judge(&self, tried: &[Tried]) -> Finding {
        let told = tried.iter().map(Tried::words).collect::<Vec<_>>().join("; ");
        let tested = format!("triangles tested a ray: {told}");
        let measures = tried.iter().map(Tried::measure).collect();
        let finding = Finding::of(&tested, "would have caught four times the tests", measures);
        let cause = finding.failed().then(|| self.cause(tried)).flatten();
        let explained = cause.map(|cause| format!("{tested}: {}", cause.headline));
        finding.complaining(explained).because_each(cause, &told)
    }

    fn cause(&self, tried: &[Tried]) -> Option<&'static Cause> {
        let all_test =
            |share: f64| tried.iter().all(|view| view.tests >= share * f64::from(TRIANGLES));
        let slow: Vec<_> = tried.iter().filter(|view| view.is_slow()).map(|v| v.name).collect();
        match (self.arrangement, slow.as_slice()) {
            (Arrangement::Layers, _) if all_test(1.0) => Some(&bvh::BVH_NOT_USED),
            (Arrangement::Layers, _) if !tried.iter().all(Tried::divides_layers) => None,
            (Arrangement::Layers, _) => {
                match tried.iter().filter(|view| view.meets_all_layers()).count() {
                    2 => Some(&bvh::SEGMENT_NOT_SHORTENED),
                    1 => Some(&bvh::CHILDREN_UNORDERED),
                    _ => None,
                }
            }
            (Arrangement::LongBoxes, _) if all_test(UNUSED) => Some(&bvh::BVH_NOT_USED),
            (Arrangement::LongBoxes, ["along z"]) => Some(&bvh::Z_NEVER_SPLIT),
            (Arrangement::LongBoxes, [_, _, _]) => {
                let sum = |of: fn(&Tried) -> f64| tried.iter().map(of).sum::<f64>();
                let divides = sum(|t| t.tests) < DIVIDES_NOTHING * sum(|t| t.unsorted);
                divides.then_some(&bvh::SHORTEST_AXIS)
            }
            (Arrangement::LongBoxes, _) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::arrangement::layers;
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, judge};

    fn found(arrangement: &str, slip: Slip) -> Finding {
        let text = format!("[expect]\narrangement = \"{arrangement}\"\nrays = 200");
        judge(&check_of::<TestsPerRay>(&text), &mut FakeCore(slip))
    }

    #[test]
    fn an_ordered_walk_of_a_plain_bvh_passes() {
        assert_eq!(layers().indices.len(), TRIANGLES as usize);
        assert_passes(&found("layers", Slip::None));
        assert_passes(&found("long-boxes", Slip::None));
    }

    #[test]
    fn walks_that_test_what_is_hidden_fail_and_are_named() {
        for (slip, cause) in [
            (Slip::NeverShortens, "t-max-not-shortened"),
            (Slip::NeverOrders, "children-unordered"),
            (Slip::TestsEverything, "bvh-not-used"),
        ] {
            assert_eq!(causes(&found("layers", slip)), [cause]);
        }
    }

    #[test]
    fn more_tests_than_any_walk_makes_are_not_the_walk() {
        let told = |tests: [f64; 2]| {
            let check = TestsPerRay { arrangement: Arrangement::Layers, rays: Count(1) };
            let names = ["from below", "from above"];
            let tried = [0, 1].map(|i| Tried {
                name: names[i],
                tests: tests[i],
                plain: 4.0,
                unshortened: 256.0,
                unsorted: 256.0,
            });
            check.judge(&tried).clues.first().map(|clue| clue.cause.clone())
        };
        assert_eq!(told([256.0; 2]).as_deref(), Some("t-max-not-shortened"));
        assert_eq!(told([16.5, 611.0]).as_deref(), Some("children-unordered"));
        assert_eq!(told([1084.0, 1059.0]), None);
    }

    #[test]
    fn the_axes_that_are_slow_name_the_mistake() {
        let told = |tests: [f64; 3]| {
            let check = TestsPerRay { arrangement: Arrangement::LongBoxes, rays: Count(1) };
            let names = ["along x", "along y", "along z"];
            let tried = [0, 1, 2].map(|i| Tried {
                name: names[i],
                tests: tests[i],
                plain: 10.0,
                unshortened: 30.0,
                unsorted: 980.0,
            });
            check.judge(&tried).clues.first().map(|clue| clue.cause.clone())
        };
        assert_eq!(told([10.0, 12.0, 9.0]), None);
        assert_eq!(told([10.0, 12.0, 90.0]).as_deref(), Some("z-never-split"));
        assert_eq!(told([80.0, 90.0, 90.0]).as_deref(), Some("shortest-axis"));
        assert_eq!(told([913.0, 843.0, 871.0]), None);
        assert_eq!(told([2048.0; 3]).as_deref(), Some("bvh-not-used"));
        assert_eq!(told([1196.0, 1321.0, 1249.0]).as_deref(), Some("bvh-not-used"));
    }
}
