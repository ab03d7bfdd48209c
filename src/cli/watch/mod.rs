//! `furnace run --watch`: tries again whenever a case, a scene or a core's file changes, until ctrl-c.
//!
//! What failed last is tried alone, so that an answer takes seconds; once it passes, everything is tried. Each cycle is
//! a run like any other, with its folder and its page, and one line on the terminal.

mod files;
mod memory;

use super::run::RunArguments;
use super::say::{complain, say_line};
use super::{Answer, Failure};
use crate::case::{self, NothingSelected};
use crate::project::Project;
use crate::report::{self, RunTree};
use crate::run::{self, Plan, Request};
use files::Snapshot;
use memory::{Memory, Scope};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Between two looks at the files.
const PAUSE: Duration = Duration::from_millis(400);

/// Tries, waits for a change, and so on.
pub(crate) fn watch(arguments: &RunArguments) -> Answer {
    let project = &arguments.project.find()?;
    let (request, runs) = (arguments.request(), &arguments.runs(project));
    let watched = watched(project, &request);
    say_line!("  watching {}; runs go to {}; ctrl-c ends", listed(&watched), runs.display());
    let mut memory = Memory::default();
    loop {
        let before = Snapshot::of(&watched);
        match cycle(project, &request, runs, &mut memory) {
            Ok(Cycle::AllTried) => before.wait_for_change(&watched, || std::thread::sleep(PAUSE)),
            Ok(Cycle::FailuresRepaired) => {}
            Ok(Cycle::NothingSelected(why)) => return Err(Failure::nothing(why)),
            // Somebody is in the middle of editing: what is wrong is said, and looked at again.
            Err(failure) => {
                complain(failure.message);
                before.wait_for_change(&watched, || std::thread::sleep(PAUSE));
            }
        }
    }
}

enum Cycle {
    AllTried,
    FailuresRepaired,
    NothingSelected(NothingSelected),
}

fn cycle(
    project: &Project,
    request: &Request,
    runs: &Path,
    memory: &mut Memory,
) -> Result<Cycle, Failure> {
    let cases = case::load_project(project).map_err(Failure::request)?;
    let mut plan = match Plan::new(project.clone(), request.clone(), &cases) {
        Ok(plan) => plan,
        Err(nothing) => return Ok(Cycle::NothingSelected(nothing)),
    };
    let scope = memory.restrict(&mut plan.trials);
    let started = SystemTime::now();
    // Who watches waits for the next answer.
    plan.searches = false;
    let folder = run::run(&plan, runs, &mut |_| ()).map_err(Failure::broken)?;
    let tree = RunTree::load(&folder).map_err(Failure::broken)?;
    report::html::write(&tree, &folder).map_err(Failure::broken)?;
    let seconds = started.elapsed().unwrap_or_default().as_secs_f64();
    say_line!("{}", memory.take(&time_of_day(SystemTime::now()), &tree.trials, seconds));
    Ok(match scope {
        Scope::Failures if memory.is_clean() => Cycle::FailuresRepaired,
        _ => Cycle::AllTried,
    })
}

/// Cases, scenes, and the cores that are files. Cores of our own never change while they run.
fn watched(project: &Project, request: &Request) -> Vec<PathBuf> {
    let cores = request.cores.iter().map(|core| PathBuf::from(core.as_str()));
    let files = cores.filter(|path| path.is_file());
    let own = [project.cases(), project.scenes()].into_iter().filter(|folder| folder.is_dir());
    own.chain(files).collect()
}

fn listed(paths: &[PathBuf]) -> String {
    let names: Vec<_> = paths.iter().map(|path| path.display().to_string()).collect();
    names.join(", ")
}

/// `23:14:07Z`
fn time_of_day(time: SystemTime) -> String {
    let stamp = humantime::format_rfc3339_seconds(time).to_string();
    stamp.split_once('T').map_or_else(String::new, |(_, time)| time.to_owned())
}
