//! What is true of a scene: an image by Mitsuba, how well it is known, and where it comes from.
//!
//! `references/<name>/reference.exr` holds the mean in R, G, B and the standard error of that mean
//! in se.R, se.G, se.B, and what else is known in [`Layers`]; `provenance.toml` beside it says how it
//! came about. A reference is pinned to the content hash of its scene.
//!
//! Only reading is here, on a layer that checks may name. What makes references is
//! `crate::reference`, out of their reach: no test run writes into `references/`.

mod layers;
mod provenance;

pub(crate) use layers::{FirstHits, Layers, bounce_layer};
pub(crate) use provenance::Provenance;

use super::SceneDescription;
use super::hash::content_hash;
use crate::image::Image;
use crate::image::exr::{self, Exr};
use crate::text::Source;
pub use crate::text::fingerprint;
use std::path::{Path, PathBuf};

/// Channels of the standard error are called `se.R`, `se.G` and `se.B`.
pub(crate) const ERROR_PREFIX: &str = "se.";

/// An image, its noise and its provenance.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The folder's name.
    pub name: String,
    /// Mean radiance.
    pub mean: Image,
    /// Standard error of that mean.
    pub standard_error: Image,
    /// What is known beside the image.
    pub layers: Layers,
    /// How it came about.
    pub provenance: Provenance,
}

/// Why there is no reference to compare with. Says which command makes one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("reference `{name}` {problem}\nhint: `{}`", self.command())]
pub struct ReferenceError {
    pub(crate) name: String,
    pub(crate) problem: ReferenceProblem,
}

/// What can be the matter with a reference.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum ReferenceProblem {
    #[error("does not exist: there is no `{}`", .0.display())]
    Missing(PathBuf),
    #[error("is damaged: {0}")]
    Damaged(String),
    #[error("is {found:?} pixels in size, but the scene's film is {film:?}")]
    WrongSize { found: [usize; 2], film: [usize; 2] },
    #[error("is of another scene: `{scene}` has changed since it was made")]
    OtherScene { scene: String },
}

impl ReferenceError {
    /// The command that makes the reference, or makes it anew.
    pub(crate) fn command(&self) -> String {
        let replace = match self.problem {
            ReferenceProblem::Missing(_) => "",
            _ => " --replace",
        };
        format!("furnace reference make {}{replace}", self.name)
    }
}

/// Where the image of reference `name` is, below the folder of references.
pub fn picture_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(name).join("reference.exr")
}

/// Where the provenance of reference `name` is, below the folder of references.
pub fn provenance_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(name).join("provenance.toml")
}

/// Reference `name` from the first of these folders that has it.
pub(crate) fn load_from(
    folders: &[PathBuf],
    name: &str,
    scene: &SceneDescription,
) -> Result<Reference, ReferenceError> {
    load(folder_of(folders, name), name, scene)
}

/// The first of these folders that has a reference `name`; where none has, the first.
pub(crate) fn folder_of<'a>(folders: &'a [PathBuf], name: &str) -> &'a Path {
    let has_it = |folder: &&PathBuf| folder.join(name).is_dir();
    let found = folders.iter().find(has_it).or(folders.first());
    found.map_or(Path::new("references"), PathBuf::as_path)
}

/// Reference `name` from the folder of references, if it is whole and of this very `scene`.
pub fn load(
    folder: &Path,
    name: &str,
    scene: &SceneDescription,
) -> Result<Reference, ReferenceError> {
    let wrong = |problem| ReferenceError { name: name.to_owned(), problem };
    let provenance = read_provenance(folder, name).map_err(wrong)?;
    if provenance.scene_hash != content_hash(scene) {
        let scene = scene.name.clone();
        return Err(wrong(ReferenceProblem::OtherScene { scene }));
    }
    let film = scene.camera.as_ref().map_or([0, 0], |camera| camera.film.map(|n| n as usize));
    let file = read_picture(folder, name, &provenance, film).map_err(wrong)?;
    let (mean, standard_error) = mean_and_error(&file).map_err(wrong)?;
    let layers = Layers::read(&file);
    Ok(Reference { name: name.to_owned(), mean, standard_error, layers, provenance })
}

fn damaged(problem: impl std::fmt::Display) -> ReferenceProblem {
    ReferenceProblem::Damaged(problem.to_string())
}

/// The provenance of reference `name`, whatever its scene has become.
pub(crate) fn read_provenance(folder: &Path, name: &str) -> Result<Provenance, ReferenceProblem> {
    let path = provenance_path(folder, name);
    if !path.is_file() {
        return Err(ReferenceProblem::Missing(path));
    }
    let source = Source::read(&path).map_err(damaged)?;
    source.parse_toml().map_err(damaged)
}

fn read_picture(
    folder: &Path,
    name: &str,
    provenance: &Provenance,
    film: [usize; 2],
) -> Result<Exr, ReferenceProblem> {
    let path = picture_path(folder, name);
    if !path.is_file() {
        return Err(ReferenceProblem::Missing(path));
    }
    let file = exr::read(&path).map_err(damaged)?;
    let found = [file.width, file.height];
    if found != film {
        return Err(ReferenceProblem::WrongSize { found, film });
    }
    let content = std::fs::read(&path).map_err(damaged)?;
    if fingerprint(&content) != provenance.picture_hash {
        return Err(damaged("the image does not match its provenance"));
    }
    Ok(file)
}

fn mean_and_error(file: &Exr) -> Result<(Image, Image), ReferenceProblem> {
    let mean = file.image().map_err(damaged)?;
    let standard_error = file.colours(ERROR_PREFIX).map_err(damaged)?;
    let values = mean.pixels.iter().chain(&standard_error.pixels).flatten();
    if values.copied().all(|value| value >= 0.0 && value.is_finite()) {
        Ok((mean, standard_error))
    } else {
        Err(damaged("it has values that are negative or NaN"))
    }
}

#[cfg(test)]
mod tests;
