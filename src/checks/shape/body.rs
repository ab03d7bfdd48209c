//! Random primitives of any size, and rays at them.

use crate::contract::{Primitive, Ray};
use crate::math::rng::{Stream, in_cube, uniform};
use crate::math::sphere::on_sphere;
use glam::DVec3;

/// How far the first rays come from, in sizes of the primitive.
pub(super) const FROM: f64 = 10.0;

/// Draws a primitive.
pub(super) type RandomBody = fn(&mut Stream) -> Body;

/// A primitive and its size.
pub(super) struct Body {
    pub(super) primitive: Primitive,
    pub(super) middle: DVec3,
    pub(super) size: f64,
}

fn random_vector(stream: &mut Stream) -> DVec3 {
    2.0 * in_cube(stream) - 1.0
}

impl Body {
    fn random_size(stream: &mut Stream) -> f64 {
        2f64.powf(20.0 * uniform(stream) - 10.0)
    }

    pub(super) fn sphere(stream: &mut Stream) -> Self {
        let size = Self::random_size(stream);
        let middle = size * random_vector(stream);
        Self { primitive: Primitive::Sphere { centre: middle, radius: size }, middle, size }
    }

    pub(super) fn triangle(stream: &mut Stream) -> Self {
        let size = Self::random_size(stream);
        let positions = [(); 3].map(|()| size * random_vector(stream));
        let [a, b, c] = positions;
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let primitive = Primitive::Triangle { positions, normals: [normal; 3] };
        Self { primitive, middle: positions.iter().sum::<DVec3>() / 3.0, size }
    }

    /// From around, at points near the middle.
    pub(super) fn ray(&self, stream: &mut Stream) -> Ray {
        let origin = self.middle + FROM * self.size * on_sphere(stream);
        let target = self.middle + 0.5 * self.size * random_vector(stream);
        Ray::new(origin, (target - origin).normalize())
    }
}
