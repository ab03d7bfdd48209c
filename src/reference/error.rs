//! Why a reference could not be made or verified.

use crate::image::ImageError;
use crate::scene::SceneError;
use crate::scene::format::ExportError;
use crate::scene::reference::ReferenceError;
use crate::text::{Diagnostic, number};
use std::path::{Path, PathBuf};

/// Why a reference could not be made or verified.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MakeError {
    #[error("{0}")]
    Recipes(Box<Diagnostic>),
    #[error("there is no recipe for `{name}` in `references/recipes.toml`\nhint: {hint}")]
    NoRecipe { name: String, hint: String },
    #[error("{0}")]
    Options(String),
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error(
        "the film of `{scene}` is {film:?} pixels: a reference needs multiples of 32, \
         or neighbouring seeds share random numbers"
    )]
    Film { scene: String, film: [u32; 2] },
    #[error(
        "reference `{0}` exists already\nhint: `--extend` adds passes, `--replace` makes it anew"
    )]
    Exists(String),
    #[error(
        "the sums of the passes of `{name}` are not in `{}`: {problem}\n\
         hint: `--replace` renders all passes, and keeps their sums", .path.display()
    )]
    NoSums { name: String, path: PathBuf, problem: String },
    #[error(
        "the bounces of `{name}` have {} of its light together\n\
         hint: `furnace reference verify {name}` says whether Mitsuba still agrees with it",
        number::ratio(*.ratio)
    )]
    BouncesDoNotAddUp { name: String, ratio: f64 },
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    #[error(
        "there is no Python environment with Mitsuba in `{}`\n\
         hint: `--create-venv` installs {requirements} there (some 200 MB)", .folder.display()
    )]
    NoEnvironment { folder: PathBuf, requirements: String },
    #[error("{program} failed ({how}); the end of its output:\n{last_words}")]
    Program { program: String, how: String, last_words: String },
    #[error("pass {seed} of `{name}` has a pixel that is negative or NaN")]
    ImpossiblePass { name: String, seed: u32 },
    #[error(transparent)]
    Picture(#[from] ImageError),
    #[error("`{}`: {problem}", .path.display())]
    File { path: PathBuf, problem: String },
}

impl MakeError {
    /// For `map_err` of what is done with a file.
    pub(super) fn at<E: std::fmt::Display>(path: &Path) -> impl FnOnce(E) -> Self {
        move |problem| Self::file(path, &problem)
    }

    pub(super) fn file(path: &Path, problem: &dyn std::fmt::Display) -> Self {
        Self::File { path: path.to_owned(), problem: problem.to_string() }
    }
}
