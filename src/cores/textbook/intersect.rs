//! Part 1: one ray against one triangle or one sphere.
//!
//! Rays may have directions of any length; `t` counts in units of that length. Triangles and
//! spheres are hit strictly inside the segment (t_min, t_max). Not here: normals that are
//! interpolated, and which shape a primitive belongs to (`world`).

use super::steps::Steps;
use crate::contract::Ray;
use crate::scene::Aabb;
use glam::{DVec2, DVec3};

/// Where a ray meets a triangle or a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) t: f64,
    /// Triangle: the weights of vertices 1 and 2. Sphere: zero.
    pub(crate) uv: DVec2,
    /// Nothing behind this is looked at any more.
    pub(crate) ray_end: f64,
}

/// A triangle thinner than this, relative to its longest edge, has no area as far as f64 can tell:
/// its normal would be rounding error.
const THINNEST: f64 = 1e-12;

/// What rounding can do to a triple product, relative to the product of the three lengths.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// No more than this is forgiven to weights outside a triangle, however grazing the ray.
const MOST_FORGIVEN: f64 = 1e-9;

/// A triangle with area, as Möller and Trumbore want it: a corner and the two edges that leave it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    corner: DVec3,
    edges: [DVec3; 2],
    longest_edge: f64,
}

impl Triangle {
    /// `None` if the corners make no area or are not numbers: nothing can hit such a triangle.
    pub(crate) fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let edges = [b - a, c - a];
        let lengths = [edges[0].length(), edges[1].length(), b.distance(c)];
        let longest_edge = lengths.into_iter().fold(0.0, f64::max);
        let doubled_area = edges[0].cross(edges[1]).length();
        let has_area = doubled_area > THINNEST * longest_edge * longest_edge;
        has_area.then_some(Self { corner: a, edges, longest_edge })
    }

    /// Unit, on the side from which the corners run counter-clockwise.
    pub(crate) fn normal(&self) -> DVec3 {
        self.edges[0].cross(self.edges[1]).normalize()
    }

    pub(crate) fn area(&self) -> f64 {
        self.edges[0].cross(self.edges[1]).length() / 2.0
    }

    /// The point with weights `uv` of vertices 1 and 2.
    pub(crate) fn point(&self, uv: DVec2) -> DVec3 {
        self.corner + uv.x * self.edges[0] + uv.y * self.edges[1]
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let [b, c] = self.edges.map(|edge| self.corner + edge);
        Aabb { min: self.corner.min(b).min(c), max: self.corner.max(b).max(c) }
    }

    /// The Möller-Trumbore test (Möller and Trumbore 1997): solve origin + t·direction = (1 − u − v)·a + u·b + v·c by Cramer's
    /// rule. Both sides are hit, and edges belong to the triangle.
    pub(crate) fn intersect(&self, ray: &Ray, steps: &Steps) -> Option<Crossing> {
        let [edge1, edge2] = self.edges;
        let p = ray.direction.cross(edge2);
        let determinant = edge1.dot(p);
        let from_corner = ray.origin - self.corner;
        let u = from_corner.dot(p) / determinant;
        // Most rays are far off, and need no more work. What is not a number is told below.
        #[expect(clippy::manual_range_contains, reason = "a range holds no NaN, and NaN goes on")]
        if u < -MOST_FORGIVEN || u > 1.0 + MOST_FORGIVEN {
            return None;
        }
        let q = from_corner.cross(edge1);
        let v = ray.direction.dot(q) / determinant;
        let t = edge2.dot(q) / determinant;
        if !steps.triangle_reached(ray, t) {
            return None;
        }
        let error = steps.weight_error(self, ray, from_corner, determinant)?;
        let ray_end = steps.end_at_triangle(ray, t);
        steps.triangle_holds(u, v, error).then_some(Crossing { t, uv: DVec2::new(u, v), ray_end })
    }
}

/// Where a ray that hits a triangle at `t` ends from now on.
pub(crate) fn end_at_triangle(_ray: &Ray, t: f64) -> f64 {
    t
}

/// Whether the plane of a triangle is met on the segment.
pub(crate) fn triangle_reached(ray: &Ray, t: f64) -> bool {
    contains(ray, t)
}

/// How far rounding can put u and v off; `None` if the determinant is nothing but rounding,
/// because the ray is parallel to the triangle.
///
/// Two triangles that share an edge compute on which side of it a ray passes in different ways. Were there no room for
/// rounding, a ray through the edge could miss both: a crack along the diagonal of every floor. The room is relative to
/// all lengths involved, so that neither small nor far triangles vanish or grow.
pub(crate) fn weight_error(
    triangle: &Triangle,
    ray: &Ray,
    from_corner: DVec3,
    determinant: f64,
) -> Option<f64> {
    let speed = ray.direction.length();
    let error_by_distance = ROUNDING * speed * triangle.longest_edge / determinant.abs();
    let error = error_by_distance * (from_corner.length() + triangle.longest_edge);
    let is_crossed = error_by_distance * triangle.longest_edge < 1.0;
    is_crossed.then_some(error.min(MOST_FORGIVEN))
}

/// Whether the point with these weights lies in the triangle, edges included.
pub(crate) fn triangle_holds(u: f64, v: f64, error: f64) -> bool {
    u >= -error && v >= -error && u + v <= 1.0 + error
}

/// A sphere without a side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    /// World space.
    pub(crate) centre: DVec3,
    /// Scene units, positive.
    pub(crate) radius: f64,
}

/// a t² + b t + c = 0 for the points that a ray and a sphere share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quadratic {
    /// The direction's length, squared.
    pub(crate) a: f64,
    pub(crate) half_b: f64,
    /// Positive outside the sphere.
    pub(crate) c: f64,
    /// (b/2)² − ac, computed so that it keeps its digits.
    pub(crate) discriminant: f64,
}

impl Sphere {
    /// `None` unless it has a size and a place.
    pub(crate) fn new(centre: DVec3, radius: f64) -> Option<Self> {
        (radius > 0.0 && centre.is_finite()).then_some(Self { centre, radius })
    }

    pub(crate) fn bounds(&self) -> Aabb {
        Aabb { min: self.centre - self.radius, max: self.centre + self.radius }
    }

    /// The nearer crossing inside the segment; from inside the sphere that is the far one.
    pub(crate) fn intersect(&self, ray: &Ray, steps: &Steps) -> Option<Crossing> {
        let quadratic = self.quadratic(ray);
        if quadratic.discriminant < 0.0 {
            return None;
        }
        let (first, second) = steps.roots(quadratic);
        let (near, far) = if first <= second { (first, second) } else { (second, first) };
        let t = steps.nearer_root(ray, near, far)?;
        Some(Crossing { t, uv: DVec2::ZERO, ray_end: t })
    }

    /// Outward, where `ray` hits it at `t`.
    pub(crate) fn normal(&self, ray: &Ray, t: f64, steps: &Steps) -> DVec3 {
        steps.outward_normal(self, ray.at(steps.normal_taken_at(self, ray, t)))
    }

    /// |origin + t·direction − centre|² = radius².
    ///
    /// The discriminant comes from the distance between centre and line: no large equal numbers are
    /// subtracted when the sphere is small and far away (Haines et al., Ray Tracing Gems, chapter 7).
    pub(crate) fn quadratic(&self, ray: &Ray) -> Quadratic {
        let from_centre = ray.origin - self.centre;
        let a = ray.direction.length_squared();
        let half_b = from_centre.dot(ray.direction);
        let c = from_centre.length_squared() - self.radius * self.radius;
        let nearest = from_centre - half_b / a * ray.direction;
        let discriminant = a * (self.radius * self.radius - nearest.length_squared());
        Quadratic { a, half_b, c, discriminant }
    }
}

/// Both solutions, in any order. The smaller one comes from the product of both, c/a: the usual
/// formula would subtract nearly equal numbers.
pub(crate) fn roots(Quadratic { a, half_b, c, discriminant }: Quadratic) -> (f64, f64) {
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    (c / q, q / a)
}

/// The first of the two that lies on the segment.
pub(crate) fn nearer_root(ray: &Ray, near: f64, far: f64) -> Option<f64> {
    [near, far].into_iter().find(|t| contains(ray, *t))
}

/// Where on the ray the normal of a sphere that it hits at `t` is taken.
pub(crate) fn normal_taken_at(_sphere: &Sphere, _ray: &Ray, t: f64) -> f64 {
    t
}

/// Unit, away from the centre.
pub(crate) fn outward_normal(sphere: &Sphere, point: DVec3) -> DVec3 {
    (point - sphere.centre).normalize()
}

/// Whether `t` lies strictly inside the ray's segment. Not a number lies nowhere.
pub(crate) fn contains(ray: &Ray, t: f64) -> bool {
    ray.t_min < t && t < ray.t_max
}
