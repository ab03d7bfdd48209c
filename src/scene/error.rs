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
