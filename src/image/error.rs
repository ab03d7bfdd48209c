//! What can be wrong with a picture file.

use std::path::{Path, PathBuf};

/// What can be wrong with a picture file.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// Missing, truncated, or not an OpenEXR file.
    #[error("`{}` cannot be read as OpenEXR: {cause}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        cause: String,
    },
    /// The picture lacks a channel.
    #[error("the picture has no channel `{channel}`, it has {}", .found.join(", "))]
    NoChannel {
        /// The channel asked for.
        channel: String,
        /// The channels there are.
        found: Vec<String>,
    },
    /// A channel has another number of values than the picture has pixels.
    #[error("channel `{channel}` has {values} values for {pixels} pixels")]
    WrongLength {
        /// The channel.
        channel: String,
        /// Its values.
        values: usize,
        /// Width times height.
        pixels: usize,
    },
    /// The file cannot be written.
    #[error("`{}` cannot be written: {cause}", .path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the encoder or the system said.
        cause: String,
    },
}

impl ImageError {
    pub(super) fn unreadable(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Unreadable { path: path.to_owned(), cause: cause.to_string() }
    }

    pub(super) fn unwritable(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Unwritable { path: path.to_owned(), cause: cause.to_string() }
    }
}
