//! Pairs of triangles whose coordinates are small integers, with rays exactly at the edge that they share.

use crate::contract::Ray;
use crate::math::rng::{Stream, uniform};
use glam::{DVec2, DVec3, IVec2, Vec3Swizzles};

/// Rays start so far from the plane of the axes they cross; triangles stay well within.
const AWAY: f64 = 64.0;

/// Coordinates on the lattice are between minus this and this.
pub(super) const REACH: i32 = 4;

/// Two triangles on either side of an edge, and the rays at them.
pub(super) struct Pair {
    pub(super) triangles: [[DVec3; 3]; 2],
    /// At the edge, into the one triangle, and into the other.
    pub(super) rays: [Ray; 3],
}

impl Pair {
    pub(super) fn random(stream: &mut Stream) -> Self {
        let [start, along, left, right] = corners(stream);
        let place = Place::random(stream);
        let first = below(stream, 3);
        let triangle = |apex: IVec2| {
            let mut corners = [start, start + along, start + apex].map(|p| place.on_plane(p));
            corners.rotate_left(first);
            corners
        };
        let quarter = f64::from(1 + below(stream, 3) as u8) / 4.0;
        let at_edge = start.as_dvec2() + quarter * along.as_dvec2();
        let into = |apex: IVec2| at_edge.lerp((start + apex).as_dvec2(), 0.25);
        Self {
            triangles: [left, right].map(triangle),
            rays: [at_edge, into(left), into(right)].map(|p| place.ray_through(p)),
        }
    }
}

/// Where an edge starts, how it runs, and the third corner on either side of it, both seen from the start; the areas
/// are powers of two.
fn corners(stream: &mut Stream) -> [IVec2; 4] {
    loop {
        let [start, along, left, right] = std::array::from_fn(|_| lattice(stream));
        let [left_area, right_area] = [left, right].map(|apex| along.perp_dot(apex));
        let is_exact = |area: i32| area.unsigned_abs().is_power_of_two();
        if left_area > 0 && right_area < 0 && is_exact(left_area) && is_exact(right_area) {
            return [start, along, left, right];
        }
    }
}

pub(super) fn lattice(stream: &mut Stream) -> IVec2 {
    let mut coordinate = || below(stream, 2 * REACH as usize + 1) as i32 - REACH;
    IVec2::new(coordinate(), coordinate())
}

/// An integer from 0 up to and without `end`.
pub(super) fn below(stream: &mut Stream, end: usize) -> usize {
    (uniform(stream) * end as f64) as usize
}

/// How the lattice lies in space.
struct Place {
    /// Rise of the plane for a step along either axis of the lattice.
    slope: DVec2,
    /// Which axis rays run along, and in which direction.
    pub(super) axis: usize,
    pub(super) sign: f64,
}

impl Place {
    pub(super) fn random(stream: &mut Stream) -> Self {
        let mut rise = || below(stream, 3) as f64 - 1.0;
        let slope = DVec2::new(rise(), rise());
        let sign = if uniform(stream) < 0.5 { -1.0 } else { 1.0 };
        Self { slope, axis: below(stream, 3), sign }
    }

    fn on_plane(&self, p: IVec2) -> DVec3 {
        let p = p.as_dvec2();
        self.turned(p.extend(p.dot(self.slope)))
    }

    fn ray_through(&self, p: DVec2) -> Ray {
        let origin = self.turned(p.extend(-self.sign * AWAY));
        Ray::new(origin, self.turned(DVec3::new(0.0, 0.0, self.sign)))
    }

    /// The third axis becomes the one along the rays.
    fn turned(&self, p: DVec3) -> DVec3 {
        [p, p.yzx(), p.zxy()][self.axis]
    }
}
