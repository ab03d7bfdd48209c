//! Collects triangles and shares the vertices that lie on the same point.

use crate::scene::Mesh;
use glam::DVec3;
use std::collections::HashMap;

#[derive(Default)]
pub(super) struct Builder {
    mesh: Mesh,
    vertices: HashMap<[u64; 3], u32>,
}

impl Builder {
    /// Adds a triangle unless two of its corners coincide, as they do at the poles of a patch.
    pub(crate) fn triangle(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners.map(|corner| self.vertex(corner));
        if a != b && b != c && c != a {
            self.mesh.indices.push([a, b, c]);
        }
    }

    /// Adds a quadrilateral as two triangles.
    pub(crate) fn quadrilateral(&mut self, [a, b, c, d]: [DVec3; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }

    pub(crate) fn finish(self) -> Mesh {
        self.mesh
    }

    /// The number of the vertex at `point`. Points are the same if their bits are, −0 being 0: whoever wants a closed
    /// surface computes the points of a seam in the same way from both sides.
    fn vertex(&mut self, point: DVec3) -> u32 {
        let key = (point + DVec3::ZERO).to_array().map(f64::to_bits);
        let positions = &mut self.mesh.positions;
        *self.vertices.entry(key).or_insert_with(|| {
            positions.push(point);
            (positions.len() - 1) as u32
        })
    }
}
