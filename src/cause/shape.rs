//! Part 1: triangles and spheres.

use super::Cause;

/// See its headline.
pub static SEGMENT_END_IGNORED: Cause = Cause {
    name: "segment-end-ignored",
    headline: "the end of the segment (t_max) is not looked at",
    look_at: "the intersection test, where t is compared",
    remedy: "A hit counts only while t_min < t < t_max.",
};

/// See its headline.
pub static SEGMENT_START_IGNORED: Cause = Cause {
    name: "segment-start-ignored",
    headline: "the start of the segment (t_min) is not looked at",
    look_at: "the intersection test, where t is compared",
    remedy: "A hit counts only while t_min < t < t_max.",
};

/// See its headline.
pub static SEGMENT_IGNORED: Cause = Cause {
    name: "segment-ignored",
    headline: "neither end of the segment is looked at: whatever the line meets is hit",
    look_at: "the intersection test, where t is compared",
    remedy: "A hit counts only while t_min < t < t_max.",
};

/// See its headline.
pub static HITS_BEHIND_ORIGIN: Cause = Cause {
    name: "hits-behind-origin",
    headline: "what lies behind the origin is hit",
    look_at: "the intersection test, where t is compared",
    remedy: "A hit counts only while t_min < t < t_max.",
};

/// See its headline.
pub static NEAR_ROOT_ONLY: Cause = Cause {
    name: "near-root-only",
    headline: "only the nearer root is tried, so that a ray from inside misses",
    look_at: "the sphere's test, where the roots of the quadratic are chosen",
    remedy: "If the nearer root is not inside (t_min, t_max), try the farther one.",
};

/// See its headline.
pub static FAR_ROOT_TAKEN: Cause = Cause {
    name: "far-root-taken",
    headline: "the farther root is taken where the nearer one is right",
    look_at: "the sphere's test, where the roots of the quadratic are chosen",
    remedy: "Take the smaller root that lies inside (t_min, t_max).",
};

/// See its headline.
pub static QUADRATIC_WITHOUT_A: Cause = Cause {
    name: "quadratic-without-a",
    headline: "the quadratic leaves out a = d·d, which is 1 for unit directions only",
    look_at: "the sphere's test, where the quadratic is solved",
    remedy: "t = (−b ± √(b² − 4ac)) / (2a), with a = d·d.",
};

/// See its headline.
pub static QUADRATIC_DIVIDES_BY_A: Cause = Cause {
    name: "quadratic-divides-by-a",
    headline: "the quadratic divides by a where 2a belongs",
    look_at: "the sphere's test, where the quadratic is solved",
    remedy: "t = (−b ± √(b² − 4ac)) / (2a): mind the parentheses around 2a.",
};

/// See its headline.
pub static T_IN_SCENE_UNITS: Cause = Cause {
    name: "t-in-scene-units",
    headline: "t counts scene units, not lengths of the direction",
    look_at: "the intersection test, where t is computed",
    remedy: "The hit is at origin + t · direction, whatever the length of the direction.",
};

/// See its headline.
pub static PARALLELOGRAM: Cause = Cause {
    name: "parallelogram",
    headline: "the condition v + w ≤ 1 is missing: the triangle has become a parallelogram",
    look_at: "the triangle's test, where the weights are compared",
    remedy: "All three weights have to be ≥ 0; the third is 1 − v − w.",
};

/// See its headline.
pub static V_NOT_COMPARED: Cause = Cause {
    name: "v-not-compared",
    headline: "the condition v ≥ 0 is missing",
    look_at: "the triangle's test, where the weights are compared",
    remedy: "All three weights have to be ≥ 0.",
};

/// See its headline.
pub static W_NOT_COMPARED: Cause = Cause {
    name: "w-not-compared",
    headline: "the condition w ≥ 0 is missing",
    look_at: "the triangle's test, where the weights are compared",
    remedy: "All three weights have to be ≥ 0.",
};

/// See its headline.
pub static WHOLE_PLANE_HIT: Cause = Cause {
    name: "whole-plane-hit",
    headline: "the whole plane of the triangle is hit",
    look_at: "the triangle's test, where the weights are compared",
    remedy: "All three weights have to be ≥ 0.",
};

/// See its headline.
pub static BACK_CULLED: Cause = Cause {
    name: "back-culled",
    headline: "hits from behind are culled",
    look_at: "the triangle's test, where the determinant is compared",
    remedy: "A triangle is hit from both sides: compare the determinant with 0 only, for parallel rays.",
};

/// See its headline.
pub static FRONT_CULLED: Cause = Cause {
    name: "front-culled",
    headline: "hits from the front are culled",
    look_at: "the triangle's test, where the determinant is compared",
    remedy: "A triangle is hit from both sides: compare the determinant with 0 only, for parallel rays.",
};

/// See its headline.
pub static DETERMINANT_THRESHOLD: Cause = Cause {
    name: "determinant-threshold",
    headline: "small triangles are lost: their determinant is compared with a fixed number",
    look_at: "the triangle's test, where parallel rays are rejected",
    remedy: "Reject only a determinant of exactly 0; its size grows with the triangle and says nothing about parallelism.",
};

/// See its headline.
pub static WEIGHTS_SWAPPED: Cause = Cause {
    name: "weights-swapped",
    headline: "the weights of v1 and v2 are swapped",
    look_at: "the triangle's test, where normals are interpolated",
    remedy: "The weight of v1 belongs to the edge v1 − v0, that of v2 to v2 − v0.",
};

/// See its headline.
pub static NORMALS_SWAPPED: Cause = Cause {
    name: "normals-swapped",
    headline: "the normals of v1 and v2 are swapped in the interpolation",
    look_at: "the triangle's test, where normals are interpolated",
    remedy: "Each vertex normal is multiplied by the weight of its own vertex.",
};

/// See its headline.
pub static WEIGHTS_MOVED_ON: Cause = Cause {
    name: "weights-moved-on",
    headline: "the weights are moved on by one vertex: v0 has the weight of v1",
    look_at: "the triangle's test, where normals are interpolated",
    remedy: "Möller and Trumbore's b1 and b2 are the weights of v1 and v2; that of v0 is 1 − b1 − b2.",
};

/// See its headline.
pub static NORMALS_MOVED_ON: Cause = Cause {
    name: "normals-moved-on",
    headline: "the normals are interpolated with weights moved on by one vertex",
    look_at: "the triangle's test, where normals are interpolated",
    remedy: "n = (1 − b1 − b2) n0 + b1 n1 + b2 n2.",
};

/// See its headline.
pub static WEIGHTS_MOVED_BACK: Cause = Cause {
    name: "weights-moved-back",
    headline: "the weights are moved back by one vertex: v0 has the weight of v2",
    look_at: "the triangle's test, where normals are interpolated",
    remedy: "Möller and Trumbore's b1 and b2 are the weights of v1 and v2; that of v0 is 1 − b1 − b2.",
};

/// See its headline.
pub static NORMALS_MOVED_BACK: Cause = Cause {
    name: "normals-moved-back",
    headline: "the normals are interpolated with weights moved back by one vertex",
    look_at: "the triangle's test, where normals are interpolated",
    remedy: "n = (1 − b1 − b2) n0 + b1 n1 + b2 n2.",
};

/// See its headline.
pub static FLAT_SHADING_NORMAL: Cause = Cause {
    name: "flat-shading-normal",
    headline: "the geometric normal stands where the interpolated one belongs",
    look_at: "the intersection test, where normals are written",
    remedy: "The shading normal is interpolated from the vertex normals and normalised.",
};

/// See its headline.
pub static GEOMETRIC_NORMAL_INTERPOLATED: Cause = Cause {
    name: "geometric-normal-interpolated",
    headline: "the interpolated normal stands where the geometric one belongs",
    look_at: "the intersection test, where normals are written",
    remedy: "The geometric normal is the cross product of two edges, normalised.",
};

/// See its headline.
pub static NORMALS_FACE_RAY: Cause = Cause {
    name: "normals-face-ray",
    headline: "normals are flipped towards the ray; the side they are on must not depend on it",
    look_at: "the intersection test, where normals are written",
    remedy: "Leave the normal on the side that the winding says.",
};

/// See its headline.
pub static NORMALS_INSIDE_OUT: Cause = Cause {
    name: "normals-inside-out",
    headline: "normals point to the wrong side",
    look_at: "the intersection test, where normals are written",
    remedy: "A sphere's normal is (point − centre) / radius; a triangle's is (v1 − v0) × (v2 − v0).",
};

/// See its headline.
pub static BOTH_ROOTS_REQUIRED: Cause = Cause {
    name: "both-roots-required",
    headline: "both roots have to lie on the segment, so that spheres cut by its end vanish",
    look_at: "the sphere's test, where the roots of the quadratic are chosen",
    remedy: "One root inside (t_min, t_max) is enough; take the smaller such.",
};

/// See its headline.
pub static FIRST_ROOT_UNCHECKED: Cause = Cause {
    name: "first-root-unchecked",
    headline: "the nearer root is reported even where only the farther one lies on the segment",
    look_at: "the sphere's test, where the roots of the quadratic are chosen",
    remedy: "Report the root that was found to lie inside (t_min, t_max).",
};

/// See its headline.
pub static QUADRATIC_PRECEDENCE: Cause = Cause {
    name: "quadratic-precedence",
    headline: "the quadratic is divided by 2 and multiplied by a: `/ 2 * a` is not `/ (2 * a)`",
    look_at: "the sphere's test, where the quadratic is solved",
    remedy: "t = (−b ± √(b² − 4ac)) / (2a): mind the parentheses around 2a.",
};

/// See its headline.
pub static SPHERE_CANCELLATION: Cause = Cause {
    name: "sphere-cancellation",
    headline: "the roots of far spheres lose their digits in b² − 4ac",
    look_at: "the sphere's test, where the quadratic is solved",
    remedy: "Take the discriminant from the distance between line and centre, and the smaller root as c/q.",
};

/// See its headline.
pub static NORMAL_NOT_UNIT: Cause = Cause {
    name: "normal-not-unit",
    headline: "normals are not of unit length",
    look_at: "the intersection test, where normals are written",
    remedy: "Normalise the interpolated normal, and divide the sphere's by its radius.",
};

/// See its headline.
pub static NAN_HIT_ACCEPTED: Cause = Cause {
    name: "nan-hit-accepted",
    headline: "a ray in the plane of a triangle divides 0 by 0, and what is no number counts as a hit",
    look_at: "the triangle's test, where parallel rays are rejected",
    remedy: "Reject a determinant of 0, or write comparisons that accept: `0 ≤ u`, not `!(u < 0)`.",
};

/// See its headline.
pub static EDGES_EXCLUDED: Cause = Cause {
    name: "edges-excluded",
    headline: "rays through an edge that two triangles share hit neither",
    look_at: "the triangle's test, where the weights are compared",
    remedy: "Edges belong to the triangle: compare with ≥ 0, and leave room for rounding.",
};

/// See its headline.
pub static SINGLE_PRECISION_INSIDE: Cause = Cause {
    name: "single-precision-inside",
    headline: "a core that declares double precision computes in single precision somewhere",
    look_at: "the types of t, of directions and of constants: float where double is meant",
    remedy: "Use one precision throughout, and declare that one.",
};

/// See its headline.
pub static DEGENERATE_HIT: Cause = Cause {
    name: "degenerate-triangle-hit",
    headline: "triangles without area are hit",
    look_at: "the triangle test, before it divides by the determinant",
    remedy: "A determinant of 0 is a miss; write comparisons so that NaN makes them false.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &SEGMENT_END_IGNORED,
    &SEGMENT_START_IGNORED,
    &SEGMENT_IGNORED,
    &HITS_BEHIND_ORIGIN,
    &NEAR_ROOT_ONLY,
    &FAR_ROOT_TAKEN,
    &QUADRATIC_WITHOUT_A,
    &QUADRATIC_DIVIDES_BY_A,
    &T_IN_SCENE_UNITS,
    &PARALLELOGRAM,
    &V_NOT_COMPARED,
    &W_NOT_COMPARED,
    &WHOLE_PLANE_HIT,
    &BACK_CULLED,
    &FRONT_CULLED,
    &DETERMINANT_THRESHOLD,
    &WEIGHTS_SWAPPED,
    &NORMALS_SWAPPED,
    &WEIGHTS_MOVED_ON,
    &NORMALS_MOVED_ON,
    &WEIGHTS_MOVED_BACK,
    &NORMALS_MOVED_BACK,
    &FLAT_SHADING_NORMAL,
    &GEOMETRIC_NORMAL_INTERPOLATED,
    &NORMALS_FACE_RAY,
    &NORMALS_INSIDE_OUT,
    &BOTH_ROOTS_REQUIRED,
    &FIRST_ROOT_UNCHECKED,
    &QUADRATIC_PRECEDENCE,
    &SPHERE_CANCELLATION,
    &NORMAL_NOT_UNIT,
    &NAN_HIT_ACCEPTED,
    &EDGES_EXCLUDED,
    &SINGLE_PRECISION_INSIDE,
    &DEGENERATE_HIT,
];
