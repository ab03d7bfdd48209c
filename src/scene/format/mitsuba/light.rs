//! Lights that are not shapes. Area lights go with their shapes.

use crate::image::Image;
use crate::scene::format::Content;
use crate::scene::format::xml::XmlWriter;
use crate::scene::{Light, SceneDescription};
use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::PI;

/// Rows of a gradient sky's image. Mitsuba puts the first and the last at the poles and interpolates: with so many, and
/// the middle one on the horizon, it is off by (π/1024)²/8 = 1.2e-6 at most.
const SKY_ROWS: usize = 1025;

const SKY_FILE: &str = "sky.exr";

/// Writes every light, and returns the image of the sky if there is one.
pub(super) fn write_all(
    xml: &mut XmlWriter,
    scene: &SceneDescription,
) -> Option<(String, Content)> {
    let mut sky = None;
    for light in &scene.lights {
        match *light {
            Light::Point { position, intensity } => {
                xml.open("emitter", &[("type", "point")]);
                xml.point("position", position);
                xml.rgb("intensity", intensity);
            }
            Light::Directional { direction, irradiance } => {
                xml.open("emitter", &[("type", "directional")]);
                xml.direction("direction", direction);
                xml.rgb("irradiance", irradiance);
            }
            Light::ConstantSky { radiance } => {
                xml.open("emitter", &[("type", "constant")]);
                xml.rgb("radiance", radiance);
            }
            Light::GradientSky { up, .. } => {
                xml.open("emitter", &[("type", "envmap")]);
                xml.string("filename", SKY_FILE);
                xml.transform(DAffine3::from_quat(DQuat::from_rotation_arc(DVec3::Y, up)));
                sky = Some((SKY_FILE.to_owned(), Content::Picture(sky_picture(light, up))));
            }
            Light::Area { .. } => continue,
        }
        xml.close();
    }
    sky
}

/// The sky by angle from `up`, straight above in row 0.
fn sky_picture(light: &Light, up: DVec3) -> Image {
    let sideways = up.any_orthonormal_vector();
    Image::from_fn(4, SKY_ROWS, |_, row| {
        let (sin, cos) = (PI * row as f64 / (SKY_ROWS - 1) as f64).sin_cos();
        #[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
        light.sky_radiance(cos * up + sin * sideways).map(|channel| channel as f32)
    })
}
