//! Materials in the CGL profile.

use crate::scene::format::xml::XmlWriter;
use crate::scene::format::{Complaint, ExportError, numbers};
use crate::scene::{Material, SceneDescription, Surface};

/// Writes effects and materials, and returns the ids of the materials.
pub(super) fn write_all(
    xml: &mut XmlWriter,
    scene: &SceneDescription,
    complaint: Complaint<'_>,
) -> Result<Vec<String>, ExportError> {
    let ids: Vec<_> = (0..scene.materials.len()).map(|n| format!("material-{n}")).collect();
    xml.open("library_effects", &[]);
    for (id, material) in ids.iter().zip(&scene.materials) {
        xml.open("effect", &[("id", &format!("{id}-effect"))]);
        write_effect(xml, material, complaint)?;
        xml.close();
    }
    xml.close();
    xml.open("library_materials", &[]);
    for id in &ids {
        xml.open("material", &[("id", id), ("name", id)]);
        xml.leaf("instance_effect", &[("url", &format!("#{id}-effect"))]);
        xml.close();
    }
    xml.close();
    Ok(ids)
}

fn write_effect(
    xml: &mut XmlWriter,
    material: &Material,
    complaint: Complaint<'_>,
) -> Result<(), ExportError> {
    let name = &material.name;
    if let Some(emission) = material.emission {
        if emission.cap.is_some() {
            return Err(complaint.about(format!("material `{name}` emits on a part of a sphere")));
        }
        if material.surface != (Surface::Diffuse { reflectance: [0.0; 3] }) {
            let what =
                format!("material `{name}` emits and reflects; in the course it can only do one");
            return Err(complaint.about(what));
        }
        profile(xml, "emission", &[("radiance", numbers(emission.radiance))]);
        return Ok(());
    }
    match material.surface {
        Surface::Diffuse { reflectance } => {
            xml.open("profile_COMMON", &[]);
            xml.open("technique", &[("sid", "common")]);
            xml.open("phong", &[]);
            xml.open("diffuse", &[]);
            xml.text("color", &[], &format!("{} 1", numbers(reflectance)));
            (0..4).for_each(|_| xml.close());
        }
        Surface::Mirror { reflectance } => {
            profile(xml, "mirror", &[("reflectance", numbers(reflectance))]);
        }
        Surface::Glass { index, reflectance, transmittance } => {
            let values = [
                ("transmittance", numbers(transmittance)),
                ("reflectance", numbers(reflectance)),
                ("roughness", numbers([0.0])),
                ("ior", numbers([index])),
            ];
            profile(xml, "glass", &values);
        }
        Surface::Conductor { .. } => {
            return Err(complaint.about(format!(
                "material `{name}` is a rough conductor of constant reflectance; the course's has a Fresnel term"
            )));
        }
        Surface::RoughGlass { .. } => {
            return Err(complaint
                .about(format!("material `{name}` is rough glass; the course's is smooth")));
        }
    }
    Ok(())
}

fn profile(xml: &mut XmlWriter, material: &'static str, values: &[(&str, String)]) {
    xml.open("extra", &[]);
    xml.open("technique", &[("profile", "CGL")]);
    xml.open(material, &[]);
    for (name, value) in values {
        xml.text(name, &[], value);
    }
    (0..3).for_each(|_| xml.close());
}
