//! Makes references with Mitsuba, lists them, and asks Mitsuba again whether they still hold.
//!
//! What to make is written in `references/recipes.toml`: the scene, the last bounce, how many passes of how many
//! samples. [`References::make`] renders those passes in a process of Mitsuba's own, each with its own seed and into
//! its own file, so that a run which is killed goes on where it was; then it adds the passes and their squares up,
//! exactly, and takes mean and variance. The sums stay in `references/.work`: by them a reference is extended by more
//! passes, or merged from parts that several machines have rendered. Each bounce alone, depth and normals are added
//! beside the picture. Why passes: Mitsuba adds up in single precision, which drifts beyond 2⁸ samples, and its own
//! second moments are of another colour space.
//!
//! Not here: reading a reference in order to compare with it (`scene::reference`), and printing:
//! whoever asks hears of [`Progress`].

mod environment;
mod error;
mod layers;
mod list;
mod make;
mod mitsuba;
mod recipe;
mod seeds;
mod shard;
mod store;
mod sums;
mod verify;

pub(crate) use crate::scene::reference::Reference;
pub(crate) use environment::MitsubaOptions;
pub(crate) use error::MakeError;
pub(crate) use list::State;
pub(crate) use make::{Made, MakeOptions};
pub(crate) use recipe::Recipe;

use crate::scene::Library;
use std::path::PathBuf;

/// The folder of references and the scenes they are pictures of.
#[derive(Debug)]
pub(crate) struct References {
    folder: PathBuf,
    scenes: Library,
}

/// What is being done, for whoever shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// A Python environment with Mitsuba is being installed.
    CreatingEnvironment {
        folder: PathBuf,
    },
    TryingVariant {
        /// Its name, and the LLVM library if it needs one.
        variant: String,
    },
    Rendering {
        done: u32,
        of: u32,
    },
}

pub(crate) type Listener<'a> = &'a mut dyn FnMut(Progress);

impl References {
    /// The references in `folder`, of the scenes in `scenes`.
    pub(crate) fn new(folder: impl Into<PathBuf>, scenes: Library) -> Self {
        Self { folder: folder.into(), scenes }
    }
}
