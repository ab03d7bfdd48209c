//! Why a scene cannot be had.

use crate::text::{Diagnostic, Source};
use std::path::Path;

/// Why a scene cannot be had. Displays with file, line and caret where a file is at fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneError {
    /// The file has a mistake.
    #[error("{0}")]
    Wrong(Box<Diagnostic>),
    /// No file has that name.
    #[error("there is no scene `{name}` in `{folder}`\nhint: {hint}")]
    NoSuchScene {
        /// What was asked for.
        name: String,
        /// Where it was looked for.
        folder: String,
        /// The nearest names.
        hint: String,
    },
    /// A value is given to a parameter that the scene has not.
    #[error("{problem}{}", hint.as_ref().map_or_else(String::new, |hint| format!("\nhint: {hint}")))]
    NoSuchParameter {
        /// The parameter's name.
        parameter: String,
        /// What is wrong, in a sentence.
        problem: String,
        /// The nearest names, or those that there are.
        hint: Option<String>,
    },
    /// A value is not one that the parameter can have.
    #[error("{diagnostic}")]
    WrongParameter {
        /// Its name.
        parameter: String,
        /// What is wrong with the value.
        diagnostic: Box<Diagnostic>,
    },
    /// The file is there and cannot be read, or is not there.
    #[error("cannot read `{path}`: {problem}")]
    Unreadable {
        /// The file's.
        path: String,
        /// In the words of the system.
        problem: String,
    },
}

impl SceneError {
    pub(in crate::scene) fn unreadable(path: &Path, problem: &std::io::Error) -> Self {
        Self::Unreadable { path: path.display().to_string(), problem: problem.to_string() }
    }
}

/// The text of a file of a scene.
pub(in crate::scene) fn read_source(path: &Path) -> Result<Source, SceneError> {
    Source::read(path).map_err(|problem| SceneError::unreadable(path, &problem))
}

impl From<Diagnostic> for SceneError {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Wrong(Box::new(diagnostic))
    }
}

/// Why a mesh is not one. A lowercase fragment that fits after the name of the file.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    #[error("is not a valid {format} file: {problem}")]
    Malformed {
        /// OBJ, PLY or STL.
        format: &'static str,
        problem: String,
    },
    #[error("triangle {triangle} refers to vertex {index}, but there are only {vertices} vertices")]
    NoSuchVertex {
        /// Counted from 0.
        triangle: usize,
        index: u32,
        vertices: usize,
    },
    #[error("vertex {0} has a coordinate that is not a finite number")]
    NotFinite(usize),
    #[error("the normal of vertex {0} is zero or not finite")]
    NoDirection(usize),
    #[error("there are {normals} normals for {vertices} vertices")]
    NormalCount { normals: usize, vertices: usize },
    #[error("has no triangles")]
    Empty,
}

impl MeshError {
    pub(in crate::scene) fn malformed(
        format: &'static str,
        problem: &dyn std::fmt::Display,
    ) -> Self {
        Self::Malformed { format, problem: problem.to_string() }
    }
}
