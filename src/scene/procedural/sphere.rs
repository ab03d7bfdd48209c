//! Spheres of triangles.

use crate::scene::Mesh;
use glam::DVec3;
use std::collections::HashMap;

/// How far the bumps of [`bumpy_sphere`] rise and sink.
const BUMP_HEIGHT: f64 = 0.1;

/// A unit sphere around the origin made of 20 · 4ˢ triangles: an icosahedron, each triangle of
/// which has been divided into four s times.
pub(crate) fn icosphere(subdivisions: u32) -> Mesh {
    (0..subdivisions).fold(icosahedron(), |mesh, _| subdivided(&mesh))
}

/// A closed sphere with bumps, 20 · 4ˢ triangles: radius 1 + 0.1 sin(7θ) cos(5φ), θ from the y
/// axis. No two triangles alike, and concave enough for rays to meet it several times.
pub(crate) fn bumpy_sphere(subdivisions: u32) -> Mesh {
    let mut mesh = icosphere(subdivisions);
    for position in &mut mesh.positions {
        let theta = position.y.clamp(-1.0, 1.0).acos();
        let phi = position.z.atan2(position.x);
        *position *= 1.0 + BUMP_HEIGHT * (7.0 * theta).sin() * (5.0 * phi).cos();
    }
    mesh
}

/// The twelve vertices are the corners of three golden rectangles.
fn icosahedron() -> Mesh {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let rectangle = [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)];
    let in_xy = rectangle.map(|(a, b)| DVec3::new(a, b, 0.0));
    let in_yz = rectangle.map(|(a, b)| DVec3::new(0.0, a, b));
    let in_zx = rectangle.map(|(a, b)| DVec3::new(b, 0.0, a));
    let positions = [in_xy, in_yz, in_zx].concat();
    #[rustfmt::skip]
    let indices = vec![
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4],
        [11, 10, 2], [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9],
        [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
    ];
    Mesh {
        positions: positions.into_iter().map(DVec3::normalize).collect(),
        indices,
        ..Mesh::default()
    }
}

/// Each triangle of a sphere cut at the middles of its edges.
fn subdivided(mesh: &Mesh) -> Mesh {
    let mut positions = mesh.positions.clone();
    let mut middles = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            positions.push((positions[a as usize] + positions[b as usize]).normalize());
            (positions.len() - 1) as u32
        })
    };
    let mut indices = Vec::with_capacity(4 * mesh.indices.len());
    for &[a, b, c] in &mesh.indices {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        indices.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Mesh { positions, indices, ..Mesh::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// Whether every edge is walked once in each direction: closed, and all fronts on one side.
    fn is_closed(mesh: &Mesh) -> bool {
        let edges = mesh.indices.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let walked: HashSet<_> = edges.collect();
        walked.len() == 3 * mesh.indices.len()
            && walked.iter().all(|&(a, b)| walked.contains(&(b, a)))
    }

    #[test]
    fn an_icosphere_is_closed_and_looks_out() {
        for subdivisions in 0..4 {
            let mesh = icosphere(subdivisions);
            assert_eq!(mesh.indices.len(), 20 << (2 * subdivisions));
            assert!(is_closed(&mesh));
            for triangle in 0..mesh.indices.len() {
                assert!(mesh.corner_normals(triangle)[0].dot(mesh.corners(triangle)[0]) > 0.7);
            }
        }
    }

    #[test]
    fn the_area_of_an_icosphere_approaches_that_of_the_sphere() {
        let area = |mesh: Mesh| (0..mesh.indices.len()).map(|t| mesh.area(t)).sum::<f64>();
        let missing = |s| 4.0 * std::f64::consts::PI - area(icosphere(s));
        assert!((missing(3) / missing(4) - 4.0).abs() < 0.05, "second order");
    }

    #[test]
    fn a_bumpy_sphere_is_closed_and_stays_within_its_bumps() {
        let mesh = bumpy_sphere(4);
        assert!(is_closed(&mesh));
        let radii = mesh.positions.iter().map(|position| position.length());
        let (low, high) = radii.fold((2.0f64, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
        assert!((0.9..0.91).contains(&low) && (1.09..=1.1).contains(&high), "{low} {high}");
    }
}
