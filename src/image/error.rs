//! What can be wrong with an image file.

use std::path::{Path, PathBuf};

#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// Missing, truncated, or not a file of its kind.
    #[error("cannot read `{}` as an image: {cause}", .path.display())]
    Unreadable { path: PathBuf, cause: String },
    #[error("the image has no channel `{channel}`; its channels are {}", .found.join(", "))]
    NoChannel { channel: String, found: Vec<String> },
    #[error("channel `{channel}` has {values} values for {pixels} pixels")]
    WrongLength { channel: String, values: usize, pixels: usize },
    #[error("the images differ in size: {} × {} and {} × {} pixels",
        .sizes[0][0], .sizes[0][1], .sizes[1][0], .sizes[1][1])]
    DifferentSizes {
        /// Columns and rows of each.
        sizes: [[usize; 2]; 2],
    },
    #[error("the images have no pixels")]
    Empty,
    #[error("cannot write `{}`: {cause}", .path.display())]
    Unwritable { path: PathBuf, cause: String },
}

impl ImageError {
    /// A file that is not what it should be, in the words of whoever read it.
    pub(crate) fn unreadable(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Unreadable { path: path.to_owned(), cause: cause.to_string() }
    }

    pub(super) fn unwritable(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Unwritable { path: path.to_owned(), cause: cause.to_string() }
    }
}
