//! What a student has handed in: a library, a crate that Cargo makes one of, or a folder that the suite's commands do.

use super::SALT_VARIABLE;
use super::suite::{Build, Suite};
use super::warning::{Warning, warnings};
use crate::cores::command::found;
use crate::cores::command::process::{self, Ended, Group};
use crate::project::Project;
use crate::run::record::{read_json, write_json};
use crate::text::hexadecimal;
use crate::text::number::duration;
use sha2::{Digest, Sha256};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use walkdir::WalkDir;

/// What shared libraries end in.
const ENDINGS: [&str; 3] = ["so", "dylib", "dll"];
/// Lines of a failed build that are told.
const LINES: usize = 30;
/// A folder with this file is a crate.
const MANIFEST: &str = "Cargo.toml";
/// Where Cargo works, below the folder of a build.
const TARGET: &str = "target";
/// Written when a build has come to its end: what the compiler warned of.
const DONE: &str = "furnace-built.json";

/// Who builds submissions, and with whose files.
pub(crate) struct Workshop<'a> {
    pub(crate) project: &'a Project,
    pub(crate) suite: &'a Suite,
    /// The user that runs the commands, where that is another; only the superuser may say so.
    pub(crate) user: Option<&'a str>,
}

/// Why a submission has no core.
#[derive(Debug)]
pub(crate) enum NoCore {
    /// In words for its author.
    Authors(String),
    /// Not its author's doing: it may be tried again.
    Machines(String),
}

impl fmt::Display for NoCore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Authors(why) | Self::Machines(why)) = self;
        f.write_str(why)
    }
}

/// What a submission has become.
#[derive(Debug)]
pub(crate) struct Built {
    /// The library.
    pub(crate) core: PathBuf,
    /// None where there was nothing to compile. Of a crate none are read: what they are for, Rust refuses.
    pub(crate) warnings: Vec<Warning>,
}

impl From<PathBuf> for Built {
    fn from(core: PathBuf) -> Self {
        Self { core, warnings: Vec::new() }
    }
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
    /// If it is empty, or does not compile.
    pub(crate) fn core(&self, workshop: &Workshop<'_>, folder: &Path) -> Result<Built, NoCore> {
        if is_library(&self.path) {
            return Ok(self.path.clone().into());
        }
        if let Some(core) = library_in(&self.path, None) {
            return Ok(core.into());
        }
        if WalkDir::new(&self.path).into_iter().flatten().all(|it| !it.file_type().is_file()) {
            return Err(NoCore::Authors("the submission is empty".to_owned()));
        }
        if self.path.join(MANIFEST).is_file() {
            return self.built_by_cargo(workshop, folder).map(Built::from);
        }
        let Some(build) = &workshop.suite.build else {
            let nothing = "there is no library in it, and the suite does not say how to build one";
            return Err(NoCore::Authors(nothing.to_owned()));
        };
        let warnings = match read_json(&folder.join(DONE)) {
            Ok(warnings) => warnings,
            Err(_) => self.built_by(build, workshop, folder)?,
        };
        let missing = || format!("its build made no `{}.{}`", build.makes, ENDINGS[0]);
        let core = library_in(folder, Some(&build.makes));
        let core = core.ok_or_else(|| NoCore::Authors(missing()))?;
        Ok(Built { core, warnings })
    }

    /// Carries out the suite's commands from the first on: half of a build that was cut off is worth nothing.
    fn built_by(
        &self,
        build: &Build,
        workshop: &Workshop<'_>,
        folder: &Path,
    ) -> Result<Vec<Warning>, NoCore> {
        if folder.exists() {
            std::fs::remove_dir_all(folder).map_err(cannot_build(folder))?;
        }
        let said = self.carry_out_all(&build.commands, build.time, workshop, folder)?;
        let warnings = warnings(&said, &self.path);
        write_json(&folder.join(DONE), &warnings).map_err(cannot_build(folder))?;
        Ok(warnings)
    }

    /// Of all that Cargo makes, hundreds of megabytes, the library is kept.
    fn built_by_cargo(&self, workshop: &Workshop<'_>, folder: &Path) -> Result<PathBuf, NoCore> {
        if folder.join(DONE).is_file()
            && let Some(known) = library_in(folder, None)
        {
            return Ok(known);
        }
        // After a build that was cut off, Cargo knows which half is whole.
        let time = workshop.suite.build.as_ref().map_or(Build::TIME, |build| build.time);
        self.copy_crate(time, workshop, folder)?;
        self.carry_out_all(&[build_of_a_crate()], time, workshop, folder)?;
        let made = library_in(&folder.join(TARGET).join("release"), None);
        let made = made.ok_or_else(|| NoCore::Authors(NO_LIBRARY.to_owned()))?;
        let kept = folder.join(made.file_name().unwrap_or_default());
        std::fs::copy(&made, &kept)
            .and_then(|_| std::fs::write(folder.join(DONE), "[]"))
            .and_then(|()| std::fs::remove_dir_all(folder.join(TARGET)))
            .map_err(cannot_build(folder))?;
        Ok(kept)
    }

    /// Cargo builds a copy, since it writes beside the manifest. Another user makes it itself: the bench may read more
    /// than that user does, and there is `cp` wherever there are such users.
    fn copy_crate(
        &self,
        time: Duration,
        workshop: &Workshop<'_>,
        folder: &Path,
    ) -> Result<(), NoCore> {
        if workshop.user.is_some() {
            let copy = ["cp", "-R", "{submission}/.", "{build}/crate"].map(str::to_owned).to_vec();
            return self.carry_out_all(&[copy], time, workshop, folder).map(drop);
        }
        copy_tree(&self.path, &folder.join("crate")).map_err(cannot_build(folder))
    }

    /// One command after the other, and what they said.
    fn carry_out_all(
        &self,
        commands: &[Vec<String>],
        time: Duration,
        workshop: &Workshop<'_>,
        folder: &Path,
    ) -> Result<String, NoCore> {
        std::fs::create_dir_all(folder).map_err(cannot_build(folder))?;
        if let Some(user) = workshop.user {
            give(folder, user).map_err(NoCore::Machines)?;
        }
        let mut said = String::new();
        for command in commands {
            let words = self.filled(command, &workshop.project.of_the_bench(""), folder);
            said += &self.carry_out(&by(workshop.user, words), time, folder)?;
        }
        Ok(said)
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

    fn carry_out(&self, words: &[String], time: Duration, folder: &Path) -> Result<String, NoCore> {
        let Some((program, arguments)) = words.split_first() else { return Ok(String::new()) };
        let mut command = Command::new(program);
        // Who builds runs what was handed in: the salt is not for it to know.
        command.args(arguments).envs(cached()).env_remove(SALT_VARIABLE);
        // GCC's warnings are read in English.
        command.env("LANGUAGE", "en");
        let ran = process::run(&mut command, folder, time, Group::Own);
        let cannot_run = |error| NoCore::Machines(format!("cannot run `{program}`: {error}"));
        let (ended, said) = ran.map_err(cannot_run)?;
        let status = match ended {
            Ended::Exited(status) => status,
            Ended::OutOfTime => {
                let limit = duration(time.as_secs_f64());
                return Err(NoCore::Authors(format!(
                    "it does not compile in time: `{program}` took over {limit}"
                )));
            }
        };
        if status.success() {
            return Ok(said.all());
        }
        let here = [self.path.to_string_lossy(), folder.to_string_lossy()];
        let told = here.iter().fold(said.all(), |told, here| told.replace(&**here, ""));
        let lines: Vec<_> = told.lines().collect();
        let end = &lines[lines.len().saturating_sub(LINES)..];
        let end = end.join("\n");
        Err(NoCore::Authors(format!("it does not compile: `{program}` says\n{end}")))
    }
}

fn cannot_build<E: fmt::Display>(folder: &Path) -> impl Fn(E) -> NoCore {
    move |error| NoCore::Machines(format!("cannot build in {}: {error}", folder.display()))
}

/// What the author of a crate is told that is no renderer's library.
const NO_LIBRARY: &str = "its Cargo.toml makes no library: it needs `crate-type = [\"cdylib\"]` below `[lib]`, and \
                          src/lib.rs `furnace::export_core!(Mine::new());`";

/// How Cargo makes a library of the copy of a crate.
fn build_of_a_crate() -> Vec<String> {
    let words: &[&str] = &[
        "cargo",
        "build",
        "--quiet",
        "--release",
        "--lib",
        "--manifest-path={build}/crate/Cargo.toml",
        &format!("--target-dir={{build}}/{TARGET}"),
    ];
    words.iter().map(ToString::to_string).collect()
}

/// Copies what is below a folder over what is there. A link stays one.
fn copy_tree(from: &Path, to: &Path) -> io::Result<()> {
    for entry in WalkDir::new(from) {
        let entry = entry?;
        let copy = to.join(entry.path().strip_prefix(from).unwrap_or(Path::new("")));
        let kind = entry.file_type();
        if kind.is_dir() {
            std::fs::create_dir_all(copy)?;
        } else if kind.is_symlink() {
            copy_link(entry.path(), &copy)?;
        } else if kind.is_file() {
            std::fs::copy(entry.path(), copy)?;
        }
    }
    Ok(())
}

#[cfg(unix)]
fn copy_link(from: &Path, to: &Path) -> io::Result<()> {
    if to.is_symlink() {
        std::fs::remove_file(to)?;
    }
    std::os::unix::fs::symlink(std::fs::read_link(from)?, to)
}

/// Links are for administrators there: what it leads to stands in its place.
#[cfg(not(unix))]
fn copy_link(from: &Path, to: &Path) -> io::Result<()> {
    if from.is_file() { std::fs::copy(from, to).map(|_| ()) } else { Ok(()) }
}

/// Makes a folder this user's.
fn give(folder: &Path, user: &str) -> Result<(), String> {
    let failed = |how: &dyn fmt::Display| {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copied_crate_has_all_files_and_is_copied_again_over_itself() {
        let [from, to] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        std::fs::create_dir(from.path().join("src")).unwrap();
        std::fs::write(from.path().join("src/lib.rs"), "mod shape;").unwrap();
        std::fs::write(from.path().join(MANIFEST), "[package]").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("/etc/hostname", from.path().join("link")).unwrap();
        let to = to.path().join("crate");
        for _ in 0..2 {
            copy_tree(from.path(), &to).unwrap();
            assert_eq!(std::fs::read_to_string(to.join("src/lib.rs")).unwrap(), "mod shape;");
            assert!(to.join(MANIFEST).is_file());
            // What a link leads to is not the submission's.
            #[cfg(unix)]
            assert_eq!(to.join("link").read_link().unwrap(), Path::new("/etc/hostname"));
        }
    }
}
