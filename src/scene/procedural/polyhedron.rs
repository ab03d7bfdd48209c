//! Parallelograms and blocks.

use super::builder::Builder;
use crate::scene::Mesh;
use glam::DVec3;

/// The parallelogram with a corner and the two edges that leave it; its front is the side that
/// `edges[0] × edges[1]` points to.
pub(crate) fn parallelogram(corner: DVec3, edges: [DVec3; 2]) -> Mesh {
    let [u, v] = edges;
    Mesh {
        positions: vec![corner, corner + u, corner + u + v, corner + v],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// The block between two opposite corners, twelve triangles. Fronts look out, or in if `inward`.
pub(crate) fn block(min: DVec3, max: DVec3, inward: bool) -> Mesh {
    let mut builder = Builder::default();
    for axis in 0..3 {
        for upper in [false, true] {
            let mut face = block_face(min, max, axis, upper);
            if inward == upper {
                face.reverse();
            }
            builder.quadrilateral(face);
        }
    }
    builder.finish()
}

/// The face at the lower or upper end of `axis`, counter-clockwise seen from the upper side.
fn block_face(min: DVec3, max: DVec3, axis: usize, upper: bool) -> [DVec3; 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let end = if upper { max } else { min };
    [[min, min], [max, min], [max, max], [min, max]].map(|[at_u, at_v]| {
        let mut corner = DVec3::ZERO;
        corner[axis] = end[axis];
        corner[u] = at_u[u];
        corner[v] = at_v[v];
        corner
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume enclosed by a closed mesh, positive if its fronts look out (divergence theorem).
    fn volume(mesh: &Mesh) -> f64 {
        let corners = (0..mesh.indices.len()).map(|triangle| mesh.corners(triangle));
        corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    #[test]
    fn a_block_is_closed_and_looks_the_way_it_is_told() {
        let (min, max) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 4.0, 6.0));
        let outward = block(min, max, false);
        assert_eq!((outward.positions.len(), outward.indices.len()), (8, 12));
        assert!((volume(&outward) - 6.0).abs() < 1e-12);
        assert!((volume(&block(min, max, true)) + 6.0).abs() < 1e-12);
    }

    #[test]
    fn the_front_of_a_parallelogram_follows_the_right_hand() {
        let mesh = parallelogram(DVec3::ONE, [DVec3::X, DVec3::Y]);
        for triangle in 0..2 {
            assert_eq!(mesh.corner_normals(triangle)[0], DVec3::Z);
            assert_eq!(mesh.area(triangle), 0.5);
        }
    }
}
