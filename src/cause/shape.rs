//! Part 1: triangles and spheres.

use super::{Cause, causes};

causes! {
    SEGMENT_END_IGNORED = "segment-end-ignored":
        "the intersection test ignores t_max",
        at "the intersection test, where t is compared",
        fix "A hit counts only if t_min < t < t_max.";
    SEGMENT_START_IGNORED = "segment-start-ignored":
        "the intersection test ignores t_min",
        at "the intersection test, where t is compared",
        fix "A hit counts only if t_min < t < t_max.";
    SEGMENT_IGNORED = "segment-ignored":
        "the intersection test ignores t_min and t_max",
        at "the intersection test, where t is compared",
        fix "A hit counts only if t_min < t < t_max.";
    HITS_BEHIND_ORIGIN = "hits-behind-origin":
        "surfaces behind the ray's origin are hit",
        at "the intersection test, where t is compared",
        fix "A hit counts only if t_min < t < t_max.";
    NEAR_ROOT_ONLY = "near-root-only":
        "only the nearer root is tried, so rays that start inside the sphere miss",
        at "the ray-sphere test, where the root of the quadratic is chosen",
        fix "If the nearer root lies outside (t_min, t_max), try the farther one.";
    FAR_ROOT_TAKEN = "far-root-taken":
        "the farther root is used where the nearer one is valid",
        at "the ray-sphere test, where the root of the quadratic is chosen",
        fix "Take the smallest root inside (t_min, t_max).";
    QUADRATIC_WITHOUT_A = "quadratic-without-a":
        "the quadratic omits a = d·d, which is 1 only for unit directions",
        at "the ray-sphere test, where the quadratic is solved",
        fix "t = (−b ± √(b² − 4ac)) / (2a), with a = d·d.";
    QUADRATIC_DIVIDES_BY_A = "quadratic-divides-by-a":
        "the quadratic formula divides by a, not 2a",
        at "the ray-sphere test, where the quadratic is solved",
        fix "t = (−b ± √(b² − 4ac)) / (2a): mind the parentheses around 2a.";
    T_IN_SCENE_UNITS = "t-in-scene-units":
        "the hit distance t counts scene units, not lengths of the ray's direction vector",
        at "the intersection test, where t is computed",
        fix "The hit point is origin + t · direction, whatever the length of the direction.";
    MISSED_IF_CENTRE_BEHIND = "sphere-missed-from-inside":
        "a sphere is missed if its centre lies behind the ray's origin, though the origin may be inside",
        at "the ray-sphere test, where spheres behind the origin are rejected",
        fix "Only where the origin is outside is a sphere with its centre behind it missed.";
    PARALLELOGRAM = "parallelogram":
        "the test u + v ≤ 1 is missing: the triangle has become a parallelogram",
        at "the ray-triangle test, where the barycentric coordinates are compared",
        fix "All three barycentric coordinates must be ≥ 0; the third is 1 − u − v.";
    V_NOT_COMPARED = "v-not-compared":
        "the barycentric test b1 ≥ 0 is missing",
        at "the ray-triangle test, where the barycentric coordinates are compared",
        fix "All three barycentric coordinates must be ≥ 0.";
    W_NOT_COMPARED = "w-not-compared":
        "the barycentric test b2 ≥ 0 is missing",
        at "the ray-triangle test, where the barycentric coordinates are compared",
        fix "All three barycentric coordinates must be ≥ 0.";
    WHOLE_PLANE_HIT = "whole-plane-hit":
        "the whole plane of the triangle is hit: the barycentric tests are missing",
        at "the ray-triangle test, where the barycentric coordinates are compared",
        fix "All three barycentric coordinates must be ≥ 0.";
    BACK_CULLED = "back-culled":
        "back faces are culled",
        at "the ray-triangle test, where the determinant is compared",
        fix "Triangles are hit from both sides: compare the determinant with 0 only to reject parallel rays.";
    FRONT_CULLED = "front-culled":
        "front faces are culled",
        at "the ray-triangle test, where the determinant is compared",
        fix "Triangles are hit from both sides: compare the determinant with 0 only to reject parallel rays.";
    DETERMINANT_THRESHOLD = "determinant-threshold":
        "small triangles are missed: their determinant is compared with a fixed epsilon",
        at "the ray-triangle test, where parallel rays are rejected",
        fix "Reject only a determinant of exactly 0: its size scales with the triangle and says nothing about parallelism.";
    BARYCENTRICS_SWAPPED = "barycentrics-swapped":
        "the barycentric coordinates of v1 and v2 are swapped",
        at "the ray-triangle test, where normals are interpolated",
        fix "b1 belongs to the edge v1 − v0, b2 to the edge v2 − v0.";
    NORMALS_SWAPPED = "normals-swapped":
        "the vertex normals of v1 and v2 are swapped in the interpolation",
        at "the ray-triangle test, where normals are interpolated",
        fix "Multiply each vertex normal by its own vertex's barycentric coordinate.";
    BARYCENTRICS_MOVED_ON = "barycentrics-moved-on":
        "the barycentric coordinates are rotated by one vertex: v0 gets that of v1",
        at "the ray-triangle test, where normals are interpolated",
        fix "Möller and Trumbore's u and v are the barycentric coordinates of v1 and v2; that of v0 is 1 − u − v.";
    NORMALS_MOVED_ON = "normals-moved-on":
        "the normals are interpolated with barycentric coordinates rotated by one vertex: n0 gets b1",
        at "the ray-triangle test, where normals are interpolated",
        fix "n = (1 − b1 − b2) n0 + b1 n1 + b2 n2.";
    BARYCENTRICS_MOVED_BACK = "barycentrics-moved-back":
        "the barycentric coordinates are rotated by one vertex: v0 gets that of v2",
        at "the ray-triangle test, where normals are interpolated",
        fix "Möller and Trumbore's u and v are the barycentric coordinates of v1 and v2; that of v0 is 1 − u − v.";
    NORMALS_MOVED_BACK = "normals-moved-back":
        "the normals are interpolated with barycentric coordinates rotated by one vertex: n0 gets b2",
        at "the ray-triangle test, where normals are interpolated",
        fix "n = (1 − b1 − b2) n0 + b1 n1 + b2 n2.";
    FLAT_SHADING_NORMAL = "flat-shading-normal":
        "the shading normal is the geometric normal, not the interpolated one",
        at "the intersection record, where normals are written",
        fix "Interpolate the shading normal from the vertex normals, then normalise it.";
    GEOMETRIC_NORMAL_INTERPOLATED = "geometric-normal-interpolated":
        "the geometric normal is the interpolated shading normal",
        at "the intersection record, where normals are written",
        fix "The geometric normal is the normalised cross product of two edges.";
    NORMALS_FACE_RAY = "normals-face-ray":
        "normals are flipped to face the ray",
        at "the intersection record, where normals are written",
        fix "Keep the normal on the side given by the winding order, wherever the ray comes from.";
    NORMALS_INSIDE_OUT = "normals-inside-out":
        "normals point to the wrong side",
        at "the intersection record, where normals are written",
        fix "A sphere's normal is (point − centre) / radius; a triangle's is (v1 − v0) × (v2 − v0).";
    BOTH_ROOTS_REQUIRED = "both-roots-required":
        "both roots must lie in (t_min, t_max), so spheres that t_min or t_max cuts are missed",
        at "the ray-sphere test, where the root of the quadratic is chosen",
        fix "One root inside (t_min, t_max) is enough: take the smallest such root.";
    FIRST_ROOT_UNCHECKED = "first-root-unchecked":
        "the nearer root is reported even where only the farther one lies in (t_min, t_max)",
        at "the ray-sphere test, where the root of the quadratic is chosen",
        fix "Report the root that passed the test against (t_min, t_max).";
    NORMAL_AT_OTHER_ROOT = "normal-at-other-root":
        "the normal of a sphere is taken at the nearer root, also where the farther one is hit",
        at "the ray-sphere test, where normals are written",
        fix "Take the point of the normal at the root that is reported.";
    QUADRATIC_PRECEDENCE = "quadratic-precedence":
        "the quadratic is divided by 2 and multiplied by a: `/ 2 * a` is not `/ (2 * a)`",
        at "the ray-sphere test, where the quadratic is solved",
        fix "t = (−b ± √(b² − 4ac)) / (2a): mind the parentheses around 2a.";
    SPHERE_CANCELLATION = "sphere-cancellation":
        "catastrophic cancellation in b² − 4ac for distant spheres",
        at "the ray-sphere test, where the quadratic is solved",
        fix "Compute the discriminant from the distance between ray and centre, and the smaller root as c/q.";
    NORMAL_NOT_UNIT = "normal-not-unit":
        "normals are not normalised",
        at "the intersection record, where normals are written",
        fix "Normalise the interpolated normal; divide a sphere's by its radius.";
    NAN_HIT_ACCEPTED = "nan-hit-accepted":
        "a ray in the plane of a triangle gives 0/0, and the NaN passes as a hit",
        at "the ray-triangle test, where parallel rays are rejected",
        fix "Reject a determinant of 0, and write comparisons that NaN fails: `0 ≤ u`, not `!(u < 0)`.";
    EDGES_EXCLUDED = "edges-excluded":
        "rays through a shared edge hit neither of its triangles: the mesh is not watertight",
        at "the ray-triangle test, where the barycentric coordinates are compared",
        fix "Edges belong to the triangle: compare with ≥ 0, and allow for rounding.";
    SINGLE_PRECISION_INSIDE = "single-precision-inside":
        "a core that declares double precision computes partly in single precision",
        at "the types of t, directions and constants: float where double is meant",
        fix "Use one precision throughout, and declare it.";
    DEGENERATE_HIT = "degenerate-triangle-hit":
        "degenerate triangles (of zero area) are hit",
        at "the ray-triangle test, before it divides by the determinant",
        fix "A determinant of 0 is a miss; write comparisons that NaN fails.";
}
