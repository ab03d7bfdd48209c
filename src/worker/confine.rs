//! What a worker may reach, decided for every system; how it is enforced is the system's business.
//!
//! A core may read itself and the system's libraries, write its scratch folder, and reach no
//! network; it can neither look up what is expected of it nor touch what is written about it. Where
//! a system cannot enforce that, the report says so.

use super::child::Errand;
#[cfg(target_os = "linux")]
use super::child::Guest;
use super::process::Limits;
use serde::{Deserialize, Serialize};
#[cfg(target_os = "linux")]
use std::path::{Path, PathBuf};

/// What holds of a worker, and what does not, one sentence each.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Confinement {
    /// What the system enforces.
    pub in_force: Vec<String>,
    /// What it cannot, or what the user has switched off.
    pub lacking: Vec<String>,
}

/// Folders of the system that any program may need. Of `/etc` and `/proc` only what says something
/// about the machine.
#[cfg(target_os = "linux")]
const SYSTEM: &[&str] = &[
    "/usr",
    "/bin",
    "/sbin",
    "/lib",
    "/lib32",
    "/lib64",
    "/opt",
    "/nix/store",
    "/gnu/store",
    "/etc/alternatives",
    "/etc/ld.so.cache",
    "/etc/ld.so.conf",
    "/etc/ld.so.conf.d",
    "/etc/ld.so.preload",
    "/etc/localtime",
    "/etc/nsswitch.conf",
    "/etc/passwd",
    "/etc/group",
    "/proc/self",
    "/proc/cpuinfo",
    "/proc/meminfo",
    "/proc/stat",
    "/proc/filesystems",
    "/proc/sys/vm",
    "/sys/devices/system",
    "/sys/fs/cgroup",
    "/dev/null",
    "/dev/zero",
    "/dev/random",
    "/dev/urandom",
];

/// Variables with folders in which the user keeps libraries.
#[cfg(target_os = "linux")]
const LIBRARY_VARIABLES: &[&str] = &["LD_LIBRARY_PATH", "PYTHONPATH", "VIRTUAL_ENV"];

/// Shuts this process in, as far as the system can.
pub(crate) fn confine(errand: &Errand) -> Confinement {
    let mut confinement = Confinement::default();
    limit(&errand.limits, &mut confinement);
    if errand.confined {
        shut_in(errand, &mut confinement);
    } else {
        let why = "files, network, processes: everything is open to it, as was asked for";
        confinement.lacking.push(why.to_owned());
    }
    confinement
}

#[cfg(target_os = "linux")]
use super::confine_linux::shut_in;

#[cfg(not(target_os = "linux"))]
fn shut_in(_: &Errand, confinement: &mut Confinement) {
    confinement.lacking.push(
        "files, network, processes: only on Linux can a worker be shut in; here the core could \
         read cases and references and change results"
            .to_owned(),
    );
}

#[cfg(unix)]
fn limit(limits: &Limits, confinement: &mut Confinement) {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let mut set = |resource, limit: Option<u64>, what: String| match setrlimit(
        resource,
        Rlimit { current: limit, maximum: limit },
    ) {
        Ok(()) => confinement.in_force.push(what),
        Err(error) => confinement.lacking.push(format!("{what}: {error}")),
    };
    if let Some(memory) = limits.memory {
        set(Resource::Data, Some(memory), format!("memory: {} a process", in_bytes(memory)));
        // Reserving is no using, so twice as much may be reserved.
        let reserved = memory.saturating_mul(2);
        set(Resource::As, Some(reserved), format!("address space: {}", in_bytes(reserved)));
    }
    set(Resource::Fsize, Some(limits.file), format!("files: {} each", in_bytes(limits.file)));
    set(Resource::Core, Some(0), "no core dumps".to_owned());
}

#[cfg(not(unix))]
fn limit(_: &Limits, confinement: &mut Confinement) {
    confinement.lacking.push("memory, files: this system has no limits for a process".to_owned());
}

/// `4 GiB`, `64 MiB`, `17 bytes`
#[cfg(unix)]
fn in_bytes(bytes: u64) -> String {
    match bytes {
        b if b >= 1 << 30 && b % (1 << 30) == 0 => format!("{} GiB", b >> 30),
        b if b >= 1 << 20 => format!("{} MiB", b >> 20),
        b => format!("{b} bytes"),
    }
}

/// What the core may read: files, and folders with all that is in them.
#[cfg(target_os = "linux")]
pub(crate) fn readable(errand: &Errand) -> Vec<PathBuf> {
    let hidden = &errand.hidden;
    let mut paths: Vec<_> =
        SYSTEM.iter().flat_map(|path| without_hidden(Path::new(path), hidden)).collect();
    let folders = LIBRARY_VARIABLES.iter().filter_map(std::env::var_os);
    let folders: Vec<_> = folders.flat_map(|value| split_paths(&value)).collect();
    paths.extend(folders.iter().flat_map(|path| without_hidden(path, hidden)));
    paths.extend(errand.readable.iter().flat_map(|path| without_hidden(path, hidden)));
    match &errand.guest {
        Guest::Resident => {}
        Guest::Library(library) => paths.extend(with_folder(library, hidden)),
        Guest::Program(words) => paths.extend(of_program(words, hidden)),
        Guest::Renderer { adapter, words } => {
            paths.extend(with_folder(adapter, hidden));
            paths.extend(of_program(words, hidden));
        }
    }
    paths.retain(|path| path.exists());
    paths.dedup();
    paths
}

#[cfg(target_os = "linux")]
fn split_paths(value: &std::ffi::OsStr) -> Vec<PathBuf> {
    std::env::split_paths(value).filter(|path| path.is_absolute()).collect()
}

/// What a command needs: the program and where it is installed, and every file among its words with
/// the folder it lies in.
#[cfg(target_os = "linux")]
fn of_program(words: &[String], hidden: &[PathBuf]) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    if let Some(program) = words.first().map(PathBuf::from) {
        let real = program.canonicalize().unwrap_or_else(|_| program.clone());
        for program in [program, real] {
            paths.extend(with_folder(&program, hidden));
            // `prefix/bin/python3` comes with `prefix/lib`.
            let prefix = program.parent().and_then(Path::parent);
            paths.extend(prefix.filter(|p| is_harmless(p, hidden)).map(Path::to_owned));
        }
    }
    let named = words.iter().skip(1).map(PathBuf::from).filter(|path| path.is_absolute());
    paths.extend(named.flat_map(|path| with_folder(&path, hidden)));
    paths
}

/// A file and what lies beside it; the file alone, if its folder holds what is hidden.
#[cfg(target_os = "linux")]
fn with_folder(file: &Path, hidden: &[PathBuf]) -> Vec<PathBuf> {
    let folder = if file.is_dir() { Some(file) } else { file.parent() };
    let folder = folder.filter(|folder| is_harmless(folder, hidden));
    let file = (!is_within(file, hidden) && file.is_file()).then_some(file);
    file.into_iter().chain(folder).map(Path::to_owned).collect()
}

/// Whether nothing that is hidden lies in a folder, nor the folder in it.
#[cfg(target_os = "linux")]
fn is_harmless(folder: &Path, hidden: &[PathBuf]) -> bool {
    folder != Path::new("/")
        && !is_within(folder, hidden)
        && !hidden.iter().any(|secret| secret.starts_with(folder))
}

#[cfg(target_os = "linux")]
fn is_within(path: &Path, hidden: &[PathBuf]) -> bool {
    hidden.iter().any(|secret| path.starts_with(secret))
}

/// A path; where something hidden lies below it, all that is in it but that.
#[cfg(target_os = "linux")]
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
#[cfg(target_os = "linux")]
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
    fn a_core_beside_the_cases_is_read_alone() {
        let (_folder, root, hidden) = project();
        assert_eq!(with_folder(&root.join("core.so"), &hidden), [root.join("core.so")]);
        assert!(with_folder(&root.join("cases/a.toml"), &hidden).is_empty());
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

    #[test]
    fn sizes_are_told_in_words() {
        assert_eq!(
            [in_bytes(4 << 30), in_bytes(1 << 26), in_bytes(17)],
            ["4 GiB", "64 MiB", "17 bytes"]
        );
    }
}
