//! What a student has handed in: a library, or a folder that the suite's commands make one of.

use super::suite::{Build, Suite};
use crate::project::Project;
use crate::text::hexadecimal;
use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use walkdir::WalkDir;

/// What shared libraries end in.
const ENDINGS: [&str; 3] = ["so", "dylib", "dll"];
/// Lines of a failed build that are told.
const LINES: usize = 30;
/// Written when a build has come to its end.
const DONE: &str = "furnace-built";

/// One of a class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Submission {
    /// Its file's or folder's.
    pub(crate) name: String,
    path: PathBuf,
    /// SHA-256 of all that is in it, hex.
    content: String,
}

impl Submission {
    /// Everything in `folder`: each library and each folder is one. What begins with a dot is none.
    pub(crate) fn all(folder: &Path) -> io::Result<Vec<Self>> {
        let mut found = Vec::new();
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if !name.starts_with('.') && (path.is_dir() || is_library(&path)) {
                // Where it lies may be given relative to where one stands; a build stands elsewhere.
                let path = path.canonicalize()?;
                found.push(Self { name, content: content(&path)?, path });
            }
        }
        found.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(found)
    }

    /// What its result is known by: the same content under the same `conditions` has the same.
    pub(crate) fn key(&self, conditions: &str) -> String {
        hexadecimal(Sha256::new().chain_update(&self.content).chain_update(conditions))
    }

    /// The core: the library that it is, contains, or is built into in `folder`.
    ///
    /// # Errors
    /// In words for its author: it is empty, or does not compile.
    pub(crate) fn core(
        &self,
        project: &Project,
        suite: &Suite,
        folder: &Path,
    ) -> Result<PathBuf, String> {
        if is_library(&self.path) {
            return Ok(self.path.clone());
        }
        if let Some(core) = library_in(&self.path, None) {
            return Ok(core);
        }
        if WalkDir::new(&self.path).into_iter().flatten().all(|it| !it.file_type().is_file()) {
            return Err("the submission is empty".to_owned());
        }
        match &suite.build {
            Some(build) => self.built(project, build, folder),
            None => {
                Err("there is no library in it, and the suite does not say how to build one".into())
            }
        }
    }

    fn built(&self, project: &Project, build: &Build, folder: &Path) -> Result<PathBuf, String> {
        let failed = |error: io::Error| format!("cannot build in {}: {error}", folder.display());
        if !folder.join(DONE).is_file() {
            // Half of a build that was cut off is worth nothing.
            if folder.exists() {
                std::fs::remove_dir_all(folder).map_err(failed)?;
            }
            std::fs::create_dir_all(folder).map_err(failed)?;
            for command in &build.commands {
                self.carry_out(command, &project.of_the_bench(""), folder)?;
            }
            std::fs::write(folder.join(DONE), "").map_err(failed)?;
        }
        let missing = || format!("its build made no `{}.{}`", build.makes, ENDINGS[0]);
        library_in(folder, Some(&build.makes)).ok_or_else(missing)
    }

    fn carry_out(&self, command: &[String], bench: &Path, folder: &Path) -> Result<(), String> {
        let places =
            [("{submission}", self.path.as_path()), ("{build}", folder), ("{bench}", bench)];
        let filled = command.iter().map(|word| {
            places.iter().fold(word.clone(), |word, (mark, path)| {
                word.replace(mark, path.to_string_lossy().trim_end_matches('/'))
            })
        });
        let mut words = filled;
        let program = words.next().unwrap_or_default();
        let mut process = Command::new(&program);
        process.args(words).current_dir(folder).stdin(Stdio::null());
        let output =
            process.output().map_err(|error| format!("cannot run `{program}`: {error}"))?;
        if output.status.success() {
            return Ok(());
        }
        let told = [output.stdout, output.stderr].concat();
        let told = String::from_utf8_lossy(&told).replace(&*self.path.to_string_lossy(), "");
        let lines: Vec<_> = told.lines().collect();
        let end = &lines[lines.len().saturating_sub(LINES)..];
        Err(format!("it does not compile: `{program}` says\n{}", end.join("\n")))
    }
}

fn is_library(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|ending| ENDINGS.iter().any(|it| ending == *it))
}

/// The only library of a folder, or the one of this name.
fn library_in(folder: &Path, name: Option<&str>) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    let is_meant =
        |path: &PathBuf| name.is_none_or(|name| path.file_stem().is_some_and(|s| s == name));
    let mut found = entries.filter(|path| is_library(path) && is_meant(path));
    let first = found.next()?;
    found.next().is_none().then_some(first)
}

fn content(path: &Path) -> io::Result<String> {
    let mut digest = Sha256::new();
    for entry in WalkDir::new(path).sort_by_file_name() {
        let entry = entry?;
        if entry.file_type().is_file() {
            let bytes = std::fs::read(entry.path())?;
            let inside = entry.path().strip_prefix(path).unwrap_or(path).to_string_lossy();
            digest.update(format!("{inside} {}\n", bytes.len()));
            digest.update(bytes);
        }
    }
    Ok(hexadecimal(digest))
}
