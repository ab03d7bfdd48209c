//! A renderer of triangles and spheres that knows nothing of furnace: what stands here is yours.

use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

/// The points `origin + t · direction` for t between `min` and `max`.
#[derive(Clone, Copy)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
    pub min: f64,
    pub max: f64,
}

/// Where a ray meets something: how far along it, which way that faces, and the weights of vertices 1 and 2.
#[derive(Clone, Copy)]
pub struct Hit {
    pub t: f64,
    pub normal: DVec3,
    pub weights: DVec2,
}

/// A pinhole that looks along its own −z.
pub struct Camera {
    pub position: DVec3,
    pub to_world: DMat3,
    /// Whole angles, radians.
    pub fov: DVec2,
    pub near: f64,
    pub far: f64,
}

impl Camera {
    /// The ray through a point of the film, whose corners are (0, 0) below left and (1, 1).
    pub fn ray(&self, film: DVec2) -> Ray {
        let half = DVec2::new((self.fov.x / 2.0).tan(), (self.fov.y / 2.0).tan());
        let direction = self.to_world * ((2.0 * film - 1.0) * half).extend(-1.0);
        let (min, max) = (self.near, self.far);
        Ray { origin: self.position, direction: direction.normalize(), min, max }
    }
}

pub enum Shape {
    Triangle([DVec3; 3]),
    Sphere { centre: DVec3, radius: f64 },
}

impl Shape {
    pub fn hit(&self, ray: &Ray) -> Option<Hit> {
        match self {
            Self::Triangle(corners) => triangle(*corners, ray),
            Self::Sphere { centre, radius } => sphere(*centre, *radius, ray),
        }
    }
}

/// Möller and Trumbore, with room for rounding, so that no ray slips through an edge.
fn triangle([a, b, c]: [DVec3; 3], ray: &Ray) -> Option<Hit> {
    const ROOM: f64 = 1e-12;
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac).try_normalize()?;
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    let from = ray.origin - a;
    let q = from.cross(ab);
    let (u, v) = (from.dot(p) / determinant, ray.direction.dot(q) / determinant);
    let t = ac.dot(q) / determinant;
    let is_inside = u >= -ROOM && v >= -ROOM && u + v <= 1.0 + ROOM;
    let weights = DVec2::new(u, v);
    (is_inside && ray.min < t && t < ray.max).then_some(Hit { t, normal, weights })
}

/// Around the point of the ray that is nearest to the centre: nothing cancels there, however far the sphere is.
fn sphere(centre: DVec3, radius: f64, ray: &Ray) -> Option<Hit> {
    let squared = ray.direction.length_squared();
    let nearest = (centre - ray.origin).dot(ray.direction) / squared;
    let off = ray.origin + nearest * ray.direction - centre;
    let left = radius * radius - off.length_squared();
    if left < 0.0 {
        return None;
    }
    let half = (left / squared).sqrt();
    let ahead = |t: &f64| ray.min < *t && *t < ray.max;
    let t = [nearest - half, nearest + half].into_iter().find(ahead)?;
    let normal = (ray.origin + t * ray.direction - centre).normalize();
    Some(Hit { t, normal, weights: DVec2::ZERO })
}

/// Where a ray enters and leaves a box.
pub fn slabs(low: DVec3, high: DVec3, ray: &Ray) -> Option<(f64, f64)> {
    let (mut enter, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction == 0.0 {
            // Along the planes a ray is inside for ever or never.
            if !(low[axis]..=high[axis]).contains(&origin) {
                return None;
            }
            continue;
        }
        let (a, b) = ((low[axis] - origin) / direction, (high[axis] - origin) / direction);
        (enter, exit) = (enter.max(a.min(b)), exit.min(a.max(b)));
    }
    (enter <= exit && enter <= ray.max && exit >= ray.min).then_some((enter, exit))
}

/// A direction of the hemisphere around +z: of height 1 − u uniform, of height √(1 − u) proportional to the cosine.
pub fn hemisphere(random: DVec2, cosine_weighted: bool) -> DVec3 {
    let height = if cosine_weighted { (1.0 - random.x).sqrt() } else { 1.0 - random.x };
    let across = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * random.y).sin_cos();
    DVec3::new(across * cos, across * sin, height)
}

/// With which pdf `hemisphere` draws a direction, per steradian.
pub fn hemisphere_pdf(direction: DVec3, cosine_weighted: bool) -> f64 {
    match direction.z {
        z if z <= 0.0 => 0.0,
        z if cosine_weighted => z / PI,
        _ => 0.5 / PI,
    }
}
