//! Scenes and meshes in the words of other programs, each format in a place of its own with what reads it and
//! what writes it.
//!
//! Every writer is strict: what its format cannot say is refused in words that name it, never left out or
//! approximated, so that the other program answers the question that a core is asked.
//!
//! Not here: the scene files of this project (`file`), and pictures ([`crate::image`]).

pub mod collada;
pub(crate) mod mitsuba;
pub(super) mod obj;
mod pbrt;
pub(super) mod ply;
pub(super) mod stl;
mod xml;

use super::{Camera, SceneDescription};
use crate::image::{Image, exr};
use crate::text::{all_of, hint};
use glam::DAffine3;
use serde::Deserialize;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// What a whole scene can be written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Format {
    /// Mitsuba 3: `scene.xml` and the meshes it names.
    Mitsuba,
    /// The COLLADA of the course, with its CGL profile, and the camera file for its `-c`.
    Collada,
    Pbrt,
    /// Wavefront OBJ and MTL: triangles and their materials.
    Obj,
}

impl Format {
    pub(crate) const ALL: [(&str, Self); 4] = [
        ("mitsuba", Self::Mitsuba),
        ("collada", Self::Collada),
        ("pbrt", Self::Pbrt),
        ("obj", Self::Obj),
    ];
}

impl FromStr for Format {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|(name, _)| *name == word);
        found.map(|(_, format)| format).ok_or_else(|| {
            let names = || Self::ALL.iter().map(|(name, _)| *name);
            let hint = hint(word, names(), || all_of(names()));
            format!("there is no format `{word}`\nhint: {hint}")
        })
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mitsuba => "Mitsuba",
            Self::Collada => "the course's COLLADA",
            Self::Pbrt => "pbrt",
            Self::Obj => "OBJ",
        })
    }
}

/// What is to be made of the scene, for formats that say so in the scene's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Bounces 0 to this one are added up.
    pub last_bounce: u32,
    /// Samples a pixel.
    pub samples: u32,
    /// Of the random numbers.
    pub seed: u64,
}

#[derive(Debug, thiserror::Error)]
pub(crate) enum ExportError {
    /// The format has no words for something in the scene.
    #[error("{format} cannot hold scene `{scene}`: {what}")]
    CannotHold { format: Format, scene: String, what: String },
    #[error("cannot write {path}: {error}")]
    Io { path: PathBuf, error: std::io::Error },
}

/// Where the parts of a written scene are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Written {
    /// What a program is given.
    pub(crate) scene: PathBuf,
    /// The camera, where it has a file of its own.
    pub(crate) camera: Option<PathBuf>,
}

/// Writes `scene` into `folder`, which exists.
pub(crate) fn write(
    scene: &SceneDescription,
    format: Format,
    request: Request,
    folder: &Path,
) -> Result<Written, ExportError> {
    let exported = match format {
        Format::Mitsuba => mitsuba::export(scene, request.last_bounce),
        Format::Collada => collada::export(scene),
        Format::Pbrt => pbrt::export(scene, request),
        Format::Obj => obj::export(scene),
    }?;
    exported.write_to(folder)
}

/// The files of a scene; the first one is what a program is given.
#[derive(Debug)]
pub(crate) struct Exported {
    files: Vec<(String, Content)>,
    camera: Option<&'static str>,
}

#[derive(Debug)]
enum Content {
    Text(String),
    Bytes(Vec<u8>),
    Picture(Image),
}

impl Exported {
    fn of_texts<const N: usize>(files: [(&str, String); N]) -> Self {
        let files = files.map(|(name, text)| (name.to_owned(), Content::Text(text)));
        Self { files: files.into(), camera: None }
    }

    /// Writes the files into `folder`, which exists.
    pub(crate) fn write_to(&self, folder: &Path) -> Result<Written, ExportError> {
        for (name, content) in &self.files {
            let path = folder.join(name);
            content.write(&path).map_err(|error| ExportError::Io { path, error })?;
        }
        Ok(Written {
            scene: folder.join(&self.files[0].0),
            camera: self.camera.map(|name| folder.join(name)),
        })
    }
}

impl Content {
    fn write(&self, path: &Path) -> std::io::Result<()> {
        match self {
            Self::Text(text) => std::fs::write(path, text),
            Self::Bytes(bytes) => std::fs::write(path, bytes),
            Self::Picture(picture) => {
                exr::write_image(path, picture).map_err(std::io::Error::other)
            }
        }
    }
}

/// What a writer complains of, for one scene and one format.
#[derive(Clone, Copy)]
struct Complaint<'a> {
    format: Format,
    scene: &'a SceneDescription,
}

impl<'a> Complaint<'a> {
    fn about(self, what: impl Into<String>) -> ExportError {
        let scene = self.scene.name.clone();
        ExportError::CannotHold { format: self.format, scene, what: what.into() }
    }

    /// The scene's camera, without which most formats make no image.
    fn camera(self) -> Result<&'a Camera, ExportError> {
        self.scene.camera.as_ref().ok_or_else(|| self.about("it has no camera"))
    }

    /// The same for a program that knows square pixels only.
    fn square_camera(self) -> Result<&'a Camera, ExportError> {
        let camera = self.camera()?;
        match camera.has_square_pixels() {
            true => Ok(camera),
            false => {
                let format = self.format;
                Err(self.about(format!("its camera's pixels are not square, and {format}'s are")))
            }
        }
    }
}

/// Numbers with as many digits as it takes to read them back unchanged.
fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    let words: Vec<_> = values.into_iter().map(|value| value.to_string()).collect();
    words.join(" ")
}

/// Three rows of a transform, as [`numbers`], and the fourth.
fn matrix(transform: DAffine3) -> String {
    let row = |row: usize| {
        let [x, y, z] = transform.matrix3.row(row).to_array();
        numbers([x, y, z, transform.translation[row]])
    };
    format!("{} {} {} 0 0 0 1", row(0), row(1), row(2))
}

#[cfg(test)]
mod tests;
