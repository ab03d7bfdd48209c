//! Triangles tested a ray where an arrangement shows what a BVH does wrong, against a plain BVH. Counts,
//! which no clock and no machine can change.

use super::arrangement::{Arrangement, LAYERS, TRIANGLES, View, across_long_boxes, through_layers};
use super::question::scene_of;
use super::reference::{ReferenceBvh, Walk};
use crate::cause::{Cause, bvh};
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Hit, Ray};
use crate::text::Count;
use serde::Deserialize;

/// A core may test this many times the triangles that a plain median BVH tests.
const SLACK: f64 = 4.0;
/// Even a BVH that never divides along the length passes by more than half of the triangles.
const UNUSED: f64 = 0.5;

check! {
    /// The number of tests is that of a plain BVH, or not much larger.
    pub(crate) struct TestsPerRay {
        arrangement: Arrangement,
        /// From each side.
        rays: Count,
        #[serde(default)]
        sides: Sides,
    }
    name: "tests-per-ray",
    summary: "tests per ray where layers hide each other, or boxes are long",
    needs: BUILD_SCENE | INTERSECT | TRAVERSAL_STATS,
}

/// From which sides few tests are due.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Sides {
    #[default]
    Each,
    /// From one: which child is visited first is free.
    Better,
}

impl Check for TestsPerRay {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let views = match self.arrangement {
            Arrangement::Layers => through_layers(count, context.seed),
            Arrangement::LongBoxes => across_long_boxes(count, context.seed),
        };
        let tried: Result<Vec<_>, _> =
            views.into_iter().map(|view| view.put_to(context, self.arrangement)).collect();
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
    /// The same of rays that end just behind what they hit first, in the core and in a plain BVH.
    ending: Option<[f64; 2]>,
    /// The same of rays that are no longer than from before the middle layer to behind it.
    within: Option<[f64; 2]>,
}

impl View {
    fn put_to(
        self,
        context: &mut Context<'_>,
        arrangement: Arrangement,
    ) -> Result<Tried, CheckError> {
        let bvh = ReferenceBvh::new(&self.mesh);
        let [plain, unshortened] =
            [Walk::Ordered, Walk::Unshortened].map(|walk| bvh.tests_per_ray(&self.rays, walk));
        let unsorted = ReferenceBvh::unsorted(&self.mesh).tests_per_ray(&self.rays, Walk::Ordered);
        let scene = scene_of(self.mesh);
        let mut built = context.core.build_scene(&scene, Acceleration::COUNTED)?;
        let mut tests_of = |rays: &[Ray]| -> Result<f64, CheckError> {
            let stats = built.intersect(rays, &mut vec![Hit::MISS; rays.len()])?;
            Ok(stats.primitive_tests as f64 / rays.len() as f64)
        };
        let tests = tests_of(&self.rays)?;
        let mut beside_plain = |rays: &[Ray]| -> Result<_, CheckError> {
            Ok(Some([tests_of(rays)?, bvh.tests_per_ray(rays, Walk::Ordered)]))
        };
        let [ending, within] = match arrangement {
            Arrangement::LongBoxes => [None; 2],
            Arrangement::Layers => [
                beside_plain(&ending_at_first_hits(&bvh, &self.rays))?,
                beside_plain(&within_the_middle(&bvh, &self.rays))?,
            ],
        };
        Ok(Tried { name: self.name, tests, plain, unshortened, unsorted, ending, within })
    }
}

/// The rays that hit, each until halfway to the next layer.
fn ending_at_first_hits(bvh: &ReferenceBvh, rays: &[Ray]) -> Vec<Ray> {
    let first = |ray: &Ray| bvh.walk(ray, Walk::Ordered).nearest;
    let ending = |ray: &Ray| Some(Ray { t_max: first(ray)?.0 + 0.5, ..*ray });
    rays.iter().filter_map(ending).collect()
}

/// The rays that hit, each from halfway before the middle layer to halfway behind it. Where leaves have layers of anywhere,
/// few of them reach as far as the first.
fn within_the_middle(bvh: &ReferenceBvh, rays: &[Ray]) -> Vec<Ray> {
    let piece = |ray: &Ray| {
        let to_next = 1.0 / ray.direction.z.abs();
        let first = bvh.walk(ray, Walk::Ordered).nearest?.0;
        let t_min = first + (f64::from(LAYERS / 2) - 0.5) * to_next;
        Some(Ray { t_min, t_max: t_min + to_next, ..*ray })
    };
    rays.iter().filter_map(piece).collect()
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

    /// Whether nodes lie across the layers, however they are walked: even rays that meet one layer alone test many.
    fn mixes_layers(&self) -> bool {
        let mut of_one_layer = [self.ending, self.within].into_iter().flatten();
        of_one_layer.any(|[tests, plain]| tests > SLACK * plain)
    }

    fn measure(&self) -> Measure {
        Measure::at_most("tests a ray", self.tests, SLACK * self.plain).of_row(self.name)
    }

    fn measure_of_ending(&self) -> Option<Measure> {
        let [tests, plain] = self.ending?;
        let measure = Measure::at_most("tests a ray that ends there", tests, SLACK * plain);
        Some(measure.of_row(self.name))
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
        let measures = self.measures(tried);
        let finding = Finding::of(&tested, "would have caught four times the tests", measures);
        let cause = finding.failed().then(|| self.cause(tried)).flatten();
        let explained = cause.map(|cause| format!("{tested}: {}", cause.headline));
        finding.complaining(explained).because_each(cause, &told)
    }

    fn measures(&self, tried: &[Tried]) -> Vec<Measure> {
        let of_ends = tried.iter().filter_map(Tried::measure_of_ending);
        match self.sides {
            Sides::Each => tried.iter().map(Tried::measure).chain(of_ends).collect(),
            Sides::Better => better(tried).into_iter().chain(of_ends).collect(),
        }
    }

    fn cause(&self, tried: &[Tried]) -> Option<&'static Cause> {
        let all_test =
            |share: f64| tried.iter().all(|view| view.tests >= share * f64::from(TRIANGLES));
        let slow: Vec<_> = tried.iter().filter(|view| view.is_slow()).map(|v| v.name).collect();
        match (self.arrangement, slow.as_slice()) {
            (Arrangement::Layers, _) if all_test(1.0) => Some(&bvh::BVH_NOT_USED),
            (Arrangement::Layers, _) if tried.iter().any(Tried::mixes_layers) => None,
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

/// A walk in any order has few tests from one side at least, and fewer than one that nothing shortens if it draws lots.
fn better(tried: &[Tried]) -> Option<Measure> {
    let best = tried.iter().min_by(|a, b| a.tests.total_cmp(&b.tests))?;
    let most = (SLACK * best.plain).max(best.unshortened / SLACK);
    Some(Measure::at_most("tests a ray, from the better side", best.tests, most).of_row(best.name))
}

#[cfg(test)]
mod tests {
    use super::super::arrangement::layers;
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, judge};
    use crate::math::rng::Seed;

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
    fn which_child_is_visited_first_is_free_from_the_better_side() {
        let found = |slip| found("layers\"\nsides = \"better", slip);
        assert_passes(&found(Slip::None));
        assert_passes(&found(Slip::NeverOrders));
        assert_eq!(causes(&found(Slip::NeverShortens)), ["t-max-not-shortened"]);
        assert_eq!(causes(&found(Slip::TestsEverything)), ["bvh-not-used"]);
    }

    #[test]
    fn nodes_that_divide_nothing_are_not_the_walk() {
        let told = |ending: [f64; 2], within: [f64; 2]| {
            let check = layers_from_each_side();
            let [ending, within] = [Some(ending), Some(within)];
            let tried = ["from below", "from above"].map(|name| Tried {
                ending,
                within,
                ..tried(name, 260.0, 4.0)
            });
            let finding = check.judge(&tried);
            (finding.failed(), finding.clues.first().map(|clue| clue.cause.clone()))
        };
        let not_shortened = || Some("t-max-not-shortened".to_owned());
        assert_eq!(told([4.0, 4.0], [4.0, 4.0]), (true, not_shortened()));
        assert_eq!(told([240.0, 4.0], [4.0, 4.0]), (true, None));
        assert_eq!(told([4.0, 4.0], [70.0, 4.0]), (true, None));
    }

    #[test]
    fn leaves_with_layers_of_anywhere_are_seen_from_the_middle_alone() {
        let mut mesh = layers();
        let of_one = mesh.indices.len() / LAYERS as usize;
        let shuffled = (0..LAYERS as usize).map(|layer| 27 * layer % LAYERS as usize);
        let in_columns =
            (0..of_one).flat_map(|place| shuffled.clone().map(move |layer| layer * of_one + place));
        mesh.indices = in_columns.map(|number| mesh.indices[number]).collect();
        let [plain, mixed] = [ReferenceBvh::new(&mesh), ReferenceBvh::unsorted(&mesh)];
        for view in through_layers(200, Seed(1)) {
            let is_slow = |rays: &[Ray]| {
                let [tests, due] =
                    [&mixed, &plain].map(|bvh| bvh.tests_per_ray(rays, Walk::Ordered));
                tests > SLACK * due
            };
            assert!(!is_slow(&ending_at_first_hits(&plain, &view.rays)), "{}", view.name);
            assert!(is_slow(&within_the_middle(&plain, &view.rays)), "{}", view.name);
        }
    }

    fn layers_from_each_side() -> TestsPerRay {
        TestsPerRay { arrangement: Arrangement::Layers, rays: Count(1), sides: Sides::Each }
    }

    fn tried(name: &'static str, tests: f64, plain: f64) -> Tried {
        Tried {
            name,
            tests,
            plain,
            unshortened: 256.0,
            unsorted: 256.0,
            ending: None,
            within: None,
        }
    }

    #[test]
    fn more_tests_than_any_walk_makes_are_not_the_walk() {
        let told = |tests: [f64; 2]| {
            let names = ["from below", "from above"];
            let tried = [0, 1].map(|i| tried(names[i], tests[i], 4.0));
            layers_from_each_side().judge(&tried).clues.first().map(|clue| clue.cause.clone())
        };
        assert_eq!(told([256.0; 2]).as_deref(), Some("t-max-not-shortened"));
        assert_eq!(told([16.5, 611.0]).as_deref(), Some("children-unordered"));
        assert_eq!(told([1084.0, 1059.0]), None);
    }

    #[test]
    fn the_axes_that_are_slow_name_the_mistake() {
        let told = |tests: [f64; 3]| {
            let arrangement = Arrangement::LongBoxes;
            let check = TestsPerRay { arrangement, rays: Count(1), sides: Sides::Each };
            let names = ["along x", "along y", "along z"];
            let tried = [0, 1, 2].map(|i| Tried {
                unshortened: 30.0,
                unsorted: 980.0,
                ..tried(names[i], tests[i], 10.0)
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
