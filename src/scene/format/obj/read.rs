//! All parts of a file as one mesh.

use crate::scene::Mesh;
use crate::scene::error::MeshError;
use glam::DVec3;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The mesh in a file, polygons cut into fans, vertex normals if the file has them.
pub(crate) fn read(path: &Path) -> Result<Mesh, MeshError> {
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
    let without_materials = |_: &Path| Ok(Default::default());
    check_references(&std::fs::read(path)?)?;
    let mut reader = BufReader::new(File::open(path)?);
    let (models, _) = tobj::load_obj_buf(&mut reader, &options, without_materials)
        .map_err(|problem| malformed(&problem))?;
    let mut mesh = Mesh::default();
    for model in models {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(points(&model.mesh.positions));
        mesh.normals.extend(points(&model.mesh.normals));
        let (triangles, _) = model.mesh.indices.as_chunks::<3>();
        mesh.indices.extend(triangles.iter().map(|corners| corners.map(|i| first + i)));
    }
    Ok(mesh)
}

/// That the faces of an OBJ file name vertices and normals that it has: tobj 4.0.5 counts back beyond the
/// first normal, and overflows or takes another one.
fn check_references(bytes: &[u8]) -> Result<(), MeshError> {
    const LISTS: [(&str, &str); 3] =
        [("v", "vertex"), ("vt", "texture coordinate"), ("vn", "normal")];
    let text = String::from_utf8_lossy(bytes);
    let words = || text.lines().map(str::split_whitespace);
    let total =
        LISTS.map(|(key, _)| words().filter(|words| words.clone().next() == Some(key)).count());
    let mut so_far = [0; 3];
    for (line, mut words) in words().enumerate() {
        let key = words.next().unwrap_or_default();
        if let Some(list) = LISTS.iter().position(|(word, _)| *word == key) {
            so_far[list] += 1;
        }
        if !["f", "l", "p"].contains(&key) {
            continue;
        }
        let named = words.flat_map(|corner| corner.split('/').zip(0..LISTS.len()));
        for (word, list) in named {
            // What is not a number is told by tobj, and what no list has is not looked up.
            let Ok(index) = word.parse::<i64>() else { continue };
            let known = if index > 0 { total[list] } else { so_far[list] };
            if total[list] > 0 && index.unsigned_abs() > known as u64 {
                let name = LISTS[list].1;
                let what = format!("line {} names {name} {index}, and there are {known}", line + 1);
                return Err(malformed(&what));
            }
        }
    }
    Ok(())
}

fn points(coordinates: &[f32]) -> impl Iterator<Item = DVec3> {
    let (points, _) = coordinates.as_chunks::<3>();
    points.iter().map(|point| DVec3::from_array(point.map(f64::from)))
}

fn malformed(problem: &dyn std::fmt::Display) -> MeshError {
    MeshError::malformed("OBJ", problem)
}
