//! Cores that somebody else has written, as they are named after `--core`: a shared library by its
//! path, a program by `exec:` and its command, one that makes pictures by its adapter's file.

use super::command::{Program, found};
use crate::worker::CoreOrigin;
use std::io::ErrorKind;
use std::path::Path;

/// What shared libraries are called.
const LIBRARIES: &[&str] = &["so", "dylib", "dll"];

/// What adapters' files are called.
const ADAPTER: &str = "toml";

/// How a program is named.
const PROGRAM: &str = "exec:";

/// The foreign core that a word names, if it names one at all.
///
/// # Errors
/// What is wrong with it, if there is no such library or program.
pub(crate) fn origin(word: &str) -> Option<Result<CoreOrigin, String>> {
    if let Some(command) = word.strip_prefix(PROGRAM) {
        return Some(program(command));
    }
    let path = Path::new(word);
    if path.extension()?.to_str()? == ADAPTER {
        return Some(renderer(path));
    }
    is_library(path).then(|| library(path))
}

/// `libmine.so`, and with a version, `libmine.so.2`.
fn is_library(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let mut endings = name.split('.').skip(1);
    endings.any(|ending| LIBRARIES.contains(&ending))
}

fn library(path: &Path) -> Result<CoreOrigin, String> {
    let library = path.canonicalize().map(CoreOrigin::Library);
    library.map_err(|error| no_file(path, &error))
}

/// What a file is not, and from where it was looked for.
fn no_file(path: &Path, error: &std::io::Error) -> String {
    if error.kind() != ErrorKind::NotFound {
        return format!("cannot read `{}`: {error}", path.display());
    }
    let here = std::env::current_dir().unwrap_or_default();
    let whole = here.join(path);
    format!("there is no file `{}`\nhint: looked for {}", path.display(), whole.display())
}

fn renderer(path: &Path) -> Result<CoreOrigin, String> {
    std::fs::metadata(path).map_err(|error| no_file(path, &error))?;
    let problem = |error| format!("`{}` is no adapter\n{error}", path.display());
    let program = Program::load(path).map_err(problem)?;
    let adapter = std::path::absolute(path).map_err(|error| error.to_string())?;
    Ok(CoreOrigin::Renderer { adapter, words: program.words() })
}

/// The words of a command; the program and files among them by their whole paths, since a worker
/// runs in a folder of its own.
fn program(command: &str) -> Result<CoreOrigin, String> {
    let words = shell_words::split(command).map_err(|error| error.to_string())?;
    let [program, arguments @ ..] = words.as_slice() else {
        return Err(format!("a command must follow `{PROGRAM}`, as in 'exec: python3 core.py'"));
    };
    let program = found(program).ok_or_else(|| {
        format!("there is no program `{program}`\nhint: it is neither here nor on the PATH")
    })?;
    let mut words = vec![program.to_string_lossy().into_owned()];
    words.extend(arguments.iter().map(|word| absolute(word)));
    Ok(CoreOrigin::Program(words))
}

fn absolute(word: &str) -> String {
    let path = Path::new(word);
    let absolute = path.exists().then(|| std::path::absolute(path).ok()).flatten();
    absolute.map_or_else(|| word.to_owned(), |path| path.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::env;

    #[test]
    fn names_of_our_own_are_nobody_elses() {
        assert_eq!(origin("builtin"), None);
        assert_eq!(origin("textbook:no-pi"), None);
    }

    #[test]
    fn a_library_is_named_by_its_whole_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("libcore.so");
        std::fs::write(&path, "").unwrap();
        let expected = CoreOrigin::Library(path.canonicalize().unwrap());
        assert_eq!(origin(&path.to_string_lossy()), Some(Ok(expected)));
        let message = origin("no/such/lib.so.2").unwrap().unwrap_err();
        assert!(message.starts_with("there is no file `no/such/lib.so.2`"), "{message}");
    }

    #[test]
    fn files_among_the_words_of_a_command_are_named_by_their_whole_paths() {
        let here = env::current_dir().unwrap();
        let program = env::current_exe().unwrap();
        let command = format!("exec: '{}' Cargo.toml --scale '2 3'", program.display());
        let words = [
            program.to_string_lossy().into_owned(),
            here.join("Cargo.toml").to_string_lossy().into_owned(),
            "--scale".to_owned(),
            "2 3".to_owned(),
        ];
        assert_eq!(origin(&command), Some(Ok(CoreOrigin::Program(words.to_vec()))));
    }

    #[test]
    fn a_program_that_is_nowhere_is_said_so() {
        let complaint = origin("exec: no-such-program --fast").unwrap().unwrap_err();
        assert!(complaint.contains("there is no program `no-such-program`"), "{complaint}");
        assert!(origin("exec:").unwrap().unwrap_err().contains("a command must follow"));
    }
}
