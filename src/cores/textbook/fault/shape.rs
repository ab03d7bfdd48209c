//! Part 1: triangle and sphere.

use super::faults;
use crate::cause::{bvh, shape};
use crate::cores::textbook as lesson;
use lesson::intersect::{Quadratic, contains, weight_error};

const INTERPOLATION: &str = "shape/shading-normals-are-interpolated";
const TRIANGLE: &str = "shape/ray-triangle-hits-are-right";
const IN_PLANE: &str = "shape/rays-in-the-plane-of-a-triangle-miss";
const RANDOM: &str = "shape/random-triangles-match-exact-arithmetic";
const SEGMENT: &str = "shape/hits-lie-between-t-min-and-t-max";
const SPHERE: &str = "shape/ray-sphere-hit-is-the-nearest-root-ahead";
const SOUP: &str = "bvh/triangle-soup-order-does-not-matter";

faults! { part 1;
    "vertex-normals-swapped": "barycentric weights multiply the wrong vertex normals",
        fails INTERPOLATION, told shape::NORMALS_SWAPPED,
        interpolated_normal = |[n0, n1, n2], uv| {
            ((1.0 - uv.x - uv.y) * n0 + uv.y * n1 + uv.x * n2).try_normalize()
        };
    "vertex-normals-moved-on": "the first weight multiplies the third vertex normal, and so on",
        fails INTERPOLATION, told shape::NORMALS_MOVED_ON,
        interpolated_normal = |[n0, n1, n2], uv| {
            (uv.x * n0 + uv.y * n1 + (1.0 - uv.x - uv.y) * n2).try_normalize()
        };
    "vertex-normals-moved-back": "the first weight multiplies the second vertex normal, and so on",
        fails INTERPOLATION, told shape::NORMALS_MOVED_BACK,
        interpolated_normal = |[n0, n1, n2], uv| {
            (uv.y * n0 + (1.0 - uv.x - uv.y) * n1 + uv.x * n2).try_normalize()
        };
    "interpolated-normal-not-unit": "the interpolated normal is not normalised",
        fails INTERPOLATION, told shape::NORMAL_NOT_UNIT,
        interpolated_normal = |[n0, n1, n2], uv| {
            Some((1.0 - uv.x - uv.y) * n0 + uv.x * n1 + uv.y * n2)
        };
    "flat-shading": "the geometric normal is used for shading",
        fails INTERPOLATION, told shape::FLAT_SHADING_NORMAL,
        interpolated_normal = |_, _| None;
    "normals-face-ray": "normals are turned towards the ray",
        fails TRIANGLE, told shape::NORMALS_FACE_RAY,
        hit = |ray, crossing, numbers, normals| {
            let is_from_behind = normals[0].dot(ray.direction) > 0.0;
            let facing = normals.map(|normal| if is_from_behind { -normal } else { normal });
            lesson::world::hit(ray, crossing, numbers, facing)
        };
    "determinant-threshold": "a determinant below 1e-5 counts as parallel",
        fails RANDOM, told shape::DETERMINANT_THRESHOLD,
        weight_error = |triangle, ray, from_corner, determinant| {
            let is_parallel = determinant.abs() < 1e-5;
            if is_parallel {
                None
            } else {
                weight_error(triangle, ray, from_corner, determinant)
            }
        };
    "strict-edges": "u > 0, v > 0, u + v < 1: edges belong to no triangle",
        fails "shape/rays-at-a-shared-edge-hit-one-triangle", told shape::EDGES_EXCLUDED,
        triangle_holds = |u, v, _| u > 0.0 && v > 0.0 && u + v < 1.0;
    "triangle-is-a-parallelogram": "v ≤ 1 in place of u + v ≤ 1",
        fails TRIANGLE, told shape::PARALLELOGRAM,
        triangle_holds = |u, v, error| u >= -error && v >= -error && v <= 1.0 + error;
    "back-faces-culled": "determinant < 0 counts as a miss",
        fails TRIANGLE, told shape::BACK_CULLED,
        weight_error = |triangle, ray, from_corner, determinant| {
            let is_behind = determinant < 0.0;
            if is_behind { None } else { weight_error(triangle, ray, from_corner, determinant) }
        };
    "nan-hit-accepted": "no test for parallel rays, and comparisons that reject: NaN is a hit",
        fails IN_PLANE, told shape::NAN_HIT_ACCEPTED,
        weight_error = |_, _, _, _| Some(0.0),
        triangle_reached = |ray, t| {
            let is_off = t <= ray.t_min || t >= ray.t_max;
            !is_off
        },
        triangle_holds = |u, v, _| {
            let is_outside = u < 0.0 || v < 0.0 || u + v > 1.0;
            !is_outside
        };
    "triangle-ignores-t-max": "the triangle's t is compared with min_t only",
        fails SEGMENT, told shape::SEGMENT_END_IGNORED,
        triangle_reached = |ray, t| t > ray.t_min;
    "sphere-near-root-only": "only the nearer root is considered",
        fails SPHERE, told shape::NEAR_ROOT_ONLY,
        nearer_root = |ray, near, _| contains(ray, near).then_some(near);
    "sphere-both-roots-required": "a sphere is hit only if both roots lie in the range",
        fails SPHERE, told shape::BOTH_ROOTS_REQUIRED,
        nearer_root = |ray, near, far| (contains(ray, near) && contains(ray, far)).then_some(near);
    "sphere-first-root-unchecked": "t1 is reported although only t2 is valid",
        fails SPHERE, told shape::FIRST_ROOT_UNCHECKED,
        nearer_root = |ray, near, far| (contains(ray, near) || contains(ray, far)).then_some(near);
    "sphere-far-root": "the swap is the wrong way round: the far root is used",
        fails SPHERE, told shape::FAR_ROOT_TAKEN,
        nearer_root = |ray, _, far| contains(ray, far).then_some(far);
    "sphere-behind-hit": "roots are not compared with min_t",
        fails SPHERE, told shape::HITS_BEHIND_ORIGIN,
        nearer_root = |ray, near, far| [near, far].into_iter().find(|t| *t < ray.t_max);
    "quadratic-precedence": "`/ 2 * a` in place of `/ (2 * a)`",
        fails SPHERE, told shape::QUADRATIC_PRECEDENCE,
        roots = |Quadratic { a, half_b, c, discriminant }| {
            let q = -(half_b + discriminant.sqrt().copysign(half_b));
            (c / q * a * a, q * a)
        };
    "sphere-t-in-scene-units": "t is a length, whatever the length of the direction",
        fails SPHERE, told shape::T_IN_SCENE_UNITS,
        nearer_root = |ray, near, far| {
            let length = ray.direction.length();
            lesson::intersect::nearer_root(ray, length * near, length * far)
        };
    "sphere-missed-from-inside": "a sphere whose centre lies behind the origin is missed",
        fails SPHERE, told shape::MISSED_IF_CENTRE_BEHIND,
        nearer_root = |ray, near, far| {
            let is_centre_ahead = near + far >= 0.0;
            lesson::intersect::nearer_root(ray, near, far).filter(|_| is_centre_ahead)
        };
    "sphere-cancellation": "b² − 4ac as it stands: far spheres lose their digits",
        fails "shape/distant-spheres-do-not-cancel", told shape::SPHERE_CANCELLATION,
        roots = |Quadratic { a, half_b, c, .. }| {
            let root = (half_b * half_b - a * c).max(0.0).sqrt();
            ((-half_b - root) / a, (-half_b + root) / a)
        };
    "sphere-normal-not-unit": "the normal of a sphere has the length of its radius",
        fails SPHERE, told shape::NORMAL_NOT_UNIT,
        outward_normal = |sphere, point| point - sphere.centre;
    "front-faces-culled": "determinant > 0 counts as a miss",
        fails TRIANGLE, told shape::FRONT_CULLED,
        weight_error = |triangle, ray, from_corner, determinant| {
            let is_ahead = determinant > 0.0;
            if is_ahead { None } else { weight_error(triangle, ray, from_corner, determinant) }
        };
    "sphere-inside-out": "the normal of a sphere points to its centre",
        fails SPHERE, told shape::NORMALS_INSIDE_OUT,
        outward_normal = |sphere, point| -lesson::intersect::outward_normal(sphere, point);
    "triangle-leaves-ray": "isect->t is set, r.max_t is not",
        fails SOUP, told bvh::HIT_OVERWRITTEN,
        end_at_triangle = |ray, _| ray.t_max;
    "sphere-normal-at-near-root": "the normal is that of t1, also where t2 is the hit",
        fails SPHERE, told shape::NORMAL_AT_OTHER_ROOT,
        normal_taken_at = |sphere, ray, _| {
            let (one, other) = lesson::intersect::roots(sphere.quadratic(ray));
            one.min(other)
        };
    "normals-moved-back": "the weights of vertices 0, 1, 2 multiply the normals of 1, 2, 0",
        fails INTERPOLATION, told shape::NORMALS_MOVED_BACK,
        interpolated_normal = |[n0, n1, n2], uv| {
            ((1.0 - uv.x - uv.y) * n1 + uv.x * n2 + uv.y * n0).try_normalize()
        };
}
