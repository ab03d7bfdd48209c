//! Where things are: the folders of cases, scenes, references and reports.

use std::path::{Path, PathBuf};

/// The root of a checkout, or of any folder laid out like one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Project {
    root: PathBuf,
}

/// No folder with cases was found.
#[derive(Debug, thiserror::Error)]
#[error(
    "no folder `cases` here or above; run furnace inside its checkout, or set FURNACE_HOME to it"
)]
pub(crate) struct NoProject;

impl Project {
    /// The project at `root`.
    pub fn at(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// The project that the user stands in: `FURNACE_HOME`, or the nearest folder above the current one that
    /// has `cases` and `scenes`.
    pub(crate) fn find() -> Result<Self, NoProject> {
        if let Some(home) = std::env::var_os("FURNACE_HOME") {
            return Ok(Self::at(home));
        }
        let here = std::env::current_dir().map_err(|_| NoProject)?;
        here.ancestors().find(|folder| is_root(folder)).map(Self::at).ok_or(NoProject)
    }

    /// What is asked.
    pub fn cases(&self) -> PathBuf {
        self.root.join("cases")
    }

    /// What it is asked of.
    pub fn scenes(&self) -> PathBuf {
        self.root.join("scenes")
    }

    /// What is true. Only `furnace reference make` writes here.
    pub fn references(&self) -> PathBuf {
        self.root.join("references")
    }

    /// What no core may read: what is asked, what is true, what was found, and where copies of that are kept.
    pub(crate) fn secrets(&self) -> Vec<PathBuf> {
        ["cases", "references", "reports", "suites", ".git"]
            .map(|folder| self.root.join(folder))
            .to_vec()
    }

    /// Where runs go.
    pub fn runs(&self) -> PathBuf {
        self.root.join("reports").join("runs")
    }
}

fn is_root(folder: &Path) -> bool {
    folder.join("cases").is_dir() && folder.join("scenes").is_dir()
}
