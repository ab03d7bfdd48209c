//! Parts 1 and 2: one ray against one triangle, one sphere, one box.
//!
//! Rays may have directions of any length; `t` counts in units of that length. Triangles and spheres are hit
//! strictly inside the segment (t_min, t_max); boxes are closed. Not here: normals that are interpolated, and which
//! shape a primitive belongs to (`world`).

use crate::contract::Ray;
use crate::scene::Aabb;
use glam::{DVec2, DVec3};

/// Where a ray meets a triangle or a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Ray parameter.
    pub t: f64,
    /// Triangle: the weights of vertices 1 and 2. Sphere: zero.
    pub uv: DVec2,
}

/// A triangle thinner than this, relative to its longest edge, has no area as far as f64 can tell:
/// its normal would be rounding error.
const THINNEST: f64 = 1e-12;

/// A ray is parallel to a triangle if the sine of their angle is below this: a few rounding errors. Relative to
/// all lengths involved, so that small triangles do not vanish.
const PARALLEL: f64 = 4.0 * f64::EPSILON;

/// A triangle with area, as Möller and Trumbore want it: a corner and the two edges that leave it.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    corner: DVec3,
    edges: [DVec3; 2],
    /// Square of the determinant below which a unit ray is parallel.
    parallel_squared: f64,
}

impl Triangle {
    /// `None` if the corners make no area or are not numbers: nothing can hit such a triangle.
    pub fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let edges = [b - a, c - a];
        let longest = [edges[0], edges[1], c - b]
            .iter()
            .map(|edge| edge.length_squared())
            .fold(0.0, f64::max);
        let has_area = edges[0].cross(edges[1]).length() > THINNEST * longest;
        let parallel_squared =
            PARALLEL.powi(2) * edges[0].length_squared() * edges[1].length_squared();
        has_area.then_some(Self { corner: a, edges, parallel_squared })
    }

    /// Unit, on the side from which the corners run counter-clockwise.
    pub fn normal(&self) -> DVec3 {
        self.edges[0].cross(self.edges[1]).normalize()
    }

    /// In square units.
    pub fn area(&self) -> f64 {
        self.edges[0].cross(self.edges[1]).length() / 2.0
    }

    /// The point with weights `uv` of vertices 1 and 2.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        self.corner + uv.x * self.edges[0] + uv.y * self.edges[1]
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb {
        let [b, c] = self.edges.map(|edge| self.corner + edge);
        Aabb { min: self.corner.min(b).min(c), max: self.corner.max(b).max(c) }
    }

    /// Möller and Trumbore 1997: solve origin + t·direction = (1 − u − v)·a + u·b + v·c by Cramer's rule.
    /// Both sides are hit, and edges belong to the triangle.
    pub fn intersect(&self, ray: &Ray) -> Option<Crossing> {
        let [edge1, edge2] = self.edges;
        let p = ray.direction.cross(edge2);
        let determinant = edge1.dot(p);
        if self.is_parallel(ray, determinant) {
            return None;
        }
        let from_corner = ray.origin - self.corner;
        let u = from_corner.dot(p) / determinant;
        if !(0.0..=1.0).contains(&u) {
            return None;
        }
        let q = from_corner.cross(edge1);
        let v = ray.direction.dot(q) / determinant;
        let t = edge2.dot(q) / determinant;
        let inside = v >= 0.0 && u + v <= 1.0;
        (inside && contains(ray, t)).then_some(Crossing { t, uv: DVec2::new(u, v) })
    }

    fn is_parallel(&self, ray: &Ray, determinant: f64) -> bool {
        determinant * determinant <= self.parallel_squared * ray.direction.length_squared()
    }
}

/// A sphere without a side.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// World space.
    pub centre: DVec3,
    /// Scene units, positive.
    pub radius: f64,
}

impl Ball {
    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.centre - self.radius, max: self.centre + self.radius }
    }

    /// Unit, away from the centre.
    pub fn outward_normal(&self, point: DVec3) -> DVec3 {
        (point - self.centre).normalize()
    }

    /// The nearer crossing inside the segment; from inside the ball that is the far one.
    pub fn intersect(&self, ray: &Ray) -> Option<Crossing> {
        let (near, far) = self.roots(ray)?;
        let t = [near, far].into_iter().find(|t| contains(ray, *t))?;
        Some(Crossing { t, uv: DVec2::ZERO })
    }

    /// Both solutions of |origin + t·direction − centre|² = radius², in order.
    ///
    /// The discriminant comes from the distance between centre and line, and the smaller root from the product of
    /// both: neither subtracts large equal numbers when the ball is small and far away (Haines et al.,
    /// Ray Tracing Gems, chapter 7).
    fn roots(&self, ray: &Ray) -> Option<(f64, f64)> {
        let from_centre = ray.origin - self.centre;
        let a = ray.direction.length_squared();
        let half_b = from_centre.dot(ray.direction);
        let c = from_centre.length_squared() - self.radius * self.radius;
        let nearest = from_centre - half_b / a * ray.direction;
        let discriminant = a * (self.radius * self.radius - nearest.length_squared());
        if discriminant < 0.0 {
            return None;
        }
        let q = -(half_b + discriminant.sqrt().copysign(half_b));
        let (first, second) = (c / q, q / a);
        Some(if first <= second { (first, second) } else { (second, first) })
    }
}

/// Whether `t` lies strictly inside the ray's segment. Not a number lies nowhere.
fn contains(ray: &Ray, t: f64) -> bool {
    ray.t_min < t && t < ray.t_max
}

/// Where the line of `ray` enters and leaves the closed box, if the box meets the closed segment.
pub fn intersect_box(bounds: &Aabb, ray: &Ray) -> Option<(f64, f64)> {
    let (x_enter, x_exit) = intersect_slab(bounds, ray, 0)?;
    let (y_enter, y_exit) = intersect_slab(bounds, ray, 1)?;
    let (z_enter, z_exit) = intersect_slab(bounds, ray, 2)?;
    let enter = x_enter.max(y_enter).max(z_enter);
    let exit = x_exit.min(y_exit).min(z_exit);
    let overlaps = enter <= exit && enter <= ray.t_max && exit >= ray.t_min;
    overlaps.then_some((enter, exit))
}

/// Where the line lies between the two planes of one axis.
///
/// A ray along the planes is inside for ever or never; dividing by its zero would give 0/0 on a plane, and the
/// wrong infinity for a direction of −0.
fn intersect_slab(bounds: &Aabb, ray: &Ray, axis: usize) -> Option<(f64, f64)> {
    let (low, high) = (bounds.min[axis], bounds.max[axis]);
    let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
    if direction == 0.0 {
        let inside = low <= origin && origin <= high;
        return inside.then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (at_low, at_high) = ((low - origin) / direction, (high - origin) / direction);
    Some(if direction > 0.0 { (at_low, at_high) } else { (at_high, at_low) })
}
