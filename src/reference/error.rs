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
    /// Something is wrong in `recipes.toml`.
    #[error("{0}")]
    Recipes(Box<Diagnostic>),
    /// Nothing says what to make.
    #[error("there is no recipe for `{name}` in `references/recipes.toml`\nhint: {hint}")]
    NoRecipe {
        /// The reference.
        name: String,
        /// Another name, or all of them.
        hint: String,
    },
    /// The options ask for what a recipe may not.
    #[error("{0}")]
    Options(String),
    /// The scene cannot be had.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene cannot be said in Mitsuba's words, or not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// Sequences of random numbers would overlap.
    #[error(
        "the film of `{scene}` is {film:?} pixels: a reference needs multiples of 32, \
         or neighbouring seeds share random numbers"
    )]
    Film {
        /// The scene.
        scene: String,
        /// Columns and rows.
        film: [u32; 2],
    },
    /// There is one already.
    #[error(
        "reference `{0}` exists already\nhint: `--extend` adds passes, `--replace` makes it anew"
    )]
    Exists(String),
    /// What its passes add up to is not known here.
    #[error(
        "the sums of the passes of `{name}` are not in `{}`: {problem}\n\
         hint: `--replace` renders all passes, and keeps their sums", .path.display()
    )]
    NoSums {
        /// The reference.
        name: String,
        /// Where they should be.
        path: PathBuf,
        /// Why they are not.
        problem: String,
    },
    /// What was rendered bounce by bounce is not what the reference shows.
    #[error(
        "the bounces of `{name}` have {} of its light together\n\
         hint: `furnace reference verify {name}` says whether Mitsuba still agrees with it",
        number::ratio(*.ratio)
    )]
    BouncesDoNotAddUp {
        /// The reference.
        name: String,
        /// Their light over that of the picture.
        ratio: f64,
    },
    /// The reference to verify is not there.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// Mitsuba is not installed where it is looked for.
    #[error(
        "there is no Python environment with Mitsuba in `{}`\n\
         hint: `--create-venv` installs {requirements} there (some 200 MB)", .folder.display()
    )]
    NoEnvironment {
        /// Where it was looked for.
        folder: PathBuf,
        /// What would be installed.
        requirements: String,
    },
    /// Python, pip or Mitsuba failed.
    #[error("{program} failed ({how}); the end of its output:\n{last_words}")]
    Program {
        /// What was run.
        program: String,
        /// Exit code or signal.
        how: String,
        /// The end of what it wrote.
        last_words: String,
    },
    /// A pass holds what no picture does.
    #[error("pass {seed} of `{name}` has a pixel that is negative or NaN")]
    ImpossiblePass {
        /// The reference.
        name: String,
        /// The pass's seed.
        seed: u32,
    },
    /// A picture cannot be written.
    #[error(transparent)]
    Picture(#[from] ImageError),
    /// A file cannot be read or written.
    #[error("`{}`: {problem}", .path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// In the system's words.
        problem: String,
    },
}

impl MakeError {
    pub(super) fn file(path: &Path, problem: &dyn std::fmt::Display) -> Self {
        Self::File { path: path.to_owned(), problem: problem.to_string() }
    }
}
