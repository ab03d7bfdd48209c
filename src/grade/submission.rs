//! What a student has handed in: a library, or a folder that the suite's commands make one of.

use super::SALT_VARIABLE;
use super::suite::{Build, Suite};
use crate::cores::command::found;
use crate::cores::command::process::{self, Ended, Group};
use crate::project::Project;
use crate::text::hexadecimal;
use crate::text::number::duration;
use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use walkdir::WalkDir;

/// What shared libraries end in.
const ENDINGS: [&str; 3] = ["so", "dylib", "dll"];
/// Lines of a failed build that are told.
const LINES: usize = 30;
/// Written when a build has come to its end.
const DONE: &str = "furnace-built";

/// Who builds submissions, and with whose files.
pub(crate) struct Workshop<'a> {
    pub(crate) project: &'a Project,
    pub(crate) suite: &'a Suite,
    /// The user that runs the commands, where that is another; only the superuser may say so.
    pub(crate) user: Option<&'a str>,
}

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
                found.push(Self { name, ..Self::at(&path)? });
            }
        }
        found.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(found)
    }

    /// The library or the folder at a path.
    pub(crate) fn at(path: &Path) -> io::Result<Self> {
        let path = path.canonicalize()?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, content: content(&path)?, path })
    }

    /// What its result is known by: the same content under the same `conditions` has the same.
    pub(crate) fn key(&self, conditions: &str) -> String {
        hexadecimal(Sha256::new().chain_update(&self.content).chain_update(conditions))
    }

    /// The core: the library that it is, contains, or is built into in `folder`.
    ///
    /// # Errors
    /// In words for its author: it is empty, or does not compile.
    pub(crate) fn core(&self, workshop: &Workshop<'_>, folder: &Path) -> Result<PathBuf, String> {
        if is_library(&self.path) {
            return Ok(self.path.clone());
        }
        if let Some(core) = library_in(&self.path, None) {
            return Ok(core);
        }
        if WalkDir::new(&self.path).into_iter().flatten().all(|it| !it.file_type().is_file()) {
            return Err("the submission is empty".to_owned());
        }
        match &workshop.suite.build {
            Some(build) => self.built(workshop, build, folder),
            None => {
                Err("there is no library in it, and the suite does not say how to build one".into())
            }
        }
    }

    fn built(
        &self,
        workshop: &Workshop<'_>,
        build: &Build,
        folder: &Path,
    ) -> Result<PathBuf, String> {
        let failed = |error: io::Error| format!("cannot build in {}: {error}", folder.display());
        if !folder.join(DONE).is_file() {
            // Half of a build that was cut off is worth nothing.
            if folder.exists() {
                std::fs::remove_dir_all(folder).map_err(failed)?;
            }
            std::fs::create_dir_all(folder).map_err(failed)?;
            if let Some(user) = workshop.user {
                give(folder, user)?;
            }
            for command in &build.commands {
                let words = self.filled(command, &workshop.project.of_the_bench(""), folder);
                self.carry_out(&by(workshop.user, words), build, folder)?;
            }
            std::fs::write(folder.join(DONE), "").map_err(failed)?;
        }
        let missing = || format!("its build made no `{}.{}`", build.makes, ENDINGS[0]);
        library_in(folder, Some(&build.makes)).ok_or_else(missing)
    }

    /// A command with the folders in the places of their names.
    fn filled(&self, command: &[String], bench: &Path, folder: &Path) -> Vec<String> {
        let places =
            [("{submission}", self.path.as_path()), ("{build}", folder), ("{bench}", bench)];
        let filled = command.iter().map(|word| {
            places.iter().fold(word.clone(), |word, (mark, path)| {
                word.replace(mark, path.to_string_lossy().trim_end_matches('/'))
            })
        });
        filled.collect()
    }

    fn carry_out(&self, words: &[String], build: &Build, folder: &Path) -> Result<(), String> {
        let Some((program, arguments)) = words.split_first() else { return Ok(()) };
        let mut command = Command::new(program);
        // Who builds runs what was handed in: the salt is not for it to know.
        command.args(arguments).envs(cached()).env_remove(SALT_VARIABLE);
        let ran = process::run(&mut command, folder, build.time, Group::Own);
        let (ended, said) = ran.map_err(|error| format!("cannot run `{program}`: {error}"))?;
        let status = match ended {
            Ended::Exited(status) => status,
            Ended::OutOfTime => {
                let limit = duration(build.time.as_secs_f64());
                return Err(format!("it does not compile in time: `{program}` took over {limit}"));
            }
        };
        if status.success() {
            return Ok(());
        }
        let told = said.all().replace(&*self.path.to_string_lossy(), "");
        let lines: Vec<_> = told.lines().collect();
        let end = &lines[lines.len().saturating_sub(LINES)..];
        Err(format!("it does not compile: `{program}` says\n{}", end.join("\n")))
    }
}

/// Makes a folder this user's.
fn give(folder: &Path, user: &str) -> Result<(), String> {
    let failed = |how: &dyn std::fmt::Display| {
        format!("cannot give the build to `{user}`: {how}; only the superuser can")
    };
    let status = Command::new("chown").arg(user).arg(folder).status();
    match status.map_err(|error| failed(&error))? {
        status if status.success() => Ok(()),
        status => Err(failed(&status)),
    }
}

/// A command as this user runs it.
fn by(user: Option<&str>, words: Vec<String>) -> Vec<String> {
    let Some(user) = user else { return words };
    ["runuser", "-u", user, "--"].map(str::to_owned).into_iter().chain(words).collect()
}

/// What makes CMake compile through ccache, where there is one: much of a class is the course's own code.
fn cached() -> impl Iterator<Item = (&'static str, &'static str)> {
    let launchers = ["CMAKE_C_COMPILER_LAUNCHER", "CMAKE_CXX_COMPILER_LAUNCHER"];
    let is_there = found("ccache").is_some();
    let is_wanted = move |name: &&str| is_there && std::env::var_os(name).is_none();
    launchers.into_iter().filter(is_wanted).map(|name| (name, "ccache"))
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
