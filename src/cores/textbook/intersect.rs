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

    /// Möller and Trumbore 1997: solve origin + t·direction = (1 − u − v)·a + u·b + v·c by Cramer's
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
        steps.triangle_holds(u, v, error).then_some(Crossing { t, uv: DVec2::new(u, v) })
    }
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
pub(crate) struct Ball {
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

impl Ball {
    /// `None` unless it has a size and a place.
    pub(crate) fn new(centre: DVec3, radius: f64) -> Option<Self> {
        (radius > 0.0 && centre.is_finite()).then_some(Self { centre, radius })
    }

    pub(crate) fn bounds(&self) -> Aabb {
        Aabb { min: self.centre - self.radius, max: self.centre + self.radius }
    }

    /// The nearer crossing inside the segment; from inside the ball that is the far one.
    pub(crate) fn intersect(&self, ray: &Ray, steps: &Steps) -> Option<Crossing> {
        let quadratic = self.quadratic(ray);
        if quadratic.discriminant < 0.0 {
            return None;
        }
        let (first, second) = steps.roots(quadratic);
        let (near, far) = if first <= second { (first, second) } else { (second, first) };
        steps.nearer_root(ray, near, far).map(|t| Crossing { t, uv: DVec2::ZERO })
    }

    /// |origin + t·direction − centre|² = radius².
    ///
    /// The discriminant comes from the distance between centre and line: no large equal numbers are
    /// subtracted when the ball is small and far away (Haines et al., Ray Tracing Gems, chapter 7).
    fn quadratic(&self, ray: &Ray) -> Quadratic {
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

/// Unit, away from the centre.
pub(crate) fn outward_normal(ball: &Ball, point: DVec3) -> DVec3 {
    (point - ball.centre).normalize()
}

/// Whether `t` lies strictly inside the ray's segment. Not a number lies nowhere.
pub(crate) fn contains(ray: &Ray, t: f64) -> bool {
    ray.t_min < t && t < ray.t_max
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::random::Random;
    use crate::cores::textbook::steps::LESSON;

    /// A vector with components between −1 and 1.
    fn vector(random: &mut Random<'_>) -> DVec3 {
        let DVec2 { x, y } = random.point();
        2.0 * DVec3::new(x, y, random.number()) - 1.0
    }

    /// A triangle of size 1e-3 to 1e3, a ray through its point with weights `uv` at parameter `t`.
    fn aimed(random: &mut Random<'_>, uv: DVec2, t: f64) -> (Triangle, Ray) {
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
            let crossing = triangle.intersect(&ray, &LESSON).expect("aimed inside");
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
            assert_eq!(triangle.intersect(&ray, &LESSON), None, "{uv:?}");
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
                let crossing = unit_triangle().intersect(&ray, &LESSON);
                assert_eq!(crossing, Some(Crossing { t: 1.0, uv: DVec2::from(at) }), "{z} {at:?}");
            }
        }
    }

    /// The unit square in two halves; a ray through their diagonal hits at least one of them.
    #[test]
    fn no_ray_slips_through_a_shared_edge() {
        let mut random = Random::for_ray(5, 0);
        for _ in 0..20_000 {
            let [a, b, c, d] = [(); 4].map(|()| vector(&mut random));
            let halves = [[a, b, c], [c, d, a]].map(Triangle::new);
            let along = random.number();
            let target = a.lerp(c, along);
            let distance = 10.0_f64.powf(6.0 * random.number() - 3.0);
            let direction = vector(&mut random);
            let ray = Ray::new(target - distance * direction, direction);
            let hits =
                halves.iter().flatten().filter_map(|half| half.intersect(&ray, &LESSON)).count();
            assert!(hits > 0, "{ray:?} {halves:?}");
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
            let hits =
                (unit_triangle().intersect(&segment, &LESSON), ball.intersect(&segment, &LESSON));
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
            assert_eq!(triangle.intersect(&ray, &LESSON), None, "{triangle:?}");
        }
    }

    #[test]
    fn a_ball_is_hit_at_its_near_side_from_outside_and_its_far_side_from_inside() {
        let ball = Ball { centre: DVec3::new(1.0, 2.0, 3.0), radius: 0.5 };
        let t_from = |z: f64, speed: f64| {
            let ray = Ray::new(ball.centre + DVec3::Z * z, DVec3::NEG_Z * speed);
            ball.intersect(&ray, &LESSON).map(|crossing| crossing.t)
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
            let t = ball.intersect(&ray, &LESSON).expect("aimed at it").t;
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
            assert_eq!(ball.intersect(&ray, &LESSON), None, "{ray:?}");
        }
    }
}
