//! Shapes with their materials and emission.

use super::xml::Xml;
use super::{Attachment, MitsubaError};
use crate::scene::{Material, Mesh, Rectangle, Rgb, SceneDescription, Sphere, Surface};
use glam::{DAffine3, DMat3, DVec3};

/// Writes every shape, and returns the meshes that got a file of their own.
pub(super) fn write_all(
    xml: &mut Xml,
    scene: &SceneDescription,
) -> Result<Vec<(String, Attachment)>, MitsubaError> {
    let mut attachments = Vec::new();
    for (number, mesh) in scene.meshes.iter().enumerate() {
        match mesh.as_rectangle() {
            Some(rectangle) => {
                xml.open("shape", &[("type", "rectangle"), ("id", &mesh.name)]);
                xml.transform(to_world(rectangle));
            }
            None => {
                let file = format!("mesh-{number}.ply");
                xml.open("shape", &[("type", "ply"), ("id", &mesh.name)]);
                xml.string("filename", &file);
                xml.boolean("face_normals", mesh.normals.is_empty());
                attachments.push((file, Attachment::Mesh(ply(mesh))));
            }
        }
        write_material(xml, &mesh.name, &scene.materials[mesh.material as usize])?;
        xml.close();
    }
    for sphere in &scene.spheres {
        write_sphere(xml, sphere);
        write_material(xml, &sphere.name, &scene.materials[sphere.material as usize])?;
        xml.close();
    }
    Ok(attachments)
}

fn write_sphere(xml: &mut Xml, sphere: &Sphere) {
    xml.open("shape", &[("type", "sphere"), ("id", &sphere.name)]);
    xml.point("center", sphere.centre);
    xml.float("radius", sphere.radius);
    xml.boolean("flip_normals", sphere.inward);
}

/// What takes Mitsuba's rectangle, [−1, 1]² with its front along +z, to a mesh that is one. It is
/// sampled with less noise than two triangles are.
fn to_world(rectangle: Rectangle) -> DAffine3 {
    let [u, v] = rectangle.sides;
    DAffine3 {
        matrix3: DMat3::from_cols(u / 2.0, v / 2.0, rectangle.normal),
        translation: rectangle.centre,
    }
}

/// A binary PLY file; Mitsuba computes in single precision anyway.
fn ply(mesh: &Mesh) -> Vec<u8> {
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

fn write_material(xml: &mut Xml, shape: &str, material: &Material) -> Result<(), MitsubaError> {
    match material.surface {
        Surface::Glass { .. } | Surface::RoughGlass { .. } => write_surface(xml, &material.surface),
        _ => {
            xml.open("bsdf", &[("type", "twosided")]);
            write_surface(xml, &material.surface);
            xml.close();
        }
    }
    let Some(emission) = material.emission else { return Ok(()) };
    if emission.cap.is_some() {
        return Err(MitsubaError::Cap(shape.to_owned()));
    }
    xml.open("emitter", &[("type", "area")]);
    xml.rgb("radiance", emission.radiance);
    xml.close();
    Ok(())
}

fn write_surface(xml: &mut Xml, surface: &Surface) {
    match *surface {
        Surface::Diffuse { reflectance } => {
            xml.open("bsdf", &[("type", "diffuse")]);
            xml.rgb("reflectance", reflectance);
        }
        Surface::Mirror { reflectance } => {
            xml.open("bsdf", &[("type", "conductor")]);
            xml.string("material", "none");
            xml.rgb("specular_reflectance", reflectance);
        }
        Surface::Glass { index, reflectance, transmittance } => {
            xml.open("bsdf", &[("type", "dielectric")]);
            write_interface(xml, index, [reflectance, transmittance]);
        }
        Surface::Conductor { reflectance, roughness } => {
            xml.open("bsdf", &[("type", "roughconductor")]);
            xml.string("material", "none");
            xml.string("distribution", "ggx");
            xml.float("alpha", roughness);
            xml.rgb("specular_reflectance", reflectance);
        }
        Surface::RoughGlass { index, roughness, reflectance, transmittance } => {
            xml.open("bsdf", &[("type", "roughdielectric")]);
            xml.string("distribution", "ggx");
            xml.float("alpha", roughness);
            write_interface(xml, index, [reflectance, transmittance]);
        }
    }
    xml.close();
}

fn write_interface(xml: &mut Xml, index: f64, [reflectance, transmittance]: [Rgb; 2]) {
    xml.float("int_ior", index);
    xml.float("ext_ior", 1.0);
    xml.rgb("specular_reflectance", reflectance);
    xml.rgb("specular_transmittance", transmittance);
}
