//! The folder of a write-up: an image and a record for each figure. What is there with equal settings is taken, so
//! that a rerun goes on where another was ended.

use super::WriteupError;
use super::bvh::Timed;
use super::measured::Measured;
use crate::cores::CoreSpec;
use crate::disk;
use crate::image::ImageError;
use crate::scene::SceneDescription;
use crate::scene::hash::content_hash;
use crate::text::hexadecimal;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Of the figures, below the page.
pub(super) const FIGURES: &str = "figures";

/// Everything that a figure depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Key {
    /// The command that makes it.
    pub(super) command: String,
    scene: String,
    /// The files of the core, as they were.
    core: String,
}

impl Key {
    pub(super) fn new(command: &str, scene: &SceneDescription, core: &CoreSpec) -> Self {
        Self { command: command.to_owned(), scene: content_hash(scene), core: stamp(core) }
    }
}

/// What is kept beside the image: the last file of a figure to be written.
#[derive(Serialize, Deserialize)]
struct Record<T> {
    key: Key,
    result: T,
}

/// A figure that has been made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) struct Figure {
    /// Its name in the folder of figures.
    pub(super) file: String,
    pub(super) measured: Measured,
}

/// What can be taken from an earlier write-up.
pub(super) trait Kept: Serialize + DeserializeOwned {
    /// The image that belongs to it.
    fn file(&self) -> Option<&str>;
}

impl Kept for Figure {
    fn file(&self) -> Option<&str> {
        Some(&self.file)
    }
}

impl Kept for Timed {
    fn file(&self) -> Option<&str> {
        None
    }
}

pub(super) struct Store {
    folder: PathBuf,
}

impl Store {
    /// # Errors
    /// If there can be no such folder.
    pub(super) fn at(folder: &Path) -> Result<Self, WriteupError> {
        let figures = folder.join(FIGURES);
        std::fs::create_dir_all(&figures).map_err(|error| WriteupError::new(&figures, &error))?;
        Ok(Self { folder: figures })
    }

    pub(super) fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// What an earlier write-up has made with equal settings. Without its image a record is worth nothing.
    pub(super) fn kept<T: Kept>(&self, name: &str, key: &Key) -> Option<T> {
        let text = std::fs::read(self.record(name)).ok()?;
        let record: Record<T> = serde_json::from_slice(&text).ok()?;
        let is_there = record.result.file().is_none_or(|file| self.path(file).is_file());
        (is_there && record.key == *key).then_some(record.result)
    }

    /// # Errors
    /// If it cannot be written.
    pub(super) fn keep<T: Kept>(
        &self,
        name: &str,
        key: Key,
        result: &T,
    ) -> Result<(), WriteupError> {
        let path = self.record(name);
        let text = serde_json::to_vec_pretty(&Record { key, result });
        let text = text.map_err(|error| WriteupError::new(&path, &error))?;
        disk::replace(&path, &text).map_err(|error| WriteupError::new(&path, &error))
    }

    fn record(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.json"))
    }
}

impl From<ImageError> for WriteupError {
    fn from(error: ImageError) -> Self {
        Self(error.to_string())
    }
}

/// A core of the same name that was built anew is another core: the contents of every file that its words name, or,
/// of our own, when this program was built.
fn stamp(core: &CoreSpec) -> String {
    let words = core.as_str().strip_prefix("exec:").unwrap_or(core.as_str());
    let words = shell_words::split(words).unwrap_or_default();
    let mut hash = Sha256::new();
    let contents = words.iter().filter_map(|word| std::fs::read(word).ok());
    let read = contents.map(|content| hash.update(content)).count();
    if read == 0 {
        let program = std::env::current_exe().and_then(|path| path.metadata());
        let built = program.and_then(|program| Ok((program.len(), program.modified()?)));
        hash.update(format!("{built:?}"));
    }
    hexadecimal(hash)
}
