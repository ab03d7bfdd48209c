//! Part 1: triangle and sphere.

use super::Fault;
use crate::cause::shape;
use crate::cores::textbook::change::Change;

const INTERPOLATION: &str = "shape/shading-normals-are-interpolated";
const TRIANGLE: &str = "shape/ray-triangle-hits-are-right";
const IN_PLANE: &str = "shape/rays-in-the-plane-of-a-triangle-miss";
const RANDOM: &str = "shape/random-triangles-match-exact-arithmetic";
const SEGMENT: &str = "shape/hits-lie-between-t-min-and-t-max";
const SPHERE: &str = "shape/ray-sphere-hit-is-the-nearest-root-ahead";

/// In the order of the lecture.
pub const FAULTS: &[Fault] = &[
    Fault {
        change: Change::NormalsSwapped,
        name: "vertex-normals-swapped",
        part: 1,
        summary: "barycentric weights multiply the wrong vertex normals",
        caught_by: INTERPOLATION,
        cause: &shape::NORMALS_SWAPPED,
    },
    Fault {
        change: Change::NormalNotNormalised,
        name: "interpolated-normal-not-unit",
        part: 1,
        summary: "the interpolated normal is not normalised",
        caught_by: INTERPOLATION,
        cause: &shape::NORMAL_NOT_UNIT,
    },
    Fault {
        change: Change::FlatShading,
        name: "flat-shading",
        part: 1,
        summary: "the geometric normal is used for shading",
        caught_by: INTERPOLATION,
        cause: &shape::FLAT_SHADING_NORMAL,
    },
    Fault {
        change: Change::NormalsFaceRay,
        name: "normals-face-ray",
        part: 1,
        summary: "normals are turned towards the ray",
        caught_by: TRIANGLE,
        cause: &shape::NORMALS_FACE_RAY,
    },
    Fault {
        change: Change::DeterminantThreshold,
        name: "determinant-threshold",
        part: 1,
        summary: "a determinant below 1e-5 counts as parallel",
        caught_by: RANDOM,
        cause: &shape::DETERMINANT_THRESHOLD,
    },
    Fault {
        change: Change::StrictEdges,
        name: "strict-edges",
        part: 1,
        summary: "u > 0, v > 0, u + v < 1: edges belong to no triangle",
        caught_by: "shape/rays-at-a-shared-edge-hit-one-triangle",
        cause: &shape::EDGES_EXCLUDED,
    },
    Fault {
        change: Change::Parallelogram,
        name: "triangle-is-a-parallelogram",
        part: 1,
        summary: "v ≤ 1 in place of u + v ≤ 1",
        caught_by: TRIANGLE,
        cause: &shape::PARALLELOGRAM,
    },
    Fault {
        change: Change::BackCulled,
        name: "back-faces-culled",
        part: 1,
        summary: "determinant < 0 counts as a miss",
        caught_by: TRIANGLE,
        cause: &shape::BACK_CULLED,
    },
    Fault {
        change: Change::NanAccepted,
        name: "nan-hit-accepted",
        part: 1,
        summary: "no test for parallel rays, and comparisons that reject: NaN is a hit",
        caught_by: IN_PLANE,
        cause: &shape::NAN_HIT_ACCEPTED,
    },
    Fault {
        change: Change::TriangleEndIgnored,
        name: "triangle-ignores-t-max",
        part: 1,
        summary: "the triangle's t is compared with min_t only",
        caught_by: SEGMENT,
        cause: &shape::SEGMENT_END_IGNORED,
    },
    Fault {
        change: Change::NearRootOnly,
        name: "sphere-near-root-only",
        part: 1,
        summary: "only the nearer root is considered",
        caught_by: SPHERE,
        cause: &shape::NEAR_ROOT_ONLY,
    },
    Fault {
        change: Change::BothRootsRequired,
        name: "sphere-both-roots-required",
        part: 1,
        summary: "a sphere is hit only if both roots lie in the range",
        caught_by: SPHERE,
        cause: &shape::BOTH_ROOTS_REQUIRED,
    },
    Fault {
        change: Change::FirstRootUnchecked,
        name: "sphere-first-root-unchecked",
        part: 1,
        summary: "t1 is reported although only t2 is valid",
        caught_by: SPHERE,
        cause: &shape::FIRST_ROOT_UNCHECKED,
    },
    Fault {
        change: Change::FarRootTaken,
        name: "sphere-far-root",
        part: 1,
        summary: "the swap is the wrong way round: the far root is used",
        caught_by: SPHERE,
        cause: &shape::FAR_ROOT_TAKEN,
    },
    Fault {
        change: Change::SphereBehindHit,
        name: "sphere-behind-hit",
        part: 1,
        summary: "roots are not compared with min_t",
        caught_by: SPHERE,
        cause: &shape::HITS_BEHIND_ORIGIN,
    },
    Fault {
        change: Change::QuadraticPrecedence,
        name: "quadratic-precedence",
        part: 1,
        summary: "`/ 2 * a` in place of `/ (2 * a)`",
        caught_by: SPHERE,
        cause: &shape::QUADRATIC_PRECEDENCE,
    },
    Fault {
        change: Change::SphereCancellation,
        name: "sphere-cancellation",
        part: 1,
        summary: "b² − 4ac as it stands: far spheres lose their digits",
        caught_by: "shape/distant-spheres-do-not-cancel",
        cause: &shape::SPHERE_CANCELLATION,
    },
    Fault {
        change: Change::SphereNormalNotUnit,
        name: "sphere-normal-not-unit",
        part: 1,
        summary: "the normal of a sphere has the length of its radius",
        caught_by: SPHERE,
        cause: &shape::NORMAL_NOT_UNIT,
    },
];
