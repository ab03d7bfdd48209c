//! Part 1: triangles and spheres.

use super::{Cause, causes};

causes! {
    SEGMENT_END_IGNORED = "segment-end-ignored":
        "the end of the segment (t_max) is not looked at",
        at "the intersection test, where t is compared",
        fix "A hit counts only while t_min < t < t_max.";
    SEGMENT_START_IGNORED = "segment-start-ignored":
        "the start of the segment (t_min) is not looked at",
        at "the intersection test, where t is compared",
        fix "A hit counts only while t_min < t < t_max.";
    SEGMENT_IGNORED = "segment-ignored":
        "neither end of the segment is looked at: whatever the line meets is hit",
        at "the intersection test, where t is compared",
        fix "A hit counts only while t_min < t < t_max.";
    HITS_BEHIND_ORIGIN = "hits-behind-origin":
        "what lies behind the origin is hit",
        at "the intersection test, where t is compared",
        fix "A hit counts only while t_min < t < t_max.";
    NEAR_ROOT_ONLY = "near-root-only":
        "only the nearer root is tried, so that a ray from inside misses",
        at "the sphere's test, where the roots of the quadratic are chosen",
        fix "If the nearer root is not inside (t_min, t_max), try the farther one.";
    FAR_ROOT_TAKEN = "far-root-taken":
        "the farther root is taken where the nearer one is right",
        at "the sphere's test, where the roots of the quadratic are chosen",
        fix "Take the smaller root that lies inside (t_min, t_max).";
    QUADRATIC_WITHOUT_A = "quadratic-without-a":
        "the quadratic leaves out a = d·d, which is 1 for unit directions only",
        at "the sphere's test, where the quadratic is solved",
        fix "t = (−b ± √(b² − 4ac)) / (2a), with a = d·d.";
    QUADRATIC_DIVIDES_BY_A = "quadratic-divides-by-a":
        "the quadratic divides by a where 2a belongs",
        at "the sphere's test, where the quadratic is solved",
        fix "t = (−b ± √(b² − 4ac)) / (2a): mind the parentheses around 2a.";
    T_IN_SCENE_UNITS = "t-in-scene-units":
        "t counts scene units, not lengths of the direction",
        at "the intersection test, where t is computed",
        fix "The hit is at origin + t · direction, whatever the length of the direction.";
    PARALLELOGRAM = "parallelogram":
        "the condition v + w ≤ 1 is missing: the triangle has become a parallelogram",
        at "the triangle's test, where the weights are compared",
        fix "All three weights have to be ≥ 0; the third is 1 − v − w.";
    V_NOT_COMPARED = "v-not-compared":
        "the condition v ≥ 0 is missing",
        at "the triangle's test, where the weights are compared",
        fix "All three weights have to be ≥ 0.";
    W_NOT_COMPARED = "w-not-compared":
        "the condition w ≥ 0 is missing",
        at "the triangle's test, where the weights are compared",
        fix "All three weights have to be ≥ 0.";
    WHOLE_PLANE_HIT = "whole-plane-hit":
        "the whole plane of the triangle is hit",
        at "the triangle's test, where the weights are compared",
        fix "All three weights have to be ≥ 0.";
    BACK_CULLED = "back-culled":
        "hits from behind are culled",
        at "the triangle's test, where the determinant is compared",
        fix "A triangle is hit from both sides: compare the determinant with 0 only, for parallel rays.";
    FRONT_CULLED = "front-culled":
        "hits from the front are culled",
        at "the triangle's test, where the determinant is compared",
        fix "A triangle is hit from both sides: compare the determinant with 0 only, for parallel rays.";
    DETERMINANT_THRESHOLD = "determinant-threshold":
        "small triangles are lost: their determinant is compared with a fixed number",
        at "the triangle's test, where parallel rays are rejected",
        fix "Reject only a determinant of exactly 0; its size grows with the triangle and says nothing about parallelism.";
    WEIGHTS_SWAPPED = "weights-swapped":
        "the weights of v1 and v2 are swapped",
        at "the triangle's test, where normals are interpolated",
        fix "The weight of v1 belongs to the edge v1 − v0, that of v2 to v2 − v0.";
    NORMALS_SWAPPED = "normals-swapped":
        "the normals of v1 and v2 are swapped in the interpolation",
        at "the triangle's test, where normals are interpolated",
        fix "Each vertex normal is multiplied by the weight of its own vertex.";
    WEIGHTS_MOVED_ON = "weights-moved-on":
        "the weights are moved on by one vertex: v0 has the weight of v1",
        at "the triangle's test, where normals are interpolated",
        fix "Möller and Trumbore's b1 and b2 are the weights of v1 and v2; that of v0 is 1 − b1 − b2.";
    NORMALS_MOVED_ON = "normals-moved-on":
        "the normals are interpolated with weights moved on by one vertex",
        at "the triangle's test, where normals are interpolated",
        fix "n = (1 − b1 − b2) n0 + b1 n1 + b2 n2.";
    WEIGHTS_MOVED_BACK = "weights-moved-back":
        "the weights are moved back by one vertex: v0 has the weight of v2",
        at "the triangle's test, where normals are interpolated",
        fix "Möller and Trumbore's b1 and b2 are the weights of v1 and v2; that of v0 is 1 − b1 − b2.";
    NORMALS_MOVED_BACK = "normals-moved-back":
        "the normals are interpolated with weights moved back by one vertex",
        at "the triangle's test, where normals are interpolated",
        fix "n = (1 − b1 − b2) n0 + b1 n1 + b2 n2.";
    FLAT_SHADING_NORMAL = "flat-shading-normal":
        "the geometric normal stands where the interpolated one belongs",
        at "the intersection test, where normals are written",
        fix "The shading normal is interpolated from the vertex normals and normalised.";
    GEOMETRIC_NORMAL_INTERPOLATED = "geometric-normal-interpolated":
        "the interpolated normal stands where the geometric one belongs",
        at "the intersection test, where normals are written",
        fix "The geometric normal is the cross product of two edges, normalised.";
    NORMALS_FACE_RAY = "normals-face-ray":
        "normals are flipped towards the ray; the side they are on must not depend on it",
        at "the intersection test, where normals are written",
        fix "Leave the normal on the side that the winding says.";
    NORMALS_INSIDE_OUT = "normals-inside-out":
        "normals point to the wrong side",
        at "the intersection test, where normals are written",
        fix "A sphere's normal is (point − centre) / radius; a triangle's is (v1 − v0) × (v2 − v0).";
    BOTH_ROOTS_REQUIRED = "both-roots-required":
        "both roots have to lie on the segment, so that spheres cut by its end vanish",
        at "the sphere's test, where the roots of the quadratic are chosen",
        fix "One root inside (t_min, t_max) is enough; take the smaller such.";
    FIRST_ROOT_UNCHECKED = "first-root-unchecked":
        "the nearer root is reported even where only the farther one lies on the segment",
        at "the sphere's test, where the roots of the quadratic are chosen",
        fix "Report the root that was found to lie inside (t_min, t_max).";
    QUADRATIC_PRECEDENCE = "quadratic-precedence":
        "the quadratic is divided by 2 and multiplied by a: `/ 2 * a` is not `/ (2 * a)`",
        at "the sphere's test, where the quadratic is solved",
        fix "t = (−b ± √(b² − 4ac)) / (2a): mind the parentheses around 2a.";
    SPHERE_CANCELLATION = "sphere-cancellation":
        "the roots of far spheres lose their digits in b² − 4ac",
        at "the sphere's test, where the quadratic is solved",
        fix "Take the discriminant from the distance between line and centre, and the smaller root as c/q.";
    NORMAL_NOT_UNIT = "normal-not-unit":
        "normals are not of unit length",
        at "the intersection test, where normals are written",
        fix "Normalise the interpolated normal, and divide the sphere's by its radius.";
    NAN_HIT_ACCEPTED = "nan-hit-accepted":
        "a ray in the plane of a triangle divides 0 by 0, and what is no number counts as a hit",
        at "the triangle's test, where parallel rays are rejected",
        fix "Reject a determinant of 0, or write comparisons that accept: `0 ≤ u`, not `!(u < 0)`.";
    EDGES_EXCLUDED = "edges-excluded":
        "rays through an edge that two triangles share hit neither",
        at "the triangle's test, where the weights are compared",
        fix "Edges belong to the triangle: compare with ≥ 0, and leave room for rounding.";
    SINGLE_PRECISION_INSIDE = "single-precision-inside":
        "a core that declares double precision computes in single precision somewhere",
        at "the types of t, of directions and of constants: float where double is meant",
        fix "Use one precision throughout, and declare that one.";
    DEGENERATE_HIT = "degenerate-triangle-hit":
        "triangles without area are hit",
        at "the triangle test, before it divides by the determinant",
        fix "A determinant of 0 is a miss; write comparisons so that NaN makes them false.";
}
