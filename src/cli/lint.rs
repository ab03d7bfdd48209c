//! `furnace lint`: reads every case and scene, runs nothing.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Case};
use crate::scene::{Library, SceneError};
use crate::text::{Source, number};
use clap::Args;
use std::collections::BTreeSet;

/// What `furnace lint` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct LintArguments {
    #[command(flatten)]
    project: ProjectArguments,
}

/// Says what is wrong with cases and scenes, all of it at once.
pub(crate) fn lint(arguments: &LintArguments) -> Answer {
    let project = arguments.project.find()?;
    let scenes = Library::of(&project);
    // Of a project that is laid over the bench, what is its own.
    let own = |name: &str| project.layers(name).into_iter().next().unwrap_or_default();
    let mut complaints = Vec::new();
    for name in Library::new(own("scenes")).names().map_err(Failure::request)? {
        complaints.extend(scenes.load(&name, &toml::Table::new()).err().map(|e| e.to_string()));
    }
    let mut count = 0;
    match case::load_all(&own("cases")) {
        Err(error) => complaints.push(error.to_string()),
        Ok(cases) => {
            count = cases.len();
            for case in &cases {
                let scene = case.scene.as_ref().map(|scene| scene.load(&scenes));
                complaints.extend(scene.and_then(Result::err).map(|error| error.to_string()));
                let others = case.prepared.scenes().iter();
                complaints.extend(others.filter_map(|name| misspelt(case, name, &scenes)));
            }
        }
    }
    // A mistake in a scene is met again by each case that is set in it.
    let mut known = BTreeSet::new();
    complaints.retain(|complaint| known.insert(complaint.clone()));
    if complaints.is_empty() {
        say_line!("{}: valid, with their scenes", number::count(count, "case"));
        Ok(ExitCode::Good)
    } else {
        Err(Failure::request(complaints.join("\n\n")))
    }
}

/// What is wrong with a scene that a check names, where the case names it.
fn misspelt(case: &Case, name: &str, scenes: &Library) -> Option<String> {
    let error = scenes.load(name, &toml::Table::new()).err()?;
    let SceneError::NoSuchScene { hint, .. } = error else { return Some(error.to_string()) };
    let source = Source::read(&case.path).ok()?;
    let quoted = format!("\"{name}\"");
    let start = source.text.find(&quoted).unwrap_or(0);
    let complaint =
        source.diagnostic(start..start + quoted.len(), format!("there is no scene `{name}`"));
    Some(complaint.with_hint(hint).to_string())
}
