//! What a worker is started for, what it may use up, and what holds of it once it is confined.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What a worker is started for; its one argument, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WorkerSpec {
    /// The core, as the user named it.
    pub(crate) core: String,
    pub(crate) origin: CoreOrigin,
    pub(crate) limits: Limits,
    /// The one folder it may write; each worker is given a new one.
    pub(crate) scratch: PathBuf,
    /// What it may never read, wherever it lies: cases, references, results.
    pub(crate) hidden: Vec<PathBuf>,
    /// What the user lets it read besides itself and the system.
    pub(crate) readable: Vec<PathBuf>,
    /// Whether it is sandboxed at all.
    pub(crate) confined: bool,
}

/// Where the code of a core comes from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum CoreOrigin {
    /// This very program: it is one of our own.
    BuiltIn,
    /// A shared library.
    Library(PathBuf),
    /// A program that speaks the protocol itself: its words.
    Program(Vec<String>),
    /// A program that makes pictures, started by the worker for each.
    Renderer {
        /// The file that says how.
        adapter: PathBuf,
        /// What it is started with, as far as that is known before there is a scene.
        words: Vec<String>,
    },
}

impl CoreOrigin {
    pub(crate) const fn may_start_processes(&self) -> bool {
        matches!(self, Self::Program(_) | Self::Renderer { .. })
    }

    /// What a program printed that failed to start in `scratch`, with the words of its command as they were written. One
    /// that it looked for there is not where it was started either: files that exist are named by their whole paths.
    pub(crate) fn retold(&self, printed: &str, scratch: &Path) -> String {
        let Self::Program(words) = self else { return printed.to_owned() };
        let sought = words.iter().filter(|word| Path::new(word).is_relative());
        sought.fold(printed.to_owned(), |printed, word| {
            let there = scratch.join(word).to_string_lossy().into_owned();
            if !printed.contains(&there) {
                return printed;
            }
            let told = printed.replace(&there, word);
            format!(
                "{}\nhint: there is no file `{word}` where furnace was started",
                told.trim_end()
            )
        })
    }
}

/// What one worker may use up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Seconds that the bench waits for it in one trial, all its answers together, or as long as it takes.
    pub seconds: Option<f64>,
    /// Bytes of memory a process, or as many as it likes.
    pub memory: Option<u64>,
    /// Bytes of one file.
    pub file: u64,
    /// Bytes of all its files together.
    pub scratch: u64,
    /// Processes at a time, of a program; a library has one.
    pub processes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            seconds: Some(120.0),
            memory: Some(4 << 30),
            file: 256 << 20,
            scratch: 1 << 30,
            processes: 64,
        }
    }
}

impl Limits {
    /// [`Self::seconds`] as the standard library has it.
    pub(crate) fn time(&self) -> Duration {
        let seconds = self.seconds.unwrap_or(f64::INFINITY);
        Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
    }
}

/// What holds of a worker, and what does not, one sentence each.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Confinement {
    /// What the system enforces.
    pub in_force: Vec<String>,
    /// What it cannot, or what the user has switched off.
    pub lacking: Vec<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_a_program_looks_for_in_its_own_folder_is_missing() {
        let words = ["/usr/bin/python3", "mine.pyy"].map(str::to_owned).to_vec();
        let told = CoreOrigin::Program(words).retold("no '/tmp/x/mine.pyy'\n", Path::new("/tmp/x"));
        assert_eq!(
            told,
            "no 'mine.pyy'\nhint: there is no file `mine.pyy` where furnace was started"
        );
        assert_eq!(
            CoreOrigin::BuiltIn.retold("no '/tmp/x/a'", Path::new("/tmp/x")),
            "no '/tmp/x/a'"
        );
    }
}
