//! What can be wrong with an image file.

use std::path::{Path, PathBuf};

/// What can be wrong with an image file.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// Missing, truncated, or not a file of its kind.
    #[error("cannot read `{}` as an image: {cause}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        cause: String,
    },
    /// The image lacks a channel.
    #[error("the image has no channel `{channel}`; its channels are {}", .found.join(", "))]
    NoChannel {
        /// The channel asked for.
        channel: String,
        /// The channels there are.
        found: Vec<String>,
    },
    /// A channel has another number of values than the image has pixels.
    #[error("channel `{channel}` has {values} values for {pixels} pixels")]
    WrongLength {
        /// The channel.
        channel: String,
        /// Its values.
        values: usize,
        /// Width times height.
        pixels: usize,
    },
    /// Two images that are to be compared differ in size.
    #[error("the images differ in size: {} × {} and {} × {} pixels",
        .sizes[0][0], .sizes[0][1], .sizes[1][0], .sizes[1][1])]
    DifferentSizes {
        /// Columns and rows of each.
        sizes: [[usize; 2]; 2],
    },
    /// There is nothing to compare.
    #[error("the images have no pixels")]
    Empty,
    /// The file cannot be written.
    #[error("cannot write `{}`: {cause}", .path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the encoder or the system said.
        cause: String,
    },
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
