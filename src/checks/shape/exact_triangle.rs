//! Triangles and rays on an integer grid, and where they meet in exact arithmetic.
//!
//! Coordinates are integers below 2²² times a power of two, so that single precision holds them without rounding, and
//! every product of three of them fits an `i128`: no rounding takes part in the verdict.

use crate::contract::{Precision, Primitive, Ray};
use crate::math::rng::{Stream, in_cube, in_square, uniform};
use crate::math::sphere::on_sphere;
use crate::stats::Tolerance;
use glam::DVec3;

/// Exponents of the longest edge on the grid: at least 256 steps, so that rounding to the grid does no harm.
const EDGE_EXPONENTS: (i32, i32) = (8, 18);
/// Exponents of the longest edge in the scene: 1e-3 to 1e3.
const SIZE_EXPONENTS: (i32, i32) = (-10, 10);
/// Longest edge over height, at most.
const LARGEST_ASPECT: f64 = 1e3;
/// Steps of the grid that the height of a sliver spans at least.
const FEWEST_STEPS: f64 = 8.0;
/// Vertices and origins lie within this many steps of 0.
const REACH: f64 = 524_288.0;
/// Roundings in a barycentric weight, relative to its condition number: an answer nearer to an edge than this is
/// neither right nor wrong.
const AMBIGUOUS_ULPS: f64 = 64.0;

/// A vector of grid steps.
type Steps = [i128; 3];

/// A triangle on the grid, and the size of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridTriangle {
    vertices: [Steps; 3],
    step: f64,
}

/// A ray on the grid. Its direction is in steps too, of a size of their own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridRay {
    origin: Steps,
    direction: Steps,
    /// The size of a step of the direction in the world.
    direction_scale: f64,
    /// The end of the segment, in units of the world's direction.
    t_max: f64,
}

/// Where a ray meets the plane of a triangle, exact but for the last rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meeting {
    /// Barycentric weights of the three vertices.
    pub(crate) weights: [f64; 3],
    /// In units of the world's direction.
    pub(crate) t: f64,
    /// e1 · (d × e2) in the world; negative where the ray comes from behind.
    pub(crate) determinant: f64,
    pub(crate) truth: Truth,
}

/// What a core has to answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Truth {
    /// Hits, with t within `allowed`, absolute.
    Hit {
        allowed: f64,
    },
    Miss,
    /// So close to an edge or an end that rounding may decide.
    Ambiguous,
}

fn subtract(a: Steps, b: Steps) -> Steps {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Steps, b: Steps) -> Steps {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Steps, b: Steps) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[expect(clippy::cast_precision_loss, reason = "below 2²², or where one rounding does not matter")]
fn to_f64(value: i128) -> f64 {
    value as f64
}

fn to_vector(steps: Steps) -> DVec3 {
    DVec3::from_array(steps.map(to_f64))
}

/// The nearest grid point.
#[expect(clippy::cast_possible_truncation, reason = "rounded, and far below 2⁶³")]
fn to_steps(vector: DVec3) -> Steps {
    vector.to_array().map(|component| i128::from(component.round() as i64))
}

/// An integer between these, both ends included.
fn exponent(stream: &mut Stream, (low, high): (i32, i32)) -> i32 {
    low + (uniform(stream) * f64::from(high - low + 1)) as i32
}

/// Weights of the second and third vertex: half of them inside, the others around the triangle.
fn target_weights(stream: &mut Stream) -> [f64; 2] {
    let weights = in_square(stream);
    let target = match (uniform(stream) < 0.5, weights.element_sum() < 1.0) {
        (true, _) => 1.6 * weights - 0.3,
        (false, true) => weights,
        (false, false) => 1.0 - weights,
    };
    target.into()
}

impl GridTriangle {
    /// A triangle of any size, place and shape down to slivers.
    pub(crate) fn random(stream: &mut Stream) -> Self {
        let edge_exponent = exponent(stream, EDGE_EXPONENTS);
        let edge = 2f64.powi(edge_exponent);
        let step = 2f64.powi(exponent(stream, SIZE_EXPONENTS) - edge_exponent);
        let aspect = LARGEST_ASPECT.min(edge / FEWEST_STEPS).powf(uniform(stream));
        let along = on_sphere(stream);
        let across = along.cross(on_sphere(stream)).normalize_or_zero();
        let first = REACH / 2.0 * (2.0 * in_cube(stream) - 1.0);
        let apex = edge * (uniform(stream) * along + across / aspect);
        let vertices = [first, first + edge * along, first + apex].map(to_steps);
        Self { vertices, step }
    }

    pub(crate) fn primitive(&self) -> Primitive {
        let positions = self.vertices.map(|vertex| self.step * to_vector(vertex));
        let (e1, e2) = self.edges();
        Primitive::Triangle { positions, normals: [to_vector(cross(e1, e2)).normalize(); 3] }
    }

    fn edges(&self) -> (Steps, Steps) {
        let [a, b, c] = self.vertices;
        (subtract(b, a), subtract(c, a))
    }

    /// A ray at a point in or around the triangle, from anywhere, with a direction of about unit length; some
    /// look away from it, some end before or just behind it.
    pub(crate) fn ray(&self, stream: &mut Stream) -> GridRay {
        let [first, ..] = self.vertices.map(to_vector);
        let (e1, e2) = self.edges();
        let [v, w] = target_weights(stream);
        let target = to_steps(first + v * to_vector(e1) + w * to_vector(e2));
        let nearest = to_vector(e1).length() / 4.0;
        let distance = nearest * (REACH / nearest).powf(uniform(stream));
        let origin = to_steps(to_vector(target) + distance * on_sphere(stream));
        let towards = subtract(target, origin);
        let looks_away = uniform(stream) < 0.1;
        let direction = if looks_away { towards.map(|c| -c) } else { towards };
        let direction_scale = 2f64.powi(-to_vector(direction).length().log2() as i32);
        let at_target = self.step / direction_scale;
        let t_max = match (uniform(stream) * 4.0) as u32 {
            0 => 0.5 * at_target,
            1 => 1.5 * at_target,
            _ => f64::INFINITY,
        };
        GridRay { origin, direction, direction_scale, t_max }
    }

    pub(crate) fn world_ray(&self, ray: &GridRay) -> Ray {
        let origin = self.step * to_vector(ray.origin);
        let direction = ray.direction_scale * to_vector(ray.direction);
        Ray { t_max: ray.t_max, ..Ray::new(origin, direction) }
    }

    /// Where they meet; `None` for a ray along the plane.
    pub(crate) fn meeting(&self, ray: &GridRay, precision: Precision) -> Option<Meeting> {
        let (e1, e2) = self.edges();
        let from_first = subtract(ray.origin, self.vertices[0]);
        let p = cross(ray.direction, e2);
        let q = cross(from_first, e1);
        let determinant = dot(e1, p);
        if determinant == 0 {
            return None;
        }
        let share = |numerator: i128| to_f64(numerator) / to_f64(determinant);
        let (v, w) = (dot(from_first, p), dot(ray.direction, q));
        let to_world = self.step / ray.direction_scale;
        let lengths = [e1, e2, from_first, ray.direction].map(|steps| to_vector(steps).length());
        let mut meeting = Meeting {
            weights: [determinant - v - w, v, w].map(share),
            t: share(dot(e2, q)) * to_world,
            determinant: to_f64(determinant) * self.step * self.step * ray.direction_scale,
            truth: Truth::Ambiguous,
        };
        let conditions = conditions(lengths, to_f64(determinant), meeting.t / to_world);
        meeting.truth = truth(&meeting, ray, conditions, precision);
        Some(meeting)
    }
}

/// How much a rounding of the input moves a barycentric weight, absolute, and t, relative: each term of a triple
/// product carries roundings of the size of the product of its lengths (of e1, e2, origin − p0 and direction), and all
/// are divided by the determinant.
fn conditions([e1, e2, from_first, direction]: [f64; 4], determinant: f64, t: f64) -> [f64; 2] {
    let slant = direction / determinant.abs();
    let of_weights = slant * e1.max(e2) * (from_first + e1 + e2);
    let of_t = slant * e1 * e2 * (1.0 + from_first / (t.abs() * direction));
    [of_weights, of_t]
}

fn truth(meeting: &Meeting, ray: &GridRay, conditions: [f64; 2], precision: Precision) -> Truth {
    let [of_weights, of_t] = conditions;
    let margin = AMBIGUOUS_ULPS * precision.epsilon() * of_weights;
    let allowed = Tolerance::INTERSECTION.of(precision) * of_t.max(1.0) * meeting.t.abs();
    let least = meeting.weights.into_iter().fold(f64::INFINITY, f64::min);
    // The distance to the nearer end of the segment, negative outside.
    let inside = meeting.t.min(ray.t_max - meeting.t);
    if least < -margin || inside < -allowed {
        Truth::Miss
    } else if least > margin && inside > allowed {
        Truth::Hit { allowed }
    } else {
        Truth::Ambiguous
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;

    /// The triangle (0,0,0), (4,0,0), (0,4,0) in steps of ½, and a ray down to (1, 1, 0) from height 3.
    fn by_hand() -> (GridTriangle, GridRay) {
        let vertices = [[0, 0, 0], [4, 0, 0], [0, 4, 0]];
        let ray = GridRay {
            origin: [1, 1, 3],
            direction: [0, 0, -2],
            direction_scale: 0.25,
            t_max: f64::INFINITY,
        };
        (GridTriangle { vertices, step: 0.5 }, ray)
    }

    #[test]
    fn a_meeting_by_hand_is_exact() {
        let (triangle, ray) = by_hand();
        let meeting = triangle.meeting(&ray, Precision::Double).unwrap();
        assert_eq!(meeting.weights, [0.5, 0.25, 0.25]);
        // In the world the ray falls from 1.5 with direction −0.5.
        assert_eq!(meeting.t, 3.0);
        assert_eq!(triangle.world_ray(&ray).at(meeting.t).z, 0.0);
        assert_eq!(meeting.determinant, 0.5 * 2.0 * 2.0);
        assert!(matches!(meeting.truth, Truth::Hit { .. }));
    }

    #[test]
    fn an_edge_is_ambiguous_and_the_ends_of_the_segment_count() {
        let (triangle, ray) = by_hand();
        let truth = |ray: GridRay| triangle.meeting(&ray, Precision::Double).unwrap().truth;
        assert_eq!(truth(GridRay { origin: [0, 2, 3], ..ray }), Truth::Ambiguous);
        assert_eq!(truth(GridRay { origin: [-1, 2, 3], ..ray }), Truth::Miss);
        assert_eq!(truth(GridRay { t_max: 2.9, ..ray }), Truth::Miss);
        assert_eq!(truth(GridRay { t_max: 3.0, ..ray }), Truth::Ambiguous);
        let along = GridRay { direction: [1, 1, 0], ..ray };
        assert!(triangle.meeting(&along, Precision::Double).is_none());
    }

    #[test]
    fn single_precision_holds_every_coordinate() {
        let mut stream = Seed(5).stream();
        for _ in 0..1000 {
            let triangle = GridTriangle::random(&mut stream);
            let grid_ray = triangle.ray(&mut stream);
            let ray = triangle.world_ray(&grid_ray);
            let primitive = triangle.primitive();
            let Primitive::Triangle { positions, .. } = primitive else { unreachable!() };
            for vector in positions.into_iter().chain([ray.origin, ray.direction]) {
                assert_eq!(vector.as_vec3().as_dvec3(), vector);
            }
            assert!((0.5..2.5).contains(&ray.direction.length()), "{}", ray.direction.length());
        }
    }
}
