//! Why a scene cannot be had.

use crate::text::Diagnostic;

/// Why a scene cannot be had. Displays with file, line and caret where a file is at fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneError {
    /// The file says something wrong.
    #[error("{0}")]
    Wrong(Box<Diagnostic>),
    /// There is no such file.
    #[error("there is no scene `{name}` in `{folder}`\nhint: {hint}")]
    NoSuchScene {
        /// What was asked for.
        name: String,
        /// Where it was looked for.
        folder: String,
        /// The name that was probably meant, or all names.
        hint: String,
    },
    /// A case overrides a parameter that the scene does not declare.
    #[error("scene `{scene}` has no parameter `{parameter}`, only {known}")]
    NoSuchParameter {
        /// The scene.
        scene: String,
        /// What the case calls it.
        parameter: String,
        /// What there is.
        known: String,
        /// The name that was probably meant.
        hint: Option<String>,
    },
    /// A value that a case gives to a parameter is wrong where the scene uses it.
    #[error("{diagnostic}")]
    WrongParameter {
        /// Which.
        parameter: String,
        /// Where it is used, and what is wrong there.
        diagnostic: Box<Diagnostic>,
    },
    /// The file or the folder cannot be read.
    #[error("cannot read `{path}`: {problem}")]
    Unreadable {
        /// Which.
        path: String,
        /// In the system's words.
        problem: String,
    },
}

impl From<Diagnostic> for SceneError {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Wrong(Box::new(diagnostic))
    }
}

/// Why a mesh is not one. A lowercase fragment that fits after the name of the file.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// The file is not there, or may not be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// The library does not understand the file.
    #[error("is not a valid {format} file: {problem}")]
    Malformed {
        /// OBJ, PLY or STL.
        format: &'static str,
        /// In the library's words.
        problem: String,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {index}, but there are only {vertices} vertices")]
    NoSuchVertex {
        /// Counted from 0.
        triangle: usize,
        /// What it says.
        index: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {0} has a coordinate that is not a finite number")]
    NotFinite(usize),
    /// A normal is NaN, infinite, or has no direction.
    #[error("the normal of vertex {0} is zero or not finite")]
    NoDirection(usize),
    /// Some vertices have normals and some have none.
    #[error("there are {normals} normals for {vertices} vertices")]
    NormalCount {
        /// How many normals.
        normals: usize,
        /// How many vertices.
        vertices: usize,
    },
    /// No triangles at all.
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
