//! `furnace bench`: how fast the BVHs of cores are.

use super::hosting::HostingArguments;
use super::say::{complain, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::bench::{Bench, FOUNDING, Subject, in_folder, made_here, names, table};
use crate::cores::CoreSpec;
use crate::scene::Library;
use crate::text::{all_of, hint, listed};
use clap::Args;
use std::path::{Path, PathBuf};

/// Measuring takes longer than a trial.
const SECONDS: f64 = 3600.0;
/// Left out unless it is asked for: textbook brute force takes a minute.
const LARGEST: &str = "bumpy-sphere-1.3M";

/// What `furnace bench` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct BenchArguments {
    /// Meshes: parts of their names [default: all that are made here but the largest].
    filters: Vec<String>,
    /// The core; may be repeated to compare several. `builtin` comes along.
    #[arg(long = "core", value_name = "CORE", required = true)]
    cores: Vec<CoreSpec>,
    /// The folder of the course's `.dae` scenes: cow, teapot, beetle, maxplanck and bunny in place of the meshes made
    /// here.
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
    /// How often each structure is built and timed, with as many again where it was noisy. Of fewer than 9 there is no
    /// interval.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Measures, and prints the tables.
pub(crate) fn bench(arguments: &BenchArguments) -> Answer {
    let project = arguments.project.find()?;
    let subjects = match &arguments.scenes {
        Some(folder) => of_the_course(arguments, folder, &Library::of(&project))?,
        None => made_here(|name| is_wanted(arguments, name)).collect(),
    };
    if subjects.is_empty() {
        return Err(Failure::nothing(none(arguments)));
    }
    let hosting = arguments.hosting.with_time_limit(SECONDS).hosting(&project.runs());
    let bench = Bench {
        cores: with_builtin(&arguments.cores)?,
        hosting: hosting.hiding(project.secrets()),
        rounds: arguments.rounds.into(),
    };
    let rounds = bench.rounds;
    let tell = |round, meshes| {
        let (all, again) = match round {
            _ if round > rounds => (2 * rounds, ", again where it was noisy"),
            _ => (rounds, ""),
        };
        complain(format!("round {round} of {all}, {meshes} meshes{again}"));
    };
    let measured = bench.measure(&subjects, tell).map_err(Failure::broken)?;
    say_line!("{}", table(&measured));
    let is_wrong = measured.iter().any(crate::bench::Measured::is_wrong);
    Ok(if is_wrong { ExitCode::Failed } else { ExitCode::Good })
}

/// Why there is no mesh, and which there could be.
fn none(arguments: &BenchArguments) -> String {
    let names = if arguments.scenes.is_some() { FOUNDING.to_vec() } else { names() };
    let names = names.into_iter();
    if let (Some(folder), []) = (&arguments.scenes, arguments.filters.as_slice()) {
        return format!("`{}` has none of {}", folder.display(), listed(names));
    }
    let word = arguments.filters.join(" ");
    let hint = hint(&word, names.clone(), || all_of(names));
    format!("no mesh is called `{word}`\nhint: {hint}")
}

fn is_wanted(arguments: &BenchArguments, name: &str) -> bool {
    let filters = &arguments.filters;
    let is_named = filters.iter().any(|part| name.contains(part.as_str()));
    is_named || filters.is_empty() && name != LARGEST
}

fn of_the_course(
    arguments: &BenchArguments,
    folder: &Path,
    library: &Library,
) -> Result<Vec<Subject>, Failure> {
    let wanted = |name: &str| is_wanted(arguments, name);
    let found = in_folder(folder, library, wanted).map_err(Failure::request)?;
    for name in FOUNDING.iter().filter(|name| wanted(name)) {
        if !found.iter().any(|subject| subject.name == *name) {
            complain(format!("`{}` has no {name}.dae", folder.display()));
        }
    }
    Ok(found)
}

fn with_builtin(cores: &[CoreSpec]) -> Result<Vec<CoreSpec>, Failure> {
    let builtin: CoreSpec = "builtin".parse().map_err(Failure::request)?;
    let is_there = cores.contains(&builtin);
    Ok(cores.iter().cloned().chain((!is_there).then_some(builtin)).collect())
}
