//! Ctrl-c: what is known by then is told, and how to go on. Who presses it again wants out at once.

use super::ExitCode;
use super::say::{say, say_line};
use crate::cores::command::process;
use crate::report::text::Style;
use crate::report::{self, RunTree};
use crate::run::Event;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Ends the process at ctrl-c, with all that it has started, and after these words. Where that cannot be heard, it ends at
/// once; workers end when nobody asks them any more.
pub(super) fn end_with(words: impl FnOnce() + Send + 'static) {
    let end = || std::process::exit(ExitCode::Interrupted.number().into());
    let mut words = Some(words);
    let hear = move || match words.take() {
        Some(words) => {
            let tell = move || {
                process::end_all();
                words();
                end();
            };
            std::thread::spawn(tell);
        }
        None => end(),
    };
    // Somebody else listens, as in a test: then it is not ours.
    let _ = ctrlc::set_handler(hear);
}

/// The folder of the run that goes on, once it has one.
#[derive(Clone, Default)]
pub(super) struct Running(Arc<Mutex<Option<PathBuf>>>);

impl Running {
    /// Ends the process at ctrl-c with what the folder says by then.
    pub(super) fn ends_in_words(style: Style) -> Self {
        let running = Self::default();
        let heard = running.clone();
        end_with(move || {
            if let Some(folder) = heard.folder() {
                say_line!();
                tell(&folder, style);
            }
        });
        running
    }

    pub(super) fn hear(&self, event: &Event<'_>) {
        if let Event::Planned { folder, .. } = event {
            *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((*folder).to_owned());
        }
    }

    fn folder(&self) -> Option<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// As at the end of a run: the page is there before a word refers to it. There is no later moment to say what is wrong with
/// the folder.
fn tell(folder: &Path, style: Style) {
    let Ok(tree) = RunTree::load(folder) else { return };
    let page = report::html::write(&tree, folder);
    say!("{}", report::text::summary(&tree, style));
    match page {
        Ok(page) => say_line!("  report  {}", super::report::address(&page)),
        Err(error) => say_line!("  report  none: {error}"),
    }
}
