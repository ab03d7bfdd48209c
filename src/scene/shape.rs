//! Meshes, spheres and boxes.

use glam::DVec3;

/// A triangle mesh in world space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// As the scene file calls it, for messages.
    pub name: String,
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Unit shading normals, one a vertex, or none at all for a mesh with flat faces.
    pub normals: Vec<DVec3>,
    /// Three vertices a triangle, counter-clockwise seen from the front.
    pub indices: Vec<[u32; 3]>,
    /// Number of the material.
    pub material: u32,
}

impl Mesh {
    /// The vertices of triangle `number`, world space.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn corners(&self, number: usize) -> [DVec3; 3] {
        self.indices[number].map(|index| self.positions[index as usize])
    }

    /// The shading normals at the corners of triangle `number`: its own normal three times if the mesh is flat.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn corner_normals(&self, number: usize) -> [DVec3; 3] {
        if self.normals.is_empty() {
            let [a, b, c] = self.corners(number);
            [(b - a).cross(c - a).normalize_or_zero(); 3]
        } else {
            self.indices[number].map(|index| self.normals[index as usize])
        }
    }

    pub(crate) fn area(&self, number: usize) -> f64 {
        let [a, b, c] = self.corners(number);
        (b - a).cross(c - a).length() / 2.0
    }
}

/// A flat rectangle: where its middle is and which way it faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// World space.
    pub(crate) centre: DVec3,
    /// Two whole sides at a right angle.
    pub(crate) sides: [DVec3; 2],
    /// Unit, on the front side.
    pub(crate) normal: DVec3,
}

impl Mesh {
    /// The rectangle that a flat mesh of two triangles is, if it is one.
    pub(crate) fn as_rectangle(&self) -> Option<Rectangle> {
        let &[a, b, c, d] = self.positions.as_slice() else { return None };
        let [u, v] = [b - a, d - a];
        let is_parallelogram = (a + u + v).abs_diff_eq(c, 1e-12);
        let is_rectangular = u.dot(v).abs() <= 1e-12 * u.length() * v.length();
        let fan = [[0, 1, 2], [0, 2, 3]];
        let is_fan = self.indices.len() == 2 && fan.iter().all(|it| self.indices.contains(it));
        let is_plain = self.normals.is_empty() && is_fan;
        let normal = u.cross(v).try_normalize()?;
        let rectangle = Rectangle { centre: (a + c) / 2.0, sides: [u, v], normal };
        (is_plain && is_parallelogram && is_rectangular).then_some(rectangle)
    }
}

/// A sphere in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    /// As the scene file calls it, for messages.
    pub name: String,
    /// World space.
    pub centre: DVec3,
    /// Scene units, positive.
    pub radius: f64,
    /// Normals (and so the front side) point to the centre: a room, not a sphere.
    pub inward: bool,
    /// Number of the material.
    pub material: u32,
}

/// An axis-aligned box, closed: flat and point boxes are boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The smallest box around some points; `None` if there are none.
    pub(crate) fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points.into_iter().fold(None, |bounds, point| {
            Some(match bounds {
                None => Self { min: point, max: point },
                Some(Self { min, max }) => Self { min: min.min(point), max: max.max(point) },
            })
        })
    }

    /// Length of the diagonal.
    pub(crate) fn diagonal(&self) -> f64 {
        (self.max - self.min).length()
    }
}
