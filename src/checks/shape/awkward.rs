//! Triangles without area, and rays in the plane and along the edges of one that has some.

use crate::contract::{Primitive, Ray};
use crate::math::rng::{Stream, uniform};
use crate::math::sphere::on_sphere;
use glam::DVec3;

/// Rays of each kind at each triangle.
const RAYS_EACH: usize = 200;

/// Lengths of directions.
const LENGTHS: [f64; 4] = [1e-3, 0.125, 30.0, 1e3];

/// A triangle, some rays, and whether any of them may hit.
pub(super) struct Question {
    pub(super) name: &'static str,
    pub(super) primitive: Primitive,
    pub(super) rays: Vec<Ray>,
    pub(super) may_hit: bool,
}

/// Which rays divide 0 by 0 at a triangle that is one.
pub(super) const IN_PLANE: &str = "a ray in the plane of its triangle";

/// Which rays all hit a triangle that is one, far from its edges.
pub(super) const ANY_LENGTH: &str = "a direction of any length";

const PROPER: [DVec3; 3] =
    [DVec3::new(0.25, 0.5, -0.25), DVec3::new(1.5, 0.75, 0.5), DVec3::new(-0.5, 1.25, 1.0)];

pub(super) fn questions(stream: &mut Stream) -> Vec<Question> {
    let [a, b, c] = PROPER;
    let without_area = [
        ("three times the same vertex", [a, a, a]),
        ("the first two vertices equal", [a, a, c]),
        ("the last two vertices equal", [a, b, b]),
        ("the first and the last vertex equal", [a, b, a]),
        ("vertices on a line", [a, a + 0.5 * (b - a), b]),
        ("a vertex that is NaN", [a, DVec3::NAN, c]),
        ("all vertices NaN", [DVec3::NAN; 3]),
    ];
    let degenerate = without_area.map(|(name, vertices)| {
        let (primitive, rays) = (triangle(vertices), rays_at(a, b, stream));
        Question { name, primitive, rays, may_hit: false }
    });
    let proper = [
        (IN_PLANE, in_plane(stream)),
        ("a ray along an edge", along_edges(stream)),
        (ANY_LENGTH, of_any_length(stream)),
    ];
    let primitive = triangle(PROPER);
    let proper = proper.map(|(name, rays)| Question { name, primitive, rays, may_hit: true });
    degenerate.into_iter().chain(proper).collect()
}

/// With a normal that is unit, whatever the vertices are.
fn triangle(positions: [DVec3; 3]) -> Primitive {
    Primitive::Triangle { positions, normals: [DVec3::Z; 3] }
}

/// At points between two vertices, from all sides.
fn rays_at(a: DVec3, b: DVec3, stream: &mut Stream) -> Vec<Ray> {
    let ray = |_| {
        let target = a.lerp(b, uniform(stream));
        let origin = target + 2.0 * on_sphere(stream);
        Ray::new(origin, target - origin)
    };
    (0..RAYS_EACH).map(ray).collect()
}

/// Between points of the plane; half of them start inside the triangle.
fn in_plane(stream: &mut Stream) -> Vec<Ray> {
    let [a, b, c] = PROPER;
    let point = |stream: &mut Stream, reach: f64| {
        a + reach * uniform(stream) * (b - a) + reach * uniform(stream) * (c - a)
    };
    let ray = |number: usize| {
        let origin = point(stream, if number.is_multiple_of(2) { 0.5 } else { -2.0 });
        Ray::new(origin, point(stream, 1.0) - origin)
    };
    (0..RAYS_EACH).map(ray).collect()
}

fn along_edges(stream: &mut Stream) -> Vec<Ray> {
    let ray = |number: usize| {
        let (from, to) = (PROPER[number % 3], PROPER[(number + 1) % 3]);
        let origin = from - 2.0 * uniform(stream) * (to - from);
        Ray::new(origin, to - from)
    };
    (0..RAYS_EACH).map(ray).collect()
}

fn of_any_length(stream: &mut Stream) -> Vec<Ray> {
    let middle = PROPER.iter().sum::<DVec3>() / 3.0;
    let ray = |number: usize| {
        let toward = on_sphere(stream);
        Ray::new(middle - toward, LENGTHS[number % LENGTHS.len()] * toward)
    };
    (0..RAYS_EACH).map(ray).collect()
}
