//! What a `material` is made of: the CGL profile if there is one, else the diffuse colour that every COLLADA file has.

use super::xml::{Element, Reader, Result};
use crate::scene::{Emission, Material, Rgb, Surface};

/// What surfaces without material are made of.
pub(super) fn default_material() -> Material {
    Material { name: "default".to_owned(), surface: grey(), emission: None }
}

fn grey() -> Surface {
    Surface::Diffuse { reflectance: [0.5; 3] }
}

/// How a surface scatters and emits, without its name.
type Look = (Surface, Option<Emission>);

pub(super) fn read<'a>(reader: &Reader<'a>, material: Element<'a>) -> Result<Material> {
    let name = reader.name_of(material)?.to_owned();
    let effect = reader.need(material, "instance_effect")?;
    let (surface, emission) = match reader.technique(effect, "CGL") {
        Some(technique) => from_profile(reader, technique)?,
        None => (Surface::Diffuse { reflectance: common_diffuse(reader, effect)? }, None),
    };
    Ok(Material { name, surface, emission })
}

/// Of several materials in one profile the last one counts.
fn from_profile<'a>(reader: &Reader<'a>, technique: Element<'a>) -> Result<Look> {
    let mut look = None;
    for element in technique.children().filter(Element::is_element) {
        if let Some(read) = from_element(reader, element)? {
            look = Some(read);
        }
    }
    look.ok_or_else(|| {
        let message = "the CGL profile names no material, so that the course's program crashes";
        reader
            .wrong(technique, message)
            .with_hint("write `emission`, `mirror` or `glass`, or leave the profile out")
    })
}

fn from_element<'a>(reader: &Reader<'a>, element: Element<'a>) -> Result<Option<Look>> {
    let colour = |name| reader.colour(reader.need(element, name)?);
    let surface = match element.tag_name().name() {
        "emission" => {
            let emission = Emission { radiance: colour("radiance")?, cap: None };
            return Ok(Some((Surface::Diffuse { reflectance: [0.0; 3] }, Some(emission))));
        }
        "mirror" => Surface::Mirror { reflectance: colour("reflectance")? },
        "glass" => Surface::Glass {
            index: index(reader, element)?,
            reflectance: colour("reflectance")?,
            transmittance: colour("transmittance")?,
        },
        "microfacet" => return Err(no_counterpart(reader, element, "a Fresnel term of its own")),
        "refraction" => return Err(no_counterpart(reader, element, "no reflection at all")),
        _ => return Ok(None),
    };
    Ok(Some((surface, None)))
}

fn no_counterpart<'a>(
    reader: &Reader<'a>,
    element: Element<'a>,
    because: &str,
) -> crate::text::Diagnostic {
    let name = element.tag_name().name();
    reader
        .wrong(element, format!("`{name}` has no counterpart in `furnace`: it has {because}"))
        .with_hint("use `mirror` or `glass`, or a diffuse material")
}

/// Read in single precision, as the course does.
fn index<'a>(reader: &Reader<'a>, glass: Element<'a>) -> Result<f64> {
    let element = reader.need(glass, "ior")?;
    let index = reader.narrowed(element)?;
    if index > 0.0 {
        Ok(f64::from(index))
    } else {
        Err(reader.wrong(element, "invalid index of refraction: must be positive"))
    }
}

fn common_diffuse<'a>(reader: &Reader<'a>, effect: Element<'a>) -> Result<Rgb> {
    let Some(technique) = reader.common_technique(effect) else { return Ok([0.5; 3]) };
    for path in ["phong/diffuse/color", "lambert/diffuse/color"] {
        if let Some(colour) = reader.find(technique, path)? {
            return reader.colour(colour);
        }
    }
    Ok([0.5; 3])
}
