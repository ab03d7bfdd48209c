//! Small triangles strewn along a long box, along each axis in turn: rays across it need few tests if nodes are
//! divided along the length. Counts, which no clock and no machine can change.

use super::question::scene_of;
use super::reference::{ReferenceBvh, SLACK, Walk};
use super::stops_behind_hits::tests_per_ray;
use crate::cause::{Cause, bvh};
use crate::checks::phrase::{at_most, figure};
use crate::checks::{Check, CheckError, Context, Finding};
use crate::contract::{Acceleration, Capabilities, Ray};
use crate::math::rng::{Seed, Stream, uniform};
use crate::math::sphere::on_sphere;
use crate::scene::Mesh;
use crate::stats::Verdict;
use crate::text::Count;
use glam::DVec3;
use serde::Deserialize;

/// Triangles, each of about this size, in a box of 1 × 1 × so much.
const TRIANGLES: u32 = 2048;
const SIZE: f64 = 0.2;
const LENGTH: f64 = 200.0;
/// Even one that never divides along the length passes by more than half of the triangles.
const UNUSED: f64 = 0.5;

/// Scenes that are long in x, in y and in z take equally few tests.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DividesLongScenes {
    /// Across each of them.
    rays: Count,
}

impl Check for DividesLongScenes {
    const NAME: &'static str = "divides-long-scenes";
    const SUMMARY: &'static str = "tests per ray across scenes that are long in x, y or z";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE | Capabilities::INTERSECT | Capabilities::TRAVERSAL_STATS
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let mut tried = Vec::new();
        for axis in 0..3 {
            let stream = &mut context.seed.child(axis).stream();
            let mesh = long_mesh(axis);
            let rays: Vec<_> = (0..count).map(|_| ray_across(axis, stream)).collect();
            let plain = ReferenceBvh::new(&mesh).tests_per_ray(&rays, Walk::Ordered);
            let scene = scene_of(mesh);
            let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
            tried.push(Tried { axis, tests: tests_per_ray(built.as_mut(), &rays)?, plain });
        }
        Ok(judge(&tried))
    }
}

/// The same numbers for each axis.
fn long_mesh(axis: usize) -> Mesh {
    let stream = &mut Seed(1).stream();
    let mut mesh = Mesh::default();
    for number in 0..TRIANGLES {
        let centre = point_in_box(axis, stream);
        let corners = [(); 3].map(|()| centre + 0.5 * SIZE * on_sphere(stream));
        mesh.positions.extend(corners);
        mesh.indices.push([0, 1, 2].map(|corner| 3 * number + corner));
    }
    mesh
}

fn point_in_box(axis: usize, stream: &mut Stream) -> DVec3 {
    let mut point = DVec3::from_array(std::array::from_fn(|_| uniform(stream)));
    point[axis] *= LENGTH;
    point
}

/// From outside, at right angles to the length.
fn ray_across(axis: usize, stream: &mut Stream) -> Ray {
    let target = point_in_box(axis, stream);
    let mut direction = on_sphere(stream);
    direction[axis] = 0.0;
    let direction = direction.normalize_or(DVec3::ONE);
    Ray::new(target - 3.0 * direction, direction)
}

/// One scene.
struct Tried {
    axis: usize,
    tests: f64,
    /// Of a plain hierarchy.
    plain: f64,
}

impl Tried {
    fn name(&self) -> &'static str {
        ["x", "y", "z"][self.axis]
    }

    fn is_slow(&self) -> bool {
        self.tests > SLACK * self.plain
    }
}

fn judge(tried: &[Tried]) -> Finding {
    let name =
        |tried: &Tried| format!("tests a ray across a scene that is long in {}", tried.name());
    let measures: Vec<_> =
        tried.iter().map(|scene| at_most(name(scene), scene.tests, SLACK * scene.plain)).collect();
    let told = |tried: &Tried| {
        let [tests, plain] = [tried.tests, tried.plain].map(figure);
        format!("{tests} where it is long in {}, a plain hierarchy {plain}", tried.name())
    };
    let told = tried.iter().map(told).collect::<Vec<_>>().join("; ");
    let failed = measures.iter().any(|measure| measure.verdict == Verdict::Fail);
    let cause = if failed { cause(tried) } else { None };
    let why = cause.map_or_else(String::new, |cause| format!(": {}", cause.headline));
    let statement = format!("of {TRIANGLES} triangles a ray tests {told}{why}");
    Finding::of(statement, "would have caught four times the tests along one axis", measures)
        .because_each(cause, &told)
}

/// Which axes are slow says it all.
fn cause(tried: &[Tried]) -> Option<&'static Cause> {
    let slow: Vec<_> = tried.iter().filter(|scene| scene.is_slow()).map(Tried::name).collect();
    match slow.as_slice() {
        _ if tried.iter().all(|scene| scene.tests >= UNUSED * f64::from(TRIANGLES)) => {
            Some(&bvh::HIERARCHY_NOT_USED)
        }
        ["z"] => Some(&bvh::Z_NEVER_SPLIT),
        ["x", "y", "z"] => Some(&bvh::SHORTEST_AXIS),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, judge};

    #[test]
    fn a_plain_hierarchy_passes() {
        let check: DividesLongScenes = check_of("[expect]\nrays = 200");
        assert_passes(&judge(&check, &mut FakeCore(Slip::None)));
    }

    #[test]
    fn the_axes_that_are_slow_name_the_mistake() {
        let told = |tests: [f64; 3]| {
            let scene = |axis| Tried { axis, tests: tests[axis], plain: 10.0 };
            let finding = super::judge(&[scene(0), scene(1), scene(2)]);
            finding.clues.first().map(|clue| clue.cause.clone())
        };
        assert_eq!(told([10.0, 12.0, 9.0]), None);
        assert_eq!(told([10.0, 12.0, 90.0]).as_deref(), Some("z-never-split"));
        assert_eq!(told([80.0, 90.0, 90.0]).as_deref(), Some("shortest-axis"));
        assert_eq!(told([2048.0; 3]).as_deref(), Some("bvh-not-used"));
        assert_eq!(told([1196.0, 1321.0, 1249.0]).as_deref(), Some("bvh-not-used"));
    }
}
