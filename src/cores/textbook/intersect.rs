//! Parts 1 and 2: one ray against one triangle, one sphere, one box.
//!
//! Rays may have directions of any length; `t` counts in units of that length. Triangles and
//! spheres are hit strictly inside the segment (t_min, t_max); boxes are closed. Not here: normals
//! that are interpolated, and which shape a primitive belongs to (`world`).

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

/// A ray is parallel to a triangle if the sine of their angle is below this: a few rounding errors.
/// Relative to all lengths involved, so that small triangles do not vanish.
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

    /// Möller and Trumbore 1997: solve origin + t·direction = (1 − u − v)·a + u·b + v·c by Cramer's
    /// rule. Both sides are hit, and edges belong to the triangle.
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
    /// The discriminant comes from the distance between centre and line, and the smaller root from
    /// the product of both: neither subtracts large equal numbers when the ball is small and far
    /// away (Haines et al., Ray Tracing Gems, chapter 7).
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
/// A ray along the planes is inside for ever or never; dividing by its zero would give 0/0 on a
/// plane, and the wrong infinity for a direction of −0.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::random::Random;

    /// A vector with components between −1 and 1.
    fn vector(random: &mut Random) -> DVec3 {
        let DVec2 { x, y } = random.point();
        2.0 * DVec3::new(x, y, random.number()) - 1.0
    }

    /// A triangle of size 1e-3 to 1e3, a ray through its point with weights `uv` at parameter `t`.
    fn aimed(random: &mut Random, uv: DVec2, t: f64) -> (Triangle, Ray) {
        let scale = 10.0_f64.powf(6.0 * random.number() - 3.0);
        let triangle = loop {
            let corners = [(); 3].map(|()| scale * vector(random));
            let is_plump = |triangle: &Triangle| triangle.area() > 0.05 * scale * scale;
            if let Some(triangle) = Triangle::new(corners).filter(is_plump) {
                break triangle;
            }
        };
        let direction = loop {
            let direction = scale * vector(random);
            if direction.normalize().dot(triangle.normal()).abs() > 0.05 {
                break direction;
            }
        };
        (triangle, Ray::new(triangle.point(uv) - t * direction, direction))
    }

    #[test]
    fn rays_aimed_into_a_triangle_hit_it_where_they_were_aimed() {
        let mut random = Random::for_ray(1, 0);
        for _ in 0..20_000 {
            let (u, t) = (random.number(), 0.1 + 3.0 * random.number());
            let uv =
                DVec2::new(u, (1.0 - u) * random.number()).clamp(DVec2::splat(1e-9), DVec2::ONE);
            let (triangle, ray) = aimed(&mut random, uv * (1.0 - 1e-8), t);
            let crossing = triangle.intersect(&ray).expect("aimed inside");
            assert!((crossing.t - t).abs() < 1e-11, "{crossing:?} {t}");
            assert!(crossing.uv.abs_diff_eq(uv * (1.0 - 1e-8), 1e-11), "{crossing:?} {uv}");
        }
    }

    #[test]
    fn rays_aimed_beside_a_triangle_miss_it() {
        let mut random = Random::for_ray(2, 0);
        let beside = [[-1e-9, 0.5], [0.5, -1e-9], [0.5, 0.5 + 1e-9], [1.7, -0.3], [-0.4, 1.1]];
        for uv in beside.into_iter().cycle().take(20_000) {
            let (triangle, ray) = aimed(&mut random, DVec2::from(uv), 1.0);
            assert_eq!(triangle.intersect(&ray), None, "{uv:?}");
        }
    }

    fn unit_triangle() -> Triangle {
        Triangle::new([DVec3::ZERO, DVec3::X, DVec3::Y]).expect("it has area")
    }

    #[test]
    fn a_triangle_is_hit_from_both_sides_and_on_its_edges() {
        for z in [1.0, -1.0] {
            for at in [[0.25, 0.25], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.5], [0.0, 0.3]] {
                let ray = Ray::new(DVec3::new(at[0], at[1], z), DVec3::new(0.0, 0.0, -z));
                let crossing = unit_triangle().intersect(&ray);
                assert_eq!(crossing, Some(Crossing { t: 1.0, uv: DVec2::from(at) }), "{z} {at:?}");
            }
        }
    }

    #[test]
    fn hits_lie_strictly_inside_the_segment() {
        let ray = Ray::new(DVec3::new(0.25, 0.25, 2.0), DVec3::NEG_Z);
        let ball = Ball { centre: DVec3::new(0.25, 0.25, -1.0), radius: 1.0 };
        for (t_min, t_max, is_hit) in
            [(0.0, 3.0, true), (2.0, 3.0, false), (0.0, 2.0, false), (1.999, 2.001, true)]
        {
            let segment = Ray { t_min, t_max, ..ray };
            let hits = (unit_triangle().intersect(&segment), ball.intersect(&segment));
            assert_eq!((hits.0.is_some(), hits.1.is_some()), (is_hit, is_hit), "{segment:?}");
        }
    }

    #[test]
    fn triangles_without_area_and_rays_in_the_plane_are_never_hit() {
        let (a, b) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(100.7, -3.3, 8.9));
        let nan = DVec3::new(0.0, f64::NAN, 0.0);
        for corners in [[a, a, a], [a, b, b], [a, b, a + 0.3 * (b - a)], [nan, a, b], [a, b, nan]] {
            assert!(Triangle::new(corners).is_none(), "{corners:?}");
        }
        let mut random = Random::for_ray(3, 0);
        for _ in 0..10_000 {
            let (triangle, _) = aimed(&mut random, DVec2::splat(0.3), 1.0);
            let in_plane = triangle.edges[0] + random.number() * triangle.edges[1];
            let ray = Ray::new(triangle.point(DVec2::splat(0.3)) - 2.0 * in_plane, in_plane);
            assert_eq!(triangle.intersect(&ray), None, "{triangle:?}");
        }
    }

    #[test]
    fn a_ball_is_hit_at_its_near_side_from_outside_and_its_far_side_from_inside() {
        let ball = Ball { centre: DVec3::new(1.0, 2.0, 3.0), radius: 0.5 };
        let t_from = |z: f64, speed: f64| {
            let ray = Ray::new(ball.centre + DVec3::Z * z, DVec3::NEG_Z * speed);
            ball.intersect(&ray).map(|crossing| crossing.t)
        };
        assert_eq!(t_from(2.0, 1.0), Some(1.5));
        assert_eq!(t_from(2.0, 0.25), Some(6.0));
        assert_eq!(t_from(0.25, 1.0), Some(0.75));
        assert_eq!(t_from(0.0, 1.0), Some(0.5));
        assert_eq!(t_from(-2.0, 1.0), None);
    }

    #[test]
    fn a_far_small_ball_is_found_where_it_is() {
        let ball = Ball { centre: DVec3::ZERO, radius: 1.0 };
        for distance in [1e2, 1e4, 1e6] {
            let (offset, direction) = (DVec3::new(0.6, 0.0, 0.0), DVec3::new(0.0, 0.6, -0.8));
            let ray = Ray::new(offset - distance * direction, direction);
            let t = ball.intersect(&ray).expect("aimed at it").t;
            let allowed = 16.0 * f64::EPSILON * distance * distance;
            assert!((t - (distance - 0.8)).abs() <= allowed, "{distance}: {t}");
        }
    }

    #[test]
    fn rays_that_leave_a_ball_do_not_meet_it_again() {
        let ball = Ball { centre: DVec3::new(3.0, -1.0, 2.0), radius: 0.7 };
        let mut random = Random::for_ray(4, 0);
        for _ in 0..10_000 {
            let normal = vector(&mut random).normalize();
            let direction = (normal + 0.999 * vector(&mut random).normalize()).normalize();
            let point = ball.centre + ball.radius * normal;
            let ray = Ray { t_min: 1e-9, ..Ray::new(point, direction) };
            assert_eq!(ball.intersect(&ray), None, "{ray:?}");
        }
    }

    const INF: f64 = f64::INFINITY;
    const BOX: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]];
    const FLAT: [[f64; 3]; 2] = [[0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    const POINT: [[f64; 3]; 2] = [[1.0; 3]; 2];
    const FAR: [[f64; 3]; 2] = [[1e15, 0.0, 0.0], [2e15, 1.0, 1.0]];

    type BoxRow = (&'static str, [[f64; 3]; 2], [f64; 3], [f64; 3], [f64; 2], bool);

    /// The catalogue's rows for X1; what is expected was computed with rational numbers.
    #[rustfmt::skip]
    const BOX_ROWS: [BoxRow; 28] = [
        ("through, +x", BOX, [-1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("through, -x", BOX, [2.0, 1.0, 1.0], [-1.0, 0.0, 0.0], [0.0, INF], true),
        ("parallel, outside", BOX, [-1.0, 5.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], false),
        ("parallel, outside, -0", BOX, [-1.0, 5.0, 1.0], [1.0, -0.0, -0.0], [0.0, INF], false),
        ("origin inside", BOX, [0.5, 0.5, 0.5], [0.3, -0.2, 0.7], [0.0, INF], true),
        ("behind", BOX, [2.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], false),
        ("behind, oblique", BOX, [3.0, 4.0, 5.0], [1.0, 1.1, 1.2], [0.0, INF], false),
        ("beyond t_max", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 4.5], false),
        ("t_max at the entry", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 5.0], true),
        ("before t_min", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [6.5, INF], false),
        ("t_min inside", BOX, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0], [5.5, INF], true),
        ("in a face", BOX, [-1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("in the upper face", BOX, [-1.0, 2.0, 1.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("in a face, -0", BOX, [-1.0, 0.0, 1.0], [1.0, -0.0, -0.0], [0.0, INF], true),
        ("in an edge", BOX, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("in an edge, -0", BOX, [-1.0, 2.0, 3.0], [1.0, -0.0, -0.0], [0.0, INF], true),
        ("flat", FLAT, [0.5, 0.0, 0.5], [0.0, 1.0, 0.0], [0.0, INF], true),
        ("flat, oblique", FLAT, [0.2, 0.0, 0.3], [0.1, 1.0, 0.2], [0.0, INF], true),
        ("flat, in its plane", FLAT, [-1.0, 1.0, 0.5], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("point", POINT, [0.0; 3], [1.0; 3], [0.0, INF], true),
        ("diagonal", BOX, [-1.0; 3], [1.0; 3], [0.0, INF], true),
        ("past a corner", BOX, [-1.0, 1.5, 1.0], [1.0, 1.0, 0.0], [0.0, INF], false),
        ("past in z alone", BOX, [-1.0, 0.5, 4.0], [1.0, 0.1, 0.01], [0.0, INF], false),
        ("long direction", BOX, [-10.0, 1.0, 1.0], [1000.0, 0.0, 0.0], [0.0, INF], true),
        ("tiny component", BOX, [-1.0, 1.0, 1.0], [1.0, 1e-300, 0.0], [0.0, INF], true),
        ("huge", FAR, [0.0, 0.5, 0.5], [1.0, 0.0, 0.0], [0.0, INF], true),
        ("away", BOX, [-1.0; 3], [-1.0; 3], [0.0, INF], false),
        ("inside, short", BOX, [0.5; 3], [1.0; 3], [0.0, 1e-12], true),
    ];

    #[test]
    fn boxes_are_closed_and_no_direction_confuses_the_slabs() {
        for (name, [min, max], origin, direction, [t_min, t_max], expected) in BOX_ROWS {
            let bounds = Aabb { min: min.into(), max: max.into() };
            let ray = Ray { origin: origin.into(), t_min, direction: direction.into(), t_max };
            assert_eq!(intersect_box(&bounds, &ray).is_some(), expected, "{name}");
        }
    }

    #[test]
    fn a_box_is_entered_and_left_where_its_planes_are() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 3.0) };
        let through = Ray::new(DVec3::new(-1.0, 1.0, 1.0), DVec3::new(0.5, 0.0, 0.0));
        assert_eq!(intersect_box(&bounds, &through), Some((2.0, 4.0)));
        let from_inside = Ray::new(DVec3::splat(0.5), DVec3::new(0.0, 0.0, -1.0));
        assert_eq!(intersect_box(&bounds, &from_inside), Some((-2.5, 0.5)));
    }
}
