//! Points of a path, and the rays that leave them.

use super::bsdf;
use super::frame::Frame;
use super::light::Emitter;
use crate::contract::{Hit, LightSample, Ray};
use crate::scene::Surface;
use glam::DVec3;

#[derive(Debug)]
pub(crate) enum View<'a> {
    Surface(Vertex<'a>),
    /// Nothing: the sky in this direction (unit).
    Sky(DVec3),
}

/// A point of a path on a surface.
#[derive(Debug)]
pub(crate) struct Vertex<'a> {
    /// World space.
    pub(crate) point: DVec3,
    /// Geometric, unit, on the side that emits.
    pub(crate) normal: DVec3,
    pub(crate) frame: Frame,
    /// Back along the path, local, unit.
    pub(crate) wo: DVec3,
    pub(crate) surface: &'a Surface,
    /// Radiance it emits back along the path.
    pub(crate) emitted: DVec3,
    pub(crate) light: Option<&'a Emitter>,
    /// Rays that leave the point start this far away.
    pub(crate) clearance: f64,
    /// How far the path came from the point before.
    pub(crate) travelled: f64,
}

/// Share of the largest length involved by which rays keep clear of the surface they leave: far
/// above the rounding of f64, far below anything that is seen.
pub(crate) const CLEARANCE: f64 = 1e-10;

/// The ray from a vertex in a direction of the world: as long as it finds nothing, without end.
pub(crate) fn ray_from(vertex: &Vertex<'_>, direction: DVec3) -> Ray {
    Ray { t_min: vertex.clearance, ..Ray::new(vertex.point, direction) }
}

/// The ray to the point of a light that was sampled. It stops short of the light, which would shadow itself.
pub(crate) fn shadow_ray(vertex: &Vertex<'_>, sample: &LightSample) -> Ray {
    let distance = sample.distance;
    let stop_short = vertex.clearance.max(CLEARANCE * distance);
    let t_max = if distance.is_finite() { distance - stop_short } else { distance };
    Ray { origin: vertex.point, t_min: vertex.clearance, direction: sample.wi, t_max }
}

/// How far rays must keep clear of a point: its error grows with the `longest` of where the ray
/// began, how far it came, and the coordinates of what it hit.
pub(crate) fn clearance(longest: f64) -> f64 {
    CLEARANCE * longest
}

/// The shading normal; but glass has an inside, and where the shading normal disagrees with the
/// geometric one about the side the ray is on, the latter is right.
pub(crate) fn frame_normal(surface: &Surface, hit: &Hit, to_viewer: DVec3) -> DVec3 {
    let agree = hit.shading_normal.dot(to_viewer) * hit.geometric_normal.dot(to_viewer) > 0.0;
    if bsdf::is_interface(surface) && !agree { hit.geometric_normal } else { hit.shading_normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{Sampler, TraversalStats};
    use crate::cores::stage::{Stage, clear_glass, diffuse};
    use crate::cores::textbook::random::Random;
    use crate::cores::textbook::sampling;
    use crate::cores::textbook::steps::LESSON;
    use crate::scene::Mesh;

    /// Far from the origin, and on a large triangle, where rounding is worst.
    #[test]
    fn rays_that_leave_a_surface_neither_meet_it_again_nor_skip_what_is_near() {
        let offset = DVec3::new(300.0, -200.0, 100.0);
        let corners = [(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)];
        let floor = corners.map(|(x, y)| offset + DVec3::new(x, y + 0.3 * x, x - 0.7 * y));
        let sphere = offset + DVec3::new(0.0, 0.0, 2.0);
        let world =
            Stage::empty().polygon(&floor, diffuse(0.5)).sphere(sphere, 1.0, diffuse(0.5)).world();
        let mut random = Random::for_ray(1, 0);
        for _ in 0..10_000 {
            let target = offset + 3.0 * (random.point() - 0.5).extend(0.0);
            let origin = target + DVec3::new(0.5, 0.2, 5.0);
            let View::Surface(vertex) = world.look(&Ray::new(origin, target - origin)) else {
                continue;
            };
            let wi = sampling::direction(Sampler::UniformHemisphere, random.point(), &LESSON);
            let wi = if vertex.wo.z < 0.0 { -wi } else { wi };
            let ray = ray_from(&vertex, vertex.frame.to_world(wi));
            let again = world.closest_hit(&ray, &mut TraversalStats::default());
            assert!(again.is_none_or(|hit| hit.t > 1e-6), "{ray:?} {again:?}");
        }
    }

    #[test]
    fn glass_goes_by_the_geometric_side() {
        let mesh = Mesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            normals: vec![DVec3::new(0.8, 0.0, 0.6); 3],
            indices: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let world = Stage::empty().mesh(mesh, clear_glass()).world();
        // From the front of the triangle, but from behind its shading normal.
        let from = DVec3::new(-3.0, 0.2, 0.5);
        let View::Surface(vertex) = world.look(&Ray::new(from, DVec3::new(0.2, 0.2, 0.0) - from))
        else {
            panic!("aimed at it");
        };
        assert!(vertex.wo.z > 0.0, "{vertex:?}");
    }
}
