//! The lights of the file, as the course declares them: apart from the surfaces that are seen to emit.

use super::xml::{Element, Instance, Reader, Result};
use crate::scene::Rgb;
use glam::{DMat4, DVec3, DVec4};

/// A light of the file, in world space.
pub(super) struct DeclaredLight {
    pub(super) name: String,
    /// Radiance of an area light; what a point light sends in every direction and, with the course's
    /// classes, to every distance; irradiance of a directional light.
    pub(super) colour: Rgb,
    pub(super) kind: Kind,
}

pub(super) enum Kind {
    /// A rectangle that shines towards `direction` (unit).
    Area {
        centre: DVec3,
        direction: DVec3,
        sides: [DVec3; 2],
    },
    Point {
        position: DVec3,
    },
    /// `direction`: the way the light travels, unit.
    Directional {
        direction: DVec3,
    },
    /// Half of a sky, above, that is not seen.
    Ambient,
    /// Parsed by the course, and then dark.
    Spot,
}

pub(super) fn read<'a>(reader: &Reader<'a>, instance: &Instance<'a>) -> Result<DeclaredLight> {
    let Instance { name, element: light, transform } = *instance;
    reader.name_of(light)?;
    let technique = reader
        .technique(light, "CGL")
        .or_else(|| reader.common_technique(light))
        .ok_or_else(|| reader.wrong(light, "has neither a CGL profile nor a common one"))?;
    let kind = technique.children().find(Element::is_element);
    let kind = kind.ok_or_else(|| reader.wrong(technique, "does not describe the light"))?;
    let colour = reader.colour(reader.need(kind, "color")?)?;
    Ok(DeclaredLight { name: name.to_owned(), colour, kind: read_kind(reader, kind, &transform)? })
}

fn read_kind<'a>(reader: &Reader<'a>, kind: Element<'a>, transform: &DMat4) -> Result<Kind> {
    let word = kind.tag_name().name();
    let light = match word {
        "area" => area(transform),
        "point" => {
            for name in ["constant_attenuation", "linear_attenuation", "quadratic_attenuation"] {
                reader.need(kind, name)?;
            }
            Kind::Point { position: point(transform, DVec3::ZERO) }
        }
        // The course takes the light's place into account: it transforms a point, not a direction.
        "directional" => Kind::Directional { direction: -unit(point(transform, -DVec3::Z)) },
        "spot" => Kind::Spot,
        "ambient" => Kind::Ambient,
        _ => return Err(reader.wrong(kind, format!("unknown light `{word}`: the course has none"))),
    };
    if light.is_finite() {
        Ok(light)
    } else {
        Err(reader.wrong(kind, "the matrix of its node gives the light no size or direction"))
    }
}

fn area(transform: &DMat4) -> Kind {
    let centre = point(transform, DVec3::ZERO);
    let away = |local| point(transform, local) - centre;
    Kind::Area {
        centre,
        direction: unit(away(-DVec3::Z)),
        sides: [away(-DVec3::X), away(DVec3::Y)],
    }
}

impl Kind {
    fn is_finite(&self) -> bool {
        match *self {
            Self::Area { centre, direction, sides } => {
                centre.is_finite() && direction.is_finite() && sides.iter().all(|s| s.is_finite())
            }
            Self::Point { position } => position.is_finite(),
            Self::Directional { direction } => direction.is_finite(),
            Self::Ambient | Self::Spot => true,
        }
    }
}

fn point(transform: &DMat4, local: DVec3) -> DVec3 {
    (*transform * DVec4::from((local, 1.0))).truncate()
}

fn unit(vector: DVec3) -> DVec3 {
    vector * vector.length_recip()
}
