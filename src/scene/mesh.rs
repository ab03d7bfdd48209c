//! Meshes from files, through libraries, and checked: what comes out of here can be handed to any core.
//!
//! Not here: where a mesh stands in the scene, and what it is made of.

use super::Mesh;
pub(crate) use super::error::MeshError;
use super::format::{obj, ply, stl};
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;

/// The file formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront.
    Obj,
    /// Stanford.
    Ply,
    /// Stereolithography.
    Stl,
}

/// Which normals a mesh shades with, where a scene file says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Shading {
    Flat,
    /// Those of the vertices: the mean over the triangles around each.
    Smooth,
}

impl Shading {
    pub(crate) fn apply(self, mesh: &mut Mesh) {
        mesh.normals = match self {
            Self::Flat => Vec::new(),
            Self::Smooth => smooth_normals(mesh),
        };
    }
}

/// The mesh in a file: all its parts as one, polygons cut into fans, vertex normals if the file has them.
pub fn load(path: &Path, format: Format) -> Result<Mesh, MeshError> {
    let mut mesh = match format {
        Format::Obj => obj::read(path),
        Format::Ply => ply::read(path),
        Format::Stl => stl::read(path),
    }?;
    check(&mesh)?;
    mesh.normals.iter_mut().for_each(|normal| *normal = normal.normalize());
    Ok(mesh)
}

/// That every index names a vertex, every number is finite, and every normal has a direction.
pub(crate) fn check(mesh: &Mesh) -> Result<(), MeshError> {
    let vertices = mesh.positions.len();
    for (triangle, corners) in mesh.indices.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|index| **index as usize >= vertices) {
            return Err(MeshError::NoSuchVertex { triangle, index, vertices });
        }
    }
    if let Some(vertex) = mesh.positions.iter().position(|position| !position.is_finite()) {
        return Err(MeshError::NotFinite(vertex));
    }
    if !mesh.normals.is_empty() && mesh.normals.len() != vertices {
        return Err(MeshError::NormalCount { normals: mesh.normals.len(), vertices });
    }
    if let Some(vertex) = mesh.normals.iter().position(|normal| normal.try_normalize().is_none()) {
        return Err(MeshError::NoDirection(vertex));
    }
    if mesh.indices.is_empty() { Err(MeshError::Empty) } else { Ok(()) }
}

/// One unit normal a vertex: the mean over the triangles around it, each weighted by its angle
/// there, so that the normal does not depend on how a polygon was cut (Thürmer and Wüthrich 1998).
pub(crate) fn smooth_normals(mesh: &Mesh) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; mesh.positions.len()];
    for (triangle, indices) in mesh.indices.iter().enumerate() {
        let corners = mesh.corners(triangle);
        let [a, b, c] = corners;
        let face_normal = (b - a).cross(c - a).normalize_or_zero();
        for (corner, &index) in indices.iter().enumerate() {
            let here = corners[corner];
            let angle =
                (corners[(corner + 1) % 3] - here).angle_between(corners[(corner + 2) % 3] - here);
            if angle.is_finite() {
                normals[index as usize] += angle * face_normal;
            }
        }
    }
    // A vertex without triangles, or between two that face each other, is never shaded by its own normal.
    normals.into_iter().map(|normal| normal.normalize_or(DVec3::Y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural::{block, icosphere};

    fn written(text: &str) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    fn loaded(text: &str, format: Format) -> Result<Mesh, String> {
        load(written(text).path(), format).map_err(|error| error.to_string())
    }

    #[test]
    fn an_obj_keeps_its_polygons_its_parts_and_its_normals() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 2\no a\nf 1//1 2//1 3//1 4//1\n\
                    o b\nf 1//1 2//1 3//1\n";
        let mesh = loaded(text, Format::Obj).unwrap();
        assert_eq!(mesh.indices.len(), 3);
        assert_eq!(mesh.normals.len(), mesh.positions.len());
        assert!(mesh.normals.iter().all(|normal| *normal == DVec3::Z), "made unit length");
    }

    /// A PLY file of vertices with coordinates of `kind` and one face.
    fn ply(kind: &str, vertices: &[&str], face: &str) -> String {
        let axes = ["x", "y", "z"].map(|axis| format!("property {kind} {axis}\n")).concat();
        format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n{axes}element face 1\n\
             property list uchar int vertex_indices\nend_header\n{}\n{face}\n",
            vertices.len(),
            vertices.join("\n")
        )
    }

    #[test]
    fn a_ply_keeps_its_doubles() {
        let text = ply("double", &["0.1 0 0", "1 0 0", "1 1 0", "0 1 0"], "4 0 1 2 3");
        let mesh = loaded(&text, Format::Ply).unwrap();
        assert_eq!(mesh.positions[0].x, 0.1);
        assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
        assert!(mesh.normals.is_empty());
    }

    #[test]
    fn an_stl_shares_its_vertices() {
        let facet = |corners: [&str; 3]| {
            let vertices = corners.map(|corner| format!("vertex {corner}\n")).concat();
            format!("facet normal 0 0 1\nouter loop\n{vertices}endloop\nendfacet\n")
        };
        let facets = facet(["0 0 0", "1 0 0", "1 1 0"]) + &facet(["0 0 0", "1 1 0", "0 1 0"]);
        let mesh = loaded(&format!("solid s\n{facets}endsolid s\n"), Format::Stl).unwrap();
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (4, 2));
    }

    #[test]
    fn what_is_wrong_with_a_file_is_named() {
        // Counted back from the last normal; a list that is not there is not looked into.
        let corners = |face| format!("v 0 0 0\nv 1 0 0\nvn 0 0 1\nv 1 1 0\nf {face}\n");
        assert!(loaded(&corners("1/5/-1 2/5/-1 -1/5/1"), Format::Obj).is_ok());
        for (text, format, words) in [
            (
                &*ply("float", &["0 0 0", "1 0 0", "1 1 0"], "3 0 1 7"),
                Format::Ply,
                "triangle 0 refers to vertex 7, but there are only 3 vertices",
            ),
            (
                "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n",
                Format::Obj,
                "line 4 names vertex 9, and there are 3",
            ),
            (&corners("1//1 2//1 3//-9"), Format::Obj, "line 5 names normal -9, and there are 1"),
            ("v 0 0 nan\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", Format::Obj, "vertex 0"),
            ("v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\n", Format::Obj, "is zero"),
            ("", Format::Obj, "has no triangles"),
            ("ply\nrubbish\n", Format::Ply, "PLY"),
            ("solid?", Format::Stl, "STL"),
        ] {
            let message = loaded(text, format).unwrap_err();
            assert!(message.contains(words), "{words}: {message}");
        }
        let missing = load(Path::new("no/such.obj"), Format::Obj).unwrap_err();
        assert!(matches!(missing, MeshError::Unreadable(_)));
    }

    #[test]
    fn smooth_normals_of_a_sphere_point_along_its_radii() {
        let sphere = icosphere(3);
        for (normal, position) in smooth_normals(&sphere).iter().zip(&sphere.positions) {
            assert!(normal.dot(*position) > 0.999);
        }
    }

    #[test]
    fn smooth_normals_do_not_depend_on_how_a_square_was_cut() {
        let cube = block(-DVec3::ONE, DVec3::ONE, false);
        for (normal, corner) in smooth_normals(&cube).iter().zip(&cube.positions) {
            assert!(normal.abs_diff_eq(corner.normalize(), 1e-15), "{normal} at {corner}");
        }
    }
}
