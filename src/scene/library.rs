//! The scenes of a folder, each read once.

use super::file::{self, Overrides};
use super::{SceneDescription, SceneError};
use crate::text::{Source, did_you_mean, listed};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A folder of `<name>.toml` files. Shared between threads; a scene is read once for each set of
/// overrides.
#[derive(Debug)]
pub struct Library {
    folder: PathBuf,
    read: Mutex<HashMap<String, Arc<SceneDescription>>>,
}

impl Library {
    /// The scenes in `folder`. Nothing is read yet.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), read: Mutex::default() }
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The scene `name` with its parameters as they stand in its file, but for `overrides`.
    pub fn load(
        &self,
        name: &str,
        overrides: &Overrides,
    ) -> Result<Arc<SceneDescription>, SceneError> {
        let key = format!("{name} {overrides}");
        let remembered = || self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(scene) = remembered().get(&key) {
            return Ok(Arc::clone(scene));
        }
        let scene = Arc::new(self.read(name, overrides)?);
        remembered().insert(key, Arc::clone(&scene));
        Ok(scene)
    }

    /// The names of all scenes, in the order of the alphabet.
    pub fn names(&self) -> Result<Vec<String>, SceneError> {
        let unreadable = |problem: std::io::Error| SceneError::Unreadable {
            path: self.folder.display().to_string(),
            problem: problem.to_string(),
        };
        let mut names = Vec::new();
        for entry in std::fs::read_dir(&self.folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
            }
        }
        names.sort_unstable();
        Ok(names)
    }

    fn read(&self, name: &str, overrides: &Overrides) -> Result<SceneDescription, SceneError> {
        let path = self.folder.join(format!("{name}.toml"));
        if !path.is_file() {
            return Err(self.no_such_scene(name));
        }
        load_file(&path, overrides)
    }

    fn no_such_scene(&self, name: &str) -> SceneError {
        let known = self.names().unwrap_or_default();
        let known = || known.iter().map(String::as_str);
        let hint = did_you_mean(name, known());
        SceneError::NoSuchScene {
            name: name.to_owned(),
            folder: self.folder.display().to_string(),
            hint: hint.unwrap_or_else(|| format!("there are {}", listed(known()))),
        }
    }
}

/// The scene in a file, called by the file's name without `.toml`.
pub fn load_file(path: &Path, overrides: &Overrides) -> Result<SceneDescription, SceneError> {
    let source = Source::read(path).map_err(|problem| SceneError::Unreadable {
        path: path.display().to_string(),
        problem: problem.to_string(),
    })?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    file::parse(&name, &source, folder, overrides)
}
