//! Whether files have changed: by their times and sizes, which every system knows.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::SystemTime;
use walkdir::WalkDir;

/// Files, when each was last written, and how long it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Snapshot(BTreeMap<PathBuf, (Option<SystemTime>, u64)>);

impl Snapshot {
    /// All files at and below some paths. What cannot be read is not there.
    pub(crate) fn of(paths: &[PathBuf]) -> Self {
        let entries = paths.iter().flat_map(WalkDir::new).filter_map(Result::ok);
        let files = entries.filter_map(|entry| {
            let about = entry.metadata().ok().filter(|about| about.is_file())?;
            Some((entry.into_path(), (about.modified().ok(), about.len())))
        });
        Self(files.collect())
    }

    /// Waits until the files are others than these and have come to rest: a library that is being
    /// linked is not yet one.
    pub(crate) fn wait_for_change(&self, paths: &[PathBuf], mut pause: impl FnMut()) {
        let mut last = Self::of(paths);
        loop {
            pause();
            let now = Self::of(paths);
            if now == last && now != *self {
                return;
            }
            last = now;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn new_longer_and_lost_files_are_changes() {
        let folder = tempfile::tempdir().unwrap();
        let paths = [folder.path().to_owned()];
        let file = folder.path().join("deep").join("case.toml");
        let empty = Snapshot::of(&paths);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        assert_eq!(Snapshot::of(&paths), empty, "folders alone are nothing");
        fs::write(&file, "a").unwrap();
        let short = Snapshot::of(&paths);
        assert_ne!(short, empty);
        assert_eq!(Snapshot::of(&paths), short);
        fs::write(&file, "ab").unwrap();
        assert_ne!(Snapshot::of(&paths), short);
        fs::remove_file(&file).unwrap();
        assert_eq!(Snapshot::of(&paths), empty);
    }

    #[test]
    fn waiting_ends_when_the_writer_has() {
        let folder = tempfile::tempdir().unwrap();
        let paths = [folder.path().to_owned()];
        let file = folder.path().join("core.so");
        let before = Snapshot::of(&paths);
        let mut pauses = 0;
        before.wait_for_change(&paths, || {
            pauses += 1;
            // Nothing happens, then the file grows for three looks.
            if (3..6).contains(&pauses) {
                fs::write(&file, "x".repeat(pauses)).unwrap();
            }
        });
        assert_eq!(pauses, 6);
    }

    #[test]
    fn what_changed_while_nobody_looked_counts() {
        let folder = tempfile::tempdir().unwrap();
        let paths = [folder.path().to_owned()];
        let before = Snapshot::of(&paths);
        fs::write(folder.path().join("case.toml"), "a").unwrap();
        let mut pauses = 0;
        before.wait_for_change(&paths, || pauses += 1);
        assert_eq!(pauses, 1);
    }
}
