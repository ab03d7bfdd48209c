//! How much of the disk a worker has taken: its folder, and what is open though no folder has it any more.

use std::collections::BTreeMap;
use std::fs::Metadata;
use std::path::Path;

/// The least that an entry of a folder is counted as: many empty files are no gift either.
const BLOCK: u64 = 4096;

/// Each file once, however many names and descriptors it has.
type Files = BTreeMap<(u64, u64), u64>;

/// Bytes of all files below `folder`, and of those that `processes` hold open without a name.
pub(crate) fn written(folder: &Path, processes: &[u32]) -> u64 {
    let mut files = Files::new();
    for entry in walkdir::WalkDir::new(folder).min_depth(1).into_iter().flatten() {
        // What is gone by now takes up nothing.
        if let Ok(about) = entry.metadata() {
            files.insert(identity(&about, files.len()), size(&about).max(BLOCK));
        }
    }
    for process in processes {
        add_nameless(*process, &mut files);
    }
    files.values().sum()
}

/// Only here is it known which files of a process have no name any more.
#[cfg(target_os = "linux")]
fn add_nameless(process: u32, files: &mut Files) {
    use std::os::unix::fs::MetadataExt;
    let open = std::fs::read_dir(format!("/proc/{process}/fd")).into_iter().flatten().flatten();
    let abouts = open.filter_map(|entry| std::fs::metadata(entry.path()).ok());
    for about in abouts.filter(|about| about.is_file() && about.nlink() == 0) {
        files.insert(identity(&about, files.len()), size(&about));
    }
}

#[cfg(not(target_os = "linux"))]
fn add_nameless(_: u32, _: &mut Files) {}

#[cfg(unix)]
fn identity(about: &Metadata, _: usize) -> (u64, u64) {
    use std::os::unix::fs::MetadataExt;
    (about.dev(), about.ino())
}

#[cfg(not(unix))]
fn identity(_: &Metadata, number: usize) -> (u64, u64) {
    (0, number as u64)
}

/// What is really taken up: a hole in a file is not.
#[cfg(unix)]
fn size(about: &Metadata) -> u64 {
    use std::os::unix::fs::MetadataExt;
    about.blocks() * 512
}

#[cfg(not(unix))]
fn size(about: &Metadata) -> u64 {
    about.len()
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use super::*;
    use std::fs::{self, File};
    use std::io::Write;

    const MIB: u64 = 1 << 20;

    /// A folder with a file of 1 MiB in it.
    fn folder() -> (tempfile::TempDir, File) {
        let folder = tempfile::tempdir().unwrap();
        let mut file = File::create(folder.path().join("a")).unwrap();
        file.write_all(&vec![1; MIB as usize]).unwrap();
        (folder, file)
    }

    #[test]
    fn a_file_counts_once_whatever_its_names() {
        let (folder, _file) = folder();
        let before = written(folder.path(), &[]);
        fs::hard_link(folder.path().join("a"), folder.path().join("b")).unwrap();
        assert!(before >= MIB);
        assert_eq!(written(folder.path(), &[]), before);
    }

    #[test]
    fn a_file_without_a_name_counts_as_long_as_it_is_open() {
        let (folder, file) = folder();
        fs::remove_file(folder.path().join("a")).unwrap();
        let mut files = Files::new();
        add_nameless(std::process::id(), &mut files);
        let about = file.metadata().unwrap();
        assert!(files[&identity(&about, 0)] >= MIB);
        assert_eq!(written(folder.path(), &[]), 0);
    }

    #[test]
    fn empty_files_take_up_space_too() {
        let folder = tempfile::tempdir().unwrap();
        (0..10).for_each(|number| drop(File::create(folder.path().join(number.to_string()))));
        assert_eq!(written(folder.path(), &[]), 10 * BLOCK);
    }
}
