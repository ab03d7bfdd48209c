//! Writes a scene as Mitsuba 3 reads it, so that Mitsuba answers the very question a core is asked.
//!
//! What makes it the same question (each found by measurement, with Mitsuba 3.9.1):
//! - `max_depth` is the last bounce plus one, and roulette is off;
//! - the field of view is along x, the filter a box, the film f32;
//! - diffuse and metal scatter on both sides (`twosided`), light leaves the front only;
//! - a flat mesh says `face_normals`, or Mitsuba smooths it;
//! - glass says `ext_ior` 1.0, for the default is air.
//!
//! Not here: how Mitsuba is run, with which sampler and how long.

mod light;
mod shape;
mod xml;

use super::{Camera, SceneDescription};
use crate::image::{Image, exr};
use std::io;
use std::path::Path;
use xml::Xml;

/// A scene as Mitsuba reads it: `scene.xml` and the files it names.
#[derive(Clone, Debug, PartialEq)]
pub struct MitsubaScene {
    /// The text of `scene.xml`.
    pub xml: String,
    /// The files beside it, by name.
    pub attachments: Vec<(String, Attachment)>,
}

/// A file that `scene.xml` names.
#[derive(Clone, Debug, PartialEq)]
pub enum Attachment {
    /// The bytes of a PLY file.
    Mesh(Vec<u8>),
    /// An OpenEXR picture.
    Picture(Image),
}

/// Why a scene cannot be said in Mitsuba's words.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MitsubaError {
    /// There is nowhere to take a picture from.
    #[error("scene `{0}` has no camera")]
    NoCamera(String),
    /// Mitsuba derives the vertical field of view from square pixels.
    #[error("the camera of scene `{0}` has pixels that are not square, and Mitsuba's are")]
    PixelsNotSquare(String),
    /// Emission on a part of a sphere.
    #[error(
        "`{0}` glows on a cap only: Mitsuba knows no such light; its closed form is its reference"
    )]
    Cap(String),
}

impl MitsubaScene {
    /// Writes `scene.xml` and what it names into `folder`, which exists.
    pub fn write_to(&self, folder: &Path) -> io::Result<()> {
        for (name, attachment) in &self.attachments {
            let path = folder.join(name);
            match attachment {
                Attachment::Mesh(bytes) => std::fs::write(path, bytes)?,
                Attachment::Picture(picture) => {
                    exr::write_image(&path, picture).map_err(io::Error::other)?;
                }
            }
        }
        std::fs::write(folder.join("scene.xml"), &self.xml)
    }
}

/// `scene` for Mitsuba, asking for bounces 0 to `last_bounce` added up.
pub fn export(scene: &SceneDescription, last_bounce: u32) -> Result<MitsubaScene, MitsubaError> {
    let camera = scene.camera.as_ref().ok_or_else(|| MitsubaError::NoCamera(scene.name.clone()))?;
    if !has_square_pixels(camera) {
        return Err(MitsubaError::PixelsNotSquare(scene.name.clone()));
    }
    let mut xml = Xml::default();
    xml.open("scene", &[("version", "3.9.1")]);
    write_integrator(&mut xml, last_bounce);
    write_sensor(&mut xml, camera);
    let mut attachments = shape::write_all(&mut xml, scene)?;
    attachments.extend(light::write_all(&mut xml, scene));
    xml.close();
    Ok(MitsubaScene { xml: xml.finish(), attachments })
}

fn has_square_pixels(camera: &Camera) -> bool {
    let [width, height] = camera.film.map(f64::from);
    let ratio = (camera.vertical_fov / 2.0).tan() / (camera.horizontal_fov / 2.0).tan();
    (ratio * width / height - 1.0).abs() < 1e-9
}

fn write_integrator(xml: &mut Xml, last_bounce: u32) {
    xml.open("integrator", &[("type", "path")]);
    xml.integer("max_depth", last_bounce + 1);
    xml.integer("rr_depth", 1_000_000);
    // Streams of random numbers do not overlap between seeds if blocks tile the film.
    xml.integer("block_size", 32);
    xml.close();
}

fn write_sensor(xml: &mut Xml, camera: &Camera) {
    xml.open("sensor", &[("type", "perspective")]);
    xml.string("fov_axis", "x");
    xml.float("fov", camera.horizontal_fov.to_degrees());
    xml.float("near_clip", camera.near);
    xml.float("far_clip", camera.far);
    xml.open("transform", &[("name", "to_world")]);
    xml.look_at(
        camera.position,
        camera.position - camera.camera_to_world.z_axis,
        camera.camera_to_world.y_axis,
    );
    xml.close();
    xml.open("film", &[("type", "hdrfilm")]);
    xml.integer("width", camera.film[0]);
    xml.integer("height", camera.film[1]);
    xml.string("pixel_format", "rgb");
    xml.string("component_format", "float32");
    xml.leaf("rfilter", &[("type", "box")]);
    xml.close();
    // Unbiased and with a third of the variance of `independent`; `stratified` and `ldsampler` are
    // biased.
    xml.leaf("sampler", &[("type", SAMPLER)]);
    xml.close();
}

/// The sampler that scenes are written with.
pub const SAMPLER: &str = "multijitter";

#[cfg(test)]
mod tests;
