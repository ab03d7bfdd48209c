//! What a progress display hears while a run goes on.

use super::record::{RunRecord, TrialRecord};
use std::path::Path;

/// Something happened in a run. Events come from one thread at a time.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// The plan stands and the first trial is about to start.
    Planned {
        /// What `run.json` says.
        run: &'a RunRecord,
        /// The folder of the run.
        folder: &'a Path,
        /// Trials of a resumed run that are already there.
        earlier: &'a [TrialRecord],
    },
    /// A trial began.
    Started {
        /// The core's specification.
        core: &'a str,
        /// Folder and claim.
        case: &'a str,
    },
    /// Failing cases are tried again, with components of the bench in place of the core's own.
    Transplanting {
        /// The core's specification.
        core: &'a str,
    },
    /// A trial ended, and its sidecar is on disk.
    Ended {
        /// The sidecar.
        trial: &'a TrialRecord,
    },
}
