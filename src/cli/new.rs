//! `furnace new`: a core, a case, a suite or an autograder that is ready to run, copied from the bench's own.

mod autograder;

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Case, Filter};
use crate::project::Project;
use crate::text::{Source, program};
use clap::{Args, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use walkdir::WalkDir;

/// What `furnace new` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct NewArguments {
    #[command(subcommand)]
    what: What,
    #[command(flatten)]
    project: ProjectArguments,
}

#[derive(Clone, Debug, Subcommand)]
enum What {
    /// A renderer to start from, or what brings an existing one to the bench.
    Core {
        /// What it is written in, or `command` for a program that renders images, `cs184` for the course's.
        #[arg(long, value_enum)]
        lang: Language,
        /// The folder for it; created if missing.
        #[arg(default_value = "mine")]
        folder: PathBuf,
    },
    /// A case, as a copy of one of the bench's.
    Case {
        /// Folder and claim, such as `light/two-suns-add-up`.
        name: String,
        /// The case to begin with [default: the shortest of that folder].
        #[arg(long, value_name = "CASE")]
        like: Option<String>,
    },
    /// A suite, as a copy of the course's.
    Suite {
        /// File name without `.toml`.
        name: String,
    },
    /// What Gradescope and GitHub take to grade each submission: scripts, this program, a suite and a salt.
    Autograder {
        /// The suite to grade by.
        #[arg(long, default_value = "cs184-hw3")]
        suite: String,
        /// The folder for it; created if missing.
        #[arg(default_value = "autograder")]
        folder: PathBuf,
    },
    /// A job array that grades a class on a cluster with Slurm.
    Slurm {
        /// The suite to grade by.
        #[arg(long, default_value = "cs184-hw3")]
        suite: String,
        /// The script.
        #[arg(default_value = "class.sbatch")]
        file: PathBuf,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    Cpp,
    Rust,
    Python,
    Command,
    Cs184,
}

/// What is copied for a language, and what to do with it.
struct Kit {
    language: Language,
    /// Files or folders of the bench, and where they go in the new folder.
    copies: &'static [(&'static str, &'static str)],
    /// Commands to be run in the new folder.
    next: &'static [&'static str],
}

const KITS: [Kit; 5] = [
    Kit {
        language: Language::Cpp,
        copies: &[("examples/cpp", ""), ("include", "")],
        next: &[
            "c++ -std=c++17 -O2 -shared -fPIC -I. pathtracer.cpp -o libpathtracer.so",
            "FURNACE doctor --core ./libpathtracer.so",
            "FURNACE run --core ./libpathtracer.so",
        ],
    },
    Kit {
        language: Language::Rust,
        copies: &[("examples/rust", ""), ("include/furnace_core.h", "furnace_core.h")],
        next: &[
            "rustc --edition 2024 -O --crate-type cdylib core.rs -o libcore.so",
            "FURNACE doctor --core ./libcore.so",
            "FURNACE run 1 --core ./libcore.so",
        ],
    },
    Kit {
        language: Language::Python,
        copies: &[
            ("examples/python", ""),
            ("adapters/python/furnace_core", "furnace_core"),
            ("include/furnace_core.h", "furnace_core.h"),
        ],
        next: &[
            "python3 -c 'import numpy'      # if that fails: pip install numpy",
            "FURNACE doctor --core 'exec: python3 numpy_core.py'",
            "FURNACE run 1 2 --core 'exec: python3 numpy_core.py'",
        ],
    },
    Kit {
        language: Language::Command,
        copies: &[
            ("adapters/command/mitsuba.toml", "renderer.toml"),
            ("adapters/command/render_mitsuba.py", "render_mitsuba.py"),
            ("adapters/command/furnace_scene.py", "furnace_scene.py"),
        ],
        next: &[
            "pip install mitsuba            # or put your own program into renderer.toml",
            "FURNACE doctor --core ./renderer.toml",
            "FURNACE run image/ --core ./renderer.toml",
        ],
    },
    Kit {
        language: Language::Cs184,
        copies: &[("adapters/cs184", "adapters/cs184"), ("include", "include")],
        next: &[
            "cmake -S adapters/cs184 -B build -DSUBMISSION=path/to/submission && cmake --build build",
            "FURNACE doctor --core build/libfurnace_cs184.so",
            "FURNACE run 1 2 3 4 5 --core build/libfurnace_cs184.so",
        ],
    },
];

/// Writes what was asked for, and says what to do with it.
pub(crate) fn new(arguments: &NewArguments) -> Answer {
    let project = arguments.project.find()?;
    match &arguments.what {
        What::Core { lang, folder } => core(&project, *lang, folder),
        What::Case { name, like } => new_case(&project, name, like.as_deref()),
        What::Suite { name } => suite(&project, name),
        What::Autograder { suite, folder } => autograder::autograder(&project, suite, folder),
        What::Slurm { suite, file } => autograder::slurm(&project, suite, file),
    }
}

fn core(project: &Project, language: Language, folder: &Path) -> Answer {
    refuse_what_is_there(folder)?;
    let Some(kit) = KITS.iter().find(|kit| kit.language == language) else {
        return Err(Failure::broken("there is nothing to copy for this language"));
    };
    for (from, to) in kit.copies {
        copy(&project.of_the_bench(from), &folder.join(to)).map_err(Failure::broken)?;
    }
    say_line!("{}", folder.display());
    say_line!("  next  cd {}", shell_words::quote(&folder.to_string_lossy()));
    for line in kit.next {
        say_line!("        {}", line.replace("FURNACE", program()));
    }
    Ok(ExitCode::Good)
}

fn refuse_what_is_there(folder: &Path) -> Result<(), Failure> {
    if std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(Failure::request(format!(
            "`{}` is not empty\nhint: name a folder that is new, as the last word",
            folder.display()
        )));
    }
    Ok(())
}

/// Copies a file, or all files below a folder, but for what Python leaves behind.
fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("cannot copy {}: {error}", from.display());
    for entry in WalkDir::new(from) {
        let entry = entry.map_err(|error| failed(&error))?;
        let inside = entry.path().strip_prefix(from).map_err(|error| failed(&error))?;
        if !entry.file_type().is_file() || inside.to_string_lossy().contains("__pycache__") {
            continue;
        }
        // `join` of nothing would end in a slash.
        let to = if inside.as_os_str().is_empty() { to.to_owned() } else { to.join(inside) };
        let text = std::fs::read(entry.path()).map_err(|error| failed(&error))?;
        crate::disk::replace(&to, &text).map_err(|error| failed(&error))?;
    }
    Ok(())
}

fn new_case(project: &Project, name: &str, like: Option<&str>) -> Answer {
    let cases = case::load_project(project).map_err(Failure::request)?;
    let folder = name.split('/').next().unwrap_or(name).to_owned() + "/";
    let model = match like {
        Some(word) => Filter::new(&[word.to_owned()]).select(&cases).map_err(Failure::nothing)?,
        None => cases.iter().filter(|case| case.id.starts_with(&folder)).collect(),
    };
    let Some(model) = model.iter().min_by_key(|case| length(case)) else {
        let folders: Vec<_> = case::Subject::all().map(case::Subject::folder).collect();
        return Err(Failure::request(format!(
            "`{name}` is in no folder of cases\nhint: `furnace new case {}/{name}`; the folders are {}",
            folders[0],
            folders.join(", ")
        )));
    };
    let path = project.cases().join(format!("{name}.toml"));
    let source = Source::read(&model.path).map_err(Failure::broken)?;
    write_new(&path, &without_duties(&source.text))?;
    say_line!("  like  {}", model.id);
    say_line!("  next  {} lint", program());
    say_line!("        {} run {name}", program());
    Ok(ExitCode::Good)
}

fn length(case: &Arc<Case>) -> u64 {
    case.path.metadata().map_or(u64::MAX, |file| file.len())
}

/// A case without what it proves to others and shows to the rules of the diagnosis: a copy of it does neither.
fn without_duties(text: &str) -> String {
    let is_duty = |line: &&str| {
        let key = line.split('=').next().unwrap_or_default().trim();
        ["proves", "role"].contains(&key)
    };
    let (head, expect) = text.split_once("[expect]").unwrap_or((text, ""));
    let lines: Vec<_> = head.lines().filter(|line| !is_duty(line)).collect();
    format!("{}\n[expect]{expect}", lines.join("\n"))
}

fn suite(project: &Project, name: &str) -> Answer {
    let model = project.of_the_bench("suites/cs184-hw3.toml");
    let text = std::fs::read_to_string(&model).map_err(Failure::broken)?;
    write_new(&project.suites().join(format!("{name}.toml")), &text)?;
    say_line!("  next  {} grade --suite {name} --core builtin", program());
    Ok(ExitCode::Good)
}

/// Writes a file that is not there yet, and says where.
fn write_new(path: &Path, text: &str) -> Result<(), Failure> {
    if path.exists() {
        return Err(Failure::request(format!(
            "{} is there already\nhint: choose another name, or delete it first",
            path.display()
        )));
    }
    crate::disk::replace(path, text.as_bytes()).map_err(Failure::broken)?;
    say_line!("{}", path.display());
    Ok(())
}
