//! Readers of a run's folder: the summary for the terminal and the page for the browser.
//!
//! Both are functions of the files alone: they load no core, run no check, judge nothing and know
//! no threshold, so that a report can be made again from an old run, elsewhere. To add a page
//! section, write a file in `html/` and a line in its `SECTIONS`.

pub(crate) mod comparison;
pub(crate) mod digest;
mod earlier;
#[cfg(test)]
pub(crate) mod example;
mod history;
pub mod html;
pub(crate) mod measure;
pub mod text;
mod transplants;
pub(crate) mod tree;

#[cfg(feature = "cli")]
pub(crate) use history::{Reached, reached};
pub use text::{Style, summary};
pub use tree::{RunTree, TreeError};

use std::path::{Path, PathBuf};

/// What a browser opens.
pub(crate) fn address(page: &Path) -> String {
    let page = page.canonicalize().unwrap_or_else(|_| page.to_owned());
    format!("file://{}", page.display())
}

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// An I/O error.
    #[error("cannot write the report to {path}: {error}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
}
