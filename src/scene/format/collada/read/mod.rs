//! `<name>.dae` → [`SceneDescription`]: the course's COLLADA files with their CGL profile, exactly as
//! the course's own program understands them.
//!
//! That program departs from the COLLADA standard in many places, and its files rely on it: the camera's
//! position is not used, positions are rounded to single precision, the normals of open meshes
//! come out reversed. All of that is done here in the same order of operations, so that the camera and
//! the geometry agree with the course's to the last bit (with the same mathematical library).
//!
//! Where `furnace` cannot say what the course says, a file is either refused or read with a
//! [`Reading::differences`]. The notable ones:
//!
//! - The course declares its lights apart from the surfaces that are seen to emit, and they need not agree: in its
//!   boxes the light is turned by a right angle, and may be of another brightness. Here a light that lies in an
//!   emissive mesh *is* that mesh: what is seen is what shines, to the side that the light declares. An area light
//!   without such a mesh gets one.
//! - Emissive surfaces shine from both sides in the course, point lights do not weaken with
//!   distance: these are [`Conventions`](crate::contract::Conventions) of a core, not of a scene.
//! - The front of a triangle is the side of its shading normals, whatever its winding.
//!
//! Refused are files on which the course's program crashes, and what has no counterpart.

mod camera;
mod emitters;
mod geometry;
mod light;
mod material;
mod node;
mod normals;
mod settings;
mod xml;

pub(super) use normals::vertex_normals;
pub(super) use settings::degrees_for;
pub(crate) use settings::load_camera;

use crate::scene::error::read_source;
use crate::scene::{SceneDescription, SceneError};
use crate::text::Source;
use std::path::Path;

/// The size of the course's images where nothing else is asked for.
pub(crate) const FILM: [u32; 2] = [800, 600];

/// A scene, and what it does not say as the course says it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    pub(crate) scene: SceneDescription,
    /// One sentence each.
    pub(crate) differences: Vec<String>,
}

/// Reads a file. `film` is the size of the picture, the course's `-r`: a smaller one is a part cut
/// out of the middle, since the course keeps the angle between two pixels.
///
/// # Errors
/// If the file cannot be read, or is none that the course's program renders.
pub fn load(path: &Path, film: [u32; 2]) -> Result<Reading, SceneError> {
    let source = read_source(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    parse(&name, &source, film)
}

/// Reads a text; `name` is what the scene will be called.
pub(crate) fn parse(name: &str, source: &Source, film: [u32; 2]) -> Result<Reading, SceneError> {
    let document = xml::parse(source)?;
    let reader = xml::Reader::new(source, &document);
    let file = node::read(&reader)?;
    Ok(emitters::resolve(name, file, film))
}

#[cfg(test)]
mod tests;
