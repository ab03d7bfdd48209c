//! Shapes with their materials and emission.

use crate::scene::format::xml::XmlWriter;
use crate::scene::format::{Complaint, Content, ExportError, ply};
use crate::scene::{Material, Rectangle, Rgb, Sphere, Surface};
use glam::{DAffine3, DMat3};

/// Writes every shape, and returns the meshes that got a file of their own.
pub(super) fn write_all(
    xml: &mut XmlWriter,
    complaint: Complaint<'_>,
) -> Result<Vec<(String, Content)>, ExportError> {
    let scene = complaint.scene;
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
                attachments.push((file, Content::Bytes(ply::written(mesh))));
            }
        }
        write_material(xml, &mesh.name, &scene.materials[mesh.material as usize], complaint)?;
        xml.close();
    }
    for sphere in &scene.spheres {
        write_sphere(xml, sphere);
        write_material(xml, &sphere.name, &scene.materials[sphere.material as usize], complaint)?;
        xml.close();
    }
    Ok(attachments)
}

fn write_sphere(xml: &mut XmlWriter, sphere: &Sphere) {
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

fn write_material(
    xml: &mut XmlWriter,
    shape: &str,
    material: &Material,
    complaint: Complaint<'_>,
) -> Result<(), ExportError> {
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
        return Err(complaint.about(format!(
            "`{shape}` emits on a cap only: Mitsuba has no such light; its closed form is its reference"
        )));
    }
    xml.open("emitter", &[("type", "area")]);
    xml.rgb("radiance", emission.radiance);
    xml.close();
    Ok(())
}

fn write_surface(xml: &mut XmlWriter, surface: &Surface) {
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

fn write_interface(xml: &mut XmlWriter, index: f64, [reflectance, transmittance]: [Rgb; 2]) {
    xml.float("int_ior", index);
    xml.float("ext_ior", 1.0);
    xml.rgb("specular_reflectance", reflectance);
    xml.rgb("specular_transmittance", transmittance);
}
