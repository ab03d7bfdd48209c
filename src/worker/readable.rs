//! What a sandboxed core may read: itself, and the system's libraries, but nothing that is hidden from it.

use super::spec::{CoreOrigin, WorkerSpec};
use std::path::{Path, PathBuf};

/// Folders of the system that any program may need. Of `/etc` and `/proc` only what says something about the machine.
const SYSTEM: &str = "/usr /bin /sbin /lib /lib32 /lib64 /opt /nix/store /gnu/store /etc/alternatives \
    /etc/ld.so.cache /etc/ld.so.conf /etc/ld.so.conf.d /etc/ld.so.preload /etc/localtime \
    /etc/nsswitch.conf /etc/passwd /etc/group /proc/self /proc/cpuinfo /proc/meminfo \
    /proc/stat /proc/filesystems /proc/sys/vm /sys/devices/system /sys/fs/cgroup /dev/null \
    /dev/zero /dev/random /dev/urandom";

/// Variables with folders in which the user keeps libraries.
const LIBRARY_VARIABLES: &[&str] = &["LD_LIBRARY_PATH", "PYTHONPATH", "VIRTUAL_ENV"];

/// What the core may read: files, and folders with all that is in them.
pub(crate) fn readable(worker: &WorkerSpec) -> Vec<PathBuf> {
    let hidden = &worker.hidden;
    let mut paths: Vec<_> = SYSTEM
        .split_whitespace()
        .flat_map(|path| without_hidden(Path::new(path), hidden))
        .collect();
    let folders = LIBRARY_VARIABLES.iter().filter_map(std::env::var_os);
    let folders: Vec<_> = folders.flat_map(|value| split_paths(&value)).collect();
    paths.extend(folders.iter().flat_map(|path| without_hidden(path, hidden)));
    paths.extend(worker.readable.iter().flat_map(|path| without_hidden(path, hidden)));
    match &worker.origin {
        CoreOrigin::BuiltIn => {}
        CoreOrigin::Library(library) => paths.extend(with_folder(library, hidden)),
        CoreOrigin::Program(words) => paths.extend(of_program(words, hidden)),
        CoreOrigin::Renderer { adapter, words } => {
            paths.extend(with_folder(adapter, hidden));
            paths.extend(of_program(words, hidden));
        }
    }
    paths.retain(|path| path.exists());
    paths.dedup();
    paths
}

/// Folders of the core's own files in which something hidden lies. What is in them may be listed, for Python looks modules up
/// by listing; of what is hidden that tells no more than names.
pub(crate) fn listable(origin: &CoreOrigin, hidden: &[PathBuf]) -> Vec<PathBuf> {
    let own: Vec<&Path> = match origin {
        CoreOrigin::BuiltIn => Vec::new(),
        CoreOrigin::Library(library) => vec![library],
        CoreOrigin::Program(words) => named(words).collect(),
        CoreOrigin::Renderer { adapter, words } => {
            named(words).chain([adapter.as_path()]).collect()
        }
    };
    let folders = own.into_iter().filter_map(folder_of);
    let is_shared = |folder: &&Path| !is_within(folder, hidden) && !is_harmless(folder, hidden);
    folders.filter(is_shared).map(Path::to_owned).collect()
}

/// Files and folders among the words of a command.
fn named(words: &[String]) -> impl Iterator<Item = &Path> {
    words.iter().skip(1).map(Path::new).filter(|path| path.is_absolute())
}

/// Where a file lies, unless that is everywhere.
fn folder_of(file: &Path) -> Option<&Path> {
    let folder = if file.is_dir() { Some(file) } else { file.parent() };
    folder.filter(|folder| *folder != Path::new("/"))
}

fn split_paths(value: &std::ffi::OsStr) -> Vec<PathBuf> {
    std::env::split_paths(value).filter(|path| path.is_absolute()).collect()
}

/// What a command needs: the program and where it is installed, as any other that it starts (`env X=1 prefix/bin/python3`),
/// and every file among its words with the folder it lies in.
fn of_program(words: &[String], hidden: &[PathBuf]) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    let is_program = |path: &&Path| path.parent().is_some_and(|folder| folder.ends_with("bin"));
    let others = named(words).filter(is_program).map(Path::to_owned);
    for program in words.first().map(PathBuf::from).into_iter().chain(others) {
        let real = program.canonicalize().unwrap_or_else(|_| program.clone());
        for program in [program, real] {
            paths.extend(with_folder(&program, hidden));
            // `prefix/bin/python3` comes with `prefix/lib`.
            let prefix = program.parent().and_then(Path::parent);
            paths.extend(prefix.filter(|p| is_harmless(p, hidden)).map(Path::to_owned));
        }
    }
    paths.extend(named(words).flat_map(|path| with_folder(path, hidden)));
    paths
}

/// A file and what lies beside it, but for what is hidden: people run where their core lies, and reports come to lie there.
fn with_folder(file: &Path, hidden: &[PathBuf]) -> Vec<PathBuf> {
    let beside = folder_of(file).into_iter().flat_map(|folder| beside(folder, hidden));
    let file = (!is_within(file, hidden) && file.is_file()).then(|| file.to_owned());
    file.into_iter().chain(beside).collect()
}

/// A folder; where something hidden lies in it, all but that and what begins with a dot: a repository keeps copies.
fn beside(folder: &Path, hidden: &[PathBuf]) -> Vec<PathBuf> {
    let mut open = without_hidden(folder, hidden);
    if !is_harmless(folder, hidden) {
        let is_dotted = |name: &std::ffi::OsStr| name.to_string_lossy().starts_with('.');
        open.retain(|path| !path.file_name().is_some_and(is_dotted));
    }
    open
}

/// Whether nothing that is hidden lies in a folder, nor the folder in it.
fn is_harmless(folder: &Path, hidden: &[PathBuf]) -> bool {
    folder != Path::new("/")
        && !is_within(folder, hidden)
        && !hidden.iter().any(|secret| secret.starts_with(folder))
}

fn is_within(path: &Path, hidden: &[PathBuf]) -> bool {
    hidden.iter().any(|secret| path.starts_with(secret))
}

/// A path; where something hidden lies below it, all that is in it but that.
fn without_hidden(path: &Path, hidden: &[PathBuf]) -> Vec<PathBuf> {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if is_within(&real, hidden) {
        return Vec::new();
    }
    if !hidden.iter().any(|secret| secret.starts_with(&real)) {
        return vec![real];
    }
    let inside = std::fs::read_dir(&real).into_iter().flatten().flatten();
    inside.flat_map(|entry| without_hidden(&entry.path(), hidden)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// `project/cases/a.toml`, `project/core.so`, `project/build/core.so`
    fn project() -> (tempfile::TempDir, PathBuf, Vec<PathBuf>) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap().join("project");
        for file in ["cases/a.toml", "core.so", "build/core.so"] {
            let file = root.join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, "").unwrap();
        }
        let hidden = vec![root.join("cases")];
        (folder, root, hidden)
    }

    #[test]
    fn a_core_is_read_with_what_lies_beside_it() {
        let (_folder, root, hidden) = project();
        let core = root.join("build/core.so");
        assert_eq!(with_folder(&core, &hidden), [core, root.join("build")]);
    }

    #[test]
    fn a_core_beside_the_cases_is_read_with_all_that_lies_there_but_them() {
        let (_folder, root, hidden) = project();
        fs::create_dir(root.join(".git")).unwrap();
        let core = root.join("core.so");
        let mut open = with_folder(&core, &hidden);
        open.sort();
        assert_eq!(open, [root.join("build"), core.clone(), core]);
        assert!(with_folder(&root.join("cases/a.toml"), &hidden).is_empty());
    }

    #[test]
    fn a_folder_that_holds_what_is_hidden_is_listed() {
        let (_folder, root, hidden) = project();
        let of = |library: &str| listable(&CoreOrigin::Library(root.join(library)), &hidden);
        assert_eq!(of("core.so"), std::slice::from_ref(&root));
        assert!(of("build/core.so").is_empty(), "it is read as a whole");
        assert!(of("cases/core.so").is_empty());
    }

    #[test]
    fn a_folder_of_the_system_is_read_but_for_what_is_hidden_in_it() {
        let (folder, root, hidden) = project();
        let mut open = without_hidden(folder.path(), &hidden);
        open.sort();
        assert_eq!(open, [root.join("build"), root.join("core.so")]);
    }

    #[test]
    fn a_program_is_read_with_where_it_is_installed() {
        let (_folder, root, hidden) = project();
        let words = [root.join("build/core.so").to_string_lossy().into_owned()];
        let paths = of_program(&words, &hidden);
        assert!(paths.contains(&root.join("build")));
        assert!(!paths.contains(&root), "the prefix holds the cases");
    }
}
