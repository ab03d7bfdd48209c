//! Python with Mitsuba in it: found, or installed where the user says so; and the back end that works here.

use super::mitsuba::{Job, Mitsuba, Variant};
use super::{Listener, MakeError, Progress};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The oldest LLVM that Mitsuba 3.9.1 generates code with. 14 is refused; 15 and 16 abort the
/// process, for they have no instruction for the minimum of two numbers (llvm-project issue 53353).
const OLDEST_LLVM: u32 = 17;

/// Where LLVM libraries are kept, by distribution.
const LLVM_FOLDERS: [&str; 7] = [
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib64",
    "/usr/lib",
    "/usr/local/lib",
    "/opt/homebrew/opt/llvm/lib",
    "/usr/local/opt/llvm/lib",
];

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct MitsubaOptions {
    /// Install it into `references/.venv` if it is not there.
    pub(crate) create_environment: bool,
    /// Its back end, instead of the fastest that works.
    pub(crate) variant: Option<String>,
}

/// The Python of the references' own environment. Installs one if `create`.
fn python(references: &Path, create: bool, progress: Listener<'_>) -> Result<PathBuf, MakeError> {
    let folder = references.join(".venv");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if python.is_file() && run(Command::new(&python).args(["-c", "import mitsuba"])).is_ok() {
        return Ok(python);
    }
    let requirements = references.join("requirements.txt");
    if !create {
        let text = std::fs::read_to_string(&requirements).map_err(MakeError::at(&requirements))?;
        let requirements = text.split_whitespace().collect::<Vec<_>>().join(" and ");
        return Err(MakeError::NoEnvironment { folder, requirements });
    }
    progress(Progress::CreatingEnvironment { folder: folder.clone() });
    run(Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
    let install = ["-m", "pip", "install", "--quiet", "--requirement"];
    run(Command::new(&python).args(install).arg(&requirements))?;
    Ok(python)
}

/// Mitsuba from the environment of the folder of references, with a back end that renders `job`
/// here: the fastest that does, or the one asked for.
pub(super) fn mitsuba(
    references: &Path,
    options: &MitsubaOptions,
    job: &Job,
    progress: Listener<'_>,
) -> Result<Mitsuba, MakeError> {
    let python = python(references, options.create_environment, progress)?;
    let mut failure = None;
    for variant in candidates(options.variant.as_deref()) {
        progress(Progress::TryingVariant { variant: variant.to_string() });
        let mut mitsuba = Mitsuba { python: python.clone(), variant, version: String::new() };
        // In a process of its own: an LLVM that is too old aborts.
        match mitsuba.probe(job) {
            Ok(()) => return Ok(mitsuba),
            Err(error) => failure = Some(error),
        }
    }
    Err(failure.unwrap_or_else(|| MakeError::Options("no variant of Mitsuba to try".to_owned())))
}

/// What to try, in order.
fn candidates(asked: Option<&str>) -> Vec<Variant> {
    let scalar = Variant { name: "scalar_rgb".to_owned(), llvm: None };
    let with_llvm = |name: &str| {
        let name = name.to_owned();
        let chosen_by_user = std::env::var_os("DRJIT_LIBLLVM_PATH").map(PathBuf::from);
        let libraries = chosen_by_user.map_or_else(llvm_libraries, |library| vec![library]);
        libraries.into_iter().map(move |llvm| Variant { name: name.clone(), llvm: Some(llvm) })
    };
    match asked {
        Some(name) if name.starts_with("llvm") => with_llvm(name).collect(),
        Some(name) => vec![Variant { name: name.to_owned(), llvm: None }],
        None => with_llvm("llvm_ad_rgb").chain([scalar]).collect(),
    }
}

/// The LLVM libraries that are recent enough, newest first, one of each version.
fn llvm_libraries() -> Vec<PathBuf> {
    let files = LLVM_FOLDERS.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten();
    let mut found: Vec<(u32, PathBuf)> = files
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let version = llvm_version(path.file_name()?.to_str()?)?;
            (version >= OLDEST_LLVM).then_some((version, path))
        })
        .collect();
    found.sort_unstable_by(|a, b| b.cmp(a));
    found.dedup_by_key(|(version, _)| *version);
    found.into_iter().map(|(_, path)| path).collect()
}

/// The version of a library called `libLLVM.so.19.1`, `libLLVM-17.so.1` or `libLLVM.19.dylib`.
fn llvm_version(file: &str) -> Option<u32> {
    let rest = file.strip_prefix("libLLVM")?;
    let is_library = rest.contains(".so") || rest.ends_with(".dylib");
    let number = rest.split(|c: char| !c.is_ascii_digit()).find(|part| !part.is_empty())?;
    if is_library { number.parse().ok() } else { None }
}

fn run(command: &mut Command) -> Result<Output, MakeError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|problem| MakeError::Program {
        program: program.clone(),
        how: "it failed to start".to_owned(),
        last_words: problem.to_string(),
    })?;
    if output.status.success() {
        return Ok(output);
    }
    let last_words = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(MakeError::Program { program, how: output.status.to_string(), last_words })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_llvm_are_read_off_the_names_of_its_libraries() {
        assert_eq!(llvm_version("libLLVM.so.19.1"), Some(19));
        assert_eq!(llvm_version("libLLVM-17.so.1"), Some(17));
        assert_eq!(llvm_version("libLLVM-14.0.6.so.1"), Some(14));
        assert_eq!(llvm_version("libLLVM.dylib"), None);
        assert_eq!(llvm_version("libLLVM-19.a"), None);
        assert_eq!(llvm_version("libLTO.so.19"), None);
    }

    #[test]
    fn what_is_asked_for_is_what_is_tried() {
        let names = |asked| candidates(asked).into_iter().map(|variant| variant.name);
        assert_eq!(names(Some("scalar_rgb")).collect::<Vec<_>>(), ["scalar_rgb"]);
        assert_eq!(names(None).next_back().as_deref(), Some("scalar_rgb"));
    }

    #[test]
    fn without_an_environment_the_flag_that_makes_one_is_named() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("requirements.txt"), "mitsuba==3.9.1\nnumpy\n").unwrap();
        let message = python(folder.path(), false, &mut |_| ()).unwrap_err().to_string();
        assert!(message.contains("`--create-venv` installs mitsuba==3.9.1 and numpy"), "{message}");
    }

    #[test]
    fn a_failing_program_is_read_to_the_end() {
        let mut failing = Command::new("sh");
        let error = run(failing.args(["-c", "echo too bad >&2; exit 3"])).unwrap_err().to_string();
        assert!(error.contains("sh failed (exit status: 3)"), "{error}");
        assert!(error.contains("too bad"), "{error}");
    }
}
