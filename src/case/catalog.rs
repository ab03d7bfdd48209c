//! The folder is the registry: every `.toml` below `cases/` is a case.

use super::{Case, Part, Subject, file};
use crate::project::Project;
use crate::text::Source;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use walkdir::WalkDir;

/// Why the cases could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum CatalogError {
    /// A file could not be read.
    #[error("cannot read {path}: {error}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// Files that are no cases, each with file, line and caret.
    #[error("{}", .0.join("\n\n"))]
    Malformed(Vec<String>),
}

/// Every case below `folder`, in the order of parts, folders and names. All files at fault are told at once.
///
/// # Errors
/// If a file cannot be read, or is no case.
pub fn load_all(folder: &Path) -> Result<Vec<Arc<Case>>, CatalogError> {
    load_layers(&[folder.to_owned()])
}

/// Every case of a project, laid over those of the bench: of two of one name its own counts. Fails as [`load_all`].
pub(crate) fn load_project(project: &Project) -> Result<Vec<Arc<Case>>, CatalogError> {
    load_layers(&project.layers("cases"))
}

fn load_layers(folders: &[PathBuf]) -> Result<Vec<Arc<Case>>, CatalogError> {
    let mut cases = Vec::new();
    let mut complaints = Vec::new();
    let mut known = BTreeSet::new();
    for folder in folders {
        for path in case_files(folder)? {
            if !known.insert(id_of(folder, &path)) {
                continue;
            }
            match load(folder, &path)? {
                Ok(case) => cases.push(Arc::new(case)),
                Err(complaint) => complaints.push(complaint),
            }
        }
    }
    if !complaints.is_empty() {
        return Err(CatalogError::Malformed(complaints));
    }
    cases.sort_by_key(|case| (Part::position(&case.id), case.id.clone()));
    Ok(cases)
}

/// The case `id` alone, for whoever wants just that.
///
/// # Errors
/// If the file cannot be read, or is no case.
pub fn load_one(folder: &Path, id: &str) -> Result<Arc<Case>, CatalogError> {
    let path = folder.join(format!("{id}.toml"));
    let case =
        load(folder, &path)?.map_err(|complaint| CatalogError::Malformed(vec![complaint]))?;
    Ok(Arc::new(case))
}

fn case_files(folder: &Path) -> Result<Vec<PathBuf>, CatalogError> {
    let mut paths = Vec::new();
    for entry in WalkDir::new(folder).sort_by_file_name() {
        let entry = entry.map_err(|error| unreadable(folder, error))?;
        if entry.path().extension().is_some_and(|extension| extension == "toml") {
            paths.push(entry.into_path());
        }
    }
    Ok(paths)
}

/// What the system said, and of which file, once.
fn unreadable(folder: &Path, error: walkdir::Error) -> CatalogError {
    let path = error.path().unwrap_or(folder).to_owned();
    let error = error.into_io_error().unwrap_or_else(|| ErrorKind::Other.into());
    CatalogError::Io { path, error }
}

/// The case of a file, or the complaint about it.
fn load(folder: &Path, path: &Path) -> Result<Result<Case, String>, CatalogError> {
    let source =
        Source::read(path).map_err(|error| CatalogError::Io { path: path.to_owned(), error })?;
    let id = id_of(folder, path);
    if Part::of_case(&id).is_none() {
        return Ok(Err(format!("{}: {}", path.display(), unknown_folder())));
    }
    Ok(file::parse(&id, path, &source).map_err(|diagnostic| diagnostic.to_string()))
}

fn unknown_folder() -> String {
    let folders = crate::text::listed(Subject::all().map(Subject::folder));
    format!("a case belongs in one of the folders {folders}")
}

/// `cases/bvh/claim.toml` is `bvh/claim`, on every system.
fn id_of(folder: &Path, path: &Path) -> String {
    let inside = path.strip_prefix(folder).unwrap_or(path).with_extension("");
    let words: Vec<_> =
        inside.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    words.join("/")
}
