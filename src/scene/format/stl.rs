//! Stereolithography: triangles alone.

use crate::scene::Mesh;
use crate::scene::error::MeshError;
use glam::DVec3;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The mesh in a file, vertices at the same place being one.
pub(crate) fn read(path: &Path) -> Result<Mesh, MeshError> {
    let mut reader = BufReader::new(File::open(path)?);
    let stl = stl_io::read_stl(&mut reader).map_err(|problem| malformed(&problem))?;
    let index =
        |vertex: usize| u32::try_from(vertex).map_err(|_| malformed(&"more vertices than 2³²"));
    let triangle = |face: &stl_io::IndexedTriangle| {
        let [a, b, c] = face.vertices;
        Ok([index(a)?, index(b)?, index(c)?])
    };
    Ok(Mesh {
        positions: stl.vertices.iter().map(|v| DVec3::from_array(v.0.map(f64::from))).collect(),
        indices: stl.faces.iter().map(triangle).collect::<Result<_, MeshError>>()?,
        ..Mesh::default()
    })
}

fn malformed(problem: &dyn std::fmt::Display) -> MeshError {
    MeshError::malformed("STL", problem)
}
