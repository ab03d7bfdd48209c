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

use super::xml::XmlWriter;
use super::{Complaint, Content, ExportError, Exported, Format};
use crate::scene::{Camera, SceneDescription};

/// `scene.xml` and the files it names, asking for bounces 0 to `last_bounce` added up.
pub(crate) fn export(scene: &SceneDescription, last_bounce: u32) -> Result<Exported, ExportError> {
    let complaint = Complaint { format: Format::Mitsuba, scene };
    let camera = complaint.square_camera()?;
    let mut xml = XmlWriter::default();
    xml.open("scene", &[("version", "3.9.1")]);
    write_integrator(&mut xml, last_bounce);
    write_sensor(&mut xml, camera);
    let meshes = shape::write_all(&mut xml, complaint)?;
    let sky = light::write_all(&mut xml, scene);
    xml.close();
    let text = ("scene.xml".to_owned(), Content::Text(xml.finish()));
    let files = [text].into_iter().chain(meshes).chain(sky).collect();
    Ok(Exported { files, camera: None })
}

fn write_integrator(xml: &mut XmlWriter, last_bounce: u32) {
    xml.open("integrator", &[("type", "path")]);
    xml.integer("max_depth", last_bounce + 1);
    xml.integer("rr_depth", 1_000_000);
    // Streams of random numbers do not overlap between seeds if blocks tile the film.
    xml.integer("block_size", 32);
    xml.close();
}

fn write_sensor(xml: &mut XmlWriter, camera: &Camera) {
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
    // Unbiased and with a third of the variance of `independent`; `stratified` and `ldsampler` are biased.
    xml.leaf("sampler", &[("type", SAMPLER)]);
    xml.close();
}

/// The sampler that scenes are written with.
pub(crate) const SAMPLER: &str = "multijitter";

#[cfg(test)]
mod tests;
