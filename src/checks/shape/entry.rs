//! A triangle or a sphere as a case writes it.

use crate::contract::Primitive;
use crate::text::{Arrow, Positive, Vector};
use serde::Deserialize;

/// Vertices counter-clockwise, and the shading normals at them; none for a flat triangle.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TriangleEntry {
    vertices: [Vector; 3],
    normals: Option<[Arrow; 3]>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereEntry {
    centre: Vector,
    radius: Positive,
}

impl TriangleEntry {
    pub(super) fn primitive(self) -> Primitive {
        let positions = self.vertices.map(|vertex| vertex.0);
        let [a, b, c] = positions;
        let flat = (b - a).cross(c - a).normalize_or_zero();
        let unit = |typed: [Arrow; 3]| typed.map(|normal| normal.0.normalize_or_zero());
        Primitive::Triangle { positions, normals: self.normals.map_or([flat; 3], unit) }
    }
}

impl SphereEntry {
    pub(super) const fn primitive(self) -> Primitive {
        Primitive::Sphere { centre: self.centre.0, radius: self.radius.0 }
    }
}
