//! Ctrl-c: what is known by then is told, and how to go on.

use super::ExitCode;
use super::say::{say, say_line};
use crate::report::text::Style;
use crate::report::{self, RunTree};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The folder of the run that goes on, once it has one.
#[derive(Clone, Default)]
pub(super) struct Running(Arc<Mutex<Option<PathBuf>>>);

impl Running {
    /// Ends the process at ctrl-c with what the folder says by then. Where that cannot be heard, it ends at once.
    pub(super) fn ends_in_words(style: Style) -> Self {
        let running = Self::default();
        let heard = running.clone();
        let tell = move || {
            if let Some(folder) = heard.folder() {
                say_line!();
                tell(&folder, style);
            }
            std::process::exit(ExitCode::Interrupted.number().into());
        };
        // Somebody else listens, as in a test: then it is not ours.
        let _ = ctrlc::set_handler(tell);
        running
    }

    pub(super) fn begins(&self, folder: &Path) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(folder.to_owned());
    }

    fn folder(&self) -> Option<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// As at the end of a run. There is no later moment to say what is wrong with the folder.
fn tell(folder: &Path, style: Style) {
    let Ok(tree) = RunTree::load(folder) else { return };
    say!("{}", report::text::summary(&tree, style));
    if let Ok(page) = report::html::write(&tree, folder) {
        say_line!("  report  {}", super::report::address(&page));
    }
}
