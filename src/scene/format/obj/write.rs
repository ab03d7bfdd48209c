//! Every triangle, with its normals and what it is made of. Nothing else has a place there.

use crate::scene::format::{Complaint, ExportError, Exported, Format, numbers};
use crate::scene::{Light, Material, Mesh, SceneDescription, Surface};
use std::fmt::Write;

/// `scene.obj` and `scene.mtl`. The camera is not in them.
pub(crate) fn export(scene: &SceneDescription) -> Result<Exported, ExportError> {
    let complaint = Complaint { format: Format::Obj, scene };
    if let Some(sphere) = scene.spheres.first() {
        let what = format!("`{}` is a sphere, and OBJ has only triangles", sphere.name);
        return Err(complaint.about(what));
    }
    if scene.lights.iter().any(|light| !matches!(light, Light::Area { .. })) {
        return Err(complaint.about("OBJ has no lights but emissive surfaces"));
    }
    let mut library = String::new();
    for (number, material) in scene.materials.iter().enumerate() {
        write_material(&mut library, number, material, complaint)?;
    }
    let mut text = "mtllib scene.mtl\n".to_owned();
    // Vertices and normals are counted from 1 through the whole file.
    let [mut positions, mut normals] = [1, 1];
    for (number, mesh) in scene.meshes.iter().enumerate() {
        let first = [positions, normals];
        let _ = writeln!(text, "o mesh-{number}\nusemtl material-{}", mesh.material);
        write_mesh(&mut text, mesh, first);
        positions += mesh.positions.len();
        normals += mesh.normals.len();
    }
    Ok(Exported::of_texts([("scene.obj", text), ("scene.mtl", library)]))
}

fn write_mesh(text: &mut String, mesh: &Mesh, [position, normal]: [usize; 2]) {
    for vertex in &mesh.positions {
        let _ = writeln!(text, "v {}", numbers(vertex.to_array()));
    }
    for vertex in &mesh.normals {
        let _ = writeln!(text, "vn {}", numbers(vertex.to_array()));
    }
    for corners in &mesh.indices {
        let corners = corners.map(|index| match mesh.normals.is_empty() {
            true => (position + index as usize).to_string(),
            false => format!("{}//{}", position + index as usize, normal + index as usize),
        });
        let _ = writeln!(text, "f {}", corners.join(" "));
    }
}

fn write_material(
    text: &mut String,
    number: usize,
    material: &Material,
    complaint: Complaint<'_>,
) -> Result<(), ExportError> {
    let _ = writeln!(text, "newmtl material-{number}");
    match material.surface {
        Surface::Diffuse { reflectance } => {
            let _ = writeln!(text, "illum 1\nKd {}", numbers(reflectance));
        }
        Surface::Mirror { reflectance } => {
            let _ = writeln!(text, "illum 3\nKd 0 0 0\nKs {}", numbers(reflectance));
        }
        Surface::Glass { index, reflectance, transmittance } => {
            let [reflectance, transmittance] = [reflectance, transmittance].map(numbers);
            let _ = writeln!(
                text,
                "illum 7\nKd 0 0 0\nKs {reflectance}\nTf {transmittance}\nNi {index}"
            );
        }
        Surface::Conductor { .. } | Surface::RoughGlass { .. } => {
            let what = if matches!(material.surface, Surface::Conductor { .. }) {
                "rough metal"
            } else {
                "rough glass"
            };
            let name = &material.name;
            return Err(
                complaint.about(format!("material `{name}` is {what}, which MTL does not define"))
            );
        }
    }
    if let Some(emission) = material.emission {
        let _ = writeln!(text, "Ke {}", numbers(emission.radiance));
    }
    Ok(())
}
