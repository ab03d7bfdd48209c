//! Scenes in the words of other programs, so that these answer the question that a core is asked.
//!
//! Every writer is strict: what its format cannot say is refused in words that name it, never left out or
//! approximated. Mitsuba's format is written in [`crate::scene::mitsuba`], next to the references that are
//! made with it.

mod collada;
mod obj;
mod pbrt;

use crate::scene::SceneDescription;
use crate::scene::mitsuba::{self, MitsubaError};
use serde::Deserialize;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Mitsuba 3: `scene.xml` and the meshes it names.
    Mitsuba,
    /// The COLLADA of the course, with its CGL profile, and the camera file for its `-c`.
    Collada,
    /// pbrt-v4.
    Pbrt,
    /// Wavefront OBJ and MTL: triangles and their materials.
    Obj,
}

impl Format {
    /// Every format, with the word for it.
    pub const ALL: [(&str, Self); 4] = [
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
            let names = Self::ALL.map(|(name, _)| name);
            format!("the formats are {}", crate::text::listed(names))
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

/// Why a scene was not written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The format has no words for something in the scene.
    #[error("{format} cannot hold scene `{scene}`: {what}")]
    CannotHold {
        /// In which format.
        format: Format,
        /// Which scene.
        scene: String,
        /// Which thing of it, and why not.
        what: String,
    },
    /// As above, by the writer of Mitsuba's format.
    #[error(transparent)]
    Mitsuba(#[from] MitsubaError),
    /// A file cannot be written.
    #[error("cannot write {path}: {error}")]
    Io {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
}

/// Where the parts of a written scene are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// What a program is given.
    pub scene: PathBuf,
    /// The camera, where it has a file of its own.
    pub camera: Option<PathBuf>,
}

/// Writes `scene` into `folder`, which exists.
///
/// # Errors
/// If the format cannot hold the scene, or a file cannot be written.
pub fn write(
    scene: &SceneDescription,
    format: Format,
    request: Request,
    folder: &Path,
) -> Result<Written, ExportError> {
    match format {
        Format::Mitsuba => {
            mitsuba::export(scene, request.last_bounce)?
                .write_to(folder)
                .map_err(|error| ExportError::Io { path: folder.to_owned(), error })?;
            Ok(Written { scene: folder.join("scene.xml"), camera: None })
        }
        Format::Collada => collada::export(scene)?.write_to(folder),
        Format::Pbrt => pbrt::export(scene, request)?.write_to(folder),
        Format::Obj => obj::export(scene)?.write_to(folder),
    }
}

/// Text files; the first one is what a program is given.
#[derive(Debug)]
struct Exported {
    files: Vec<(&'static str, String)>,
    /// The file of the camera.
    camera: Option<&'static str>,
}

impl Exported {
    fn write_to(&self, folder: &Path) -> Result<Written, ExportError> {
        for (name, text) in &self.files {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|error| ExportError::Io { path, error })?;
        }
        Ok(Written {
            scene: folder.join(self.files[0].0),
            camera: self.camera.map(|name| folder.join(name)),
        })
    }
}

/// What a writer complains of, for one scene and one format.
#[derive(Clone, Copy)]
struct Complaint<'a> {
    format: Format,
    scene: &'a SceneDescription,
}

impl Complaint<'_> {
    fn about(self, what: impl Into<String>) -> ExportError {
        let scene = self.scene.name.clone();
        ExportError::CannotHold { format: self.format, scene, what: what.into() }
    }
}

/// Numbers with as many digits as it takes to read them back unchanged.
fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    let words: Vec<_> = values.into_iter().map(|value| value.to_string()).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests;
