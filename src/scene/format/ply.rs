//! The Stanford format.

use crate::scene::Mesh;
use crate::scene::error::MeshError;
use glam::DVec3;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use std::fs::File;
use std::path::Path;

/// The mesh in a file, polygons cut into fans, vertex normals if the file has them.
pub(crate) fn read(path: &Path) -> Result<Mesh, MeshError> {
    let ply = Parser::<DefaultElement>::new()
        .read_ply(&mut File::open(path)?)
        .map_err(|problem| malformed(&problem))?;
    let elements = |name: &'static str| {
        ply.payload.get(name).ok_or_else(|| malformed(&format!("it has no `{name}`")))
    };
    let vertices = elements("vertex")?;
    let has_normals = vertices.first().is_some_and(|vertex| vertex.contains_key("nx"));
    let mut mesh = Mesh::default();
    for vertex in vertices {
        mesh.positions.push(vector(vertex, ["x", "y", "z"])?);
        if has_normals {
            mesh.normals.push(vector(vertex, ["nx", "ny", "nz"])?);
        }
    }
    for face in elements("face")? {
        let corners = corners(face)?;
        let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
        mesh.indices.extend(fan);
    }
    Ok(mesh)
}

fn vector(element: &DefaultElement, names: [&str; 3]) -> Result<DVec3, MeshError> {
    let number = |name: &str| match element.get(name) {
        Some(Property::Double(number)) => Some(*number),
        Some(property) => property.to_f32_lossy().map(f64::from),
        None => None,
    };
    let missing = |name| malformed(&format!("a vertex has no property `{name}`"));
    let mut vector = DVec3::ZERO;
    for (axis, name) in names.into_iter().enumerate() {
        vector[axis] = number(name).ok_or_else(|| missing(name))?;
    }
    Ok(vector)
}

fn corners(face: &DefaultElement) -> Result<Vec<u32>, MeshError> {
    let list = face.get("vertex_indices").or_else(|| face.get("vertex_index"));
    list.and_then(Property::to_u32_list)
        .ok_or_else(|| malformed(&"a face has no valid list `vertex_indices`"))
}

fn malformed(problem: &dyn std::fmt::Display) -> MeshError {
    MeshError::malformed("PLY", problem)
}

/// A binary file of single precision, which Mitsuba computes in anyway.
pub(crate) fn written(mesh: &Mesh) -> Vec<u8> {
    let normals = match mesh.normals.is_empty() {
        true => "",
        false => "property float nx\nproperty float ny\nproperty float nz\n",
    };
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\n{normals}element face {}\n\
         property list uchar uint vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.indices.len()
    )
    .into_bytes();
    let mut put = |vector: DVec3| {
        file.extend(vector.as_vec3().to_array().iter().flat_map(|number| number.to_le_bytes()));
    };
    for (vertex, position) in mesh.positions.iter().enumerate() {
        put(*position);
        if let Some(normal) = mesh.normals.get(vertex) {
            put(*normal);
        }
    }
    for triangle in &mesh.indices {
        file.push(3);
        file.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    file
}
