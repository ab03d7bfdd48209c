//! `furnace explain`: one case in words, before or after it failed.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Case, Filter, foundations};
use crate::cores::CoreSpec;
use crate::cores::textbook::fault;
use crate::project::Project;
use crate::report::text::Detail;
use crate::run::{Outcome, Plan, Request, run_trial};
use crate::text::number::{duration, probability};
use crate::text::program;
use clap::Args;
use std::sync::Arc;

/// Column where the text begins.
const INDENT: usize = 12;
/// Cases told at once; more are only named.
const MOST: usize = 3;

/// What `furnace explain` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ExplainArguments {
    /// Which case: its name, or a part of it.
    #[arg(required = true)]
    filters: Vec<String>,
    #[command(flatten)]
    project: ProjectArguments,
}

pub(crate) fn explain(arguments: &ExplainArguments) -> Answer {
    let project = arguments.project.find()?;
    let cases = case::load_project(&project).map_err(Failure::request)?;
    let selected = Filter::new(&arguments.filters).select(&cases).map_err(Failure::nothing)?;
    for case in selected.iter().take(MOST) {
        say_line!("{}", told(&project, case)?);
    }
    if selected.len() > MOST {
        let others: Vec<_> = selected[MOST..].iter().map(|case| case.id.as_str()).collect();
        say_line!("{}", labelled("also", &others.join(", ")));
    }
    Ok(ExitCode::Good)
}

/// ` where the core promises plain-estimators`; nothing for what every core is held to.
fn on_promise(case: &Case) -> String {
    let promises = case.promise.names();
    if promises.is_empty() {
        return String::new();
    }
    format!(" where the core promises {}", promises.join(", "))
}

fn told(project: &Project, case: &Arc<Case>) -> Result<String, Failure> {
    let part = case.part().map_or(String::new(), |p| format!("part {}, {}", p.number, p.title));
    let mut lines = vec![
        format!("{}\n", case.id),
        labelled("claim", &case.title),
        labelled("about", &format!("{part}; {}{}", case.tier.word(), on_promise(case))),
        labelled("background", &case.teaches),
        labelled("checked", &format!("{} ({})", case.check.summary, case.check.name)),
        labelled("source", &case.source),
    ];
    if let Some(scene) = &case.scene {
        lines.push(labelled("scene", &scene_words(scene)));
    }
    lines.push(labelled("asks for", &case.prepared.needs().names().join(", ")));
    lines.extend(rests_on(project, case));
    lines.extend(sees(project, case)?);
    lines.extend(usual_causes(case));
    lines.push(labelled("try", &format!("{} run {}", program(), case.id)));
    Ok(lines.join("\n") + "\n")
}

fn scene_words(scene: &case::SceneChoice) -> String {
    let changed = scene.parameters.iter().map(|(name, value)| format!("{name} = {value}"));
    let changed: Vec<_> = changed.collect();
    if changed.is_empty() {
        scene.name.clone()
    } else {
        format!("{} with {}", scene.name, changed.join(", "))
    }
}

/// What has to be right for its result to mean anything.
fn rests_on(project: &Project, case: &Case) -> Option<String> {
    let library = crate::scene::Library::of(project);
    let scene = case.scene.as_ref();
    let scene = scene.and_then(|choice| choice.load(&library).ok());
    let found = foundations(case, scene.as_deref());
    let words: Vec<_> = found.iter().map(|foundation| foundation.word()).collect();
    (!words.is_empty()).then(|| labelled("rests on", &words.join(", ")))
}

/// What it can see and what it spends, as it turns out on a core that is right.
fn sees(project: &Project, case: &Arc<Case>) -> Result<Vec<String>, Failure> {
    let core: CoreSpec = "textbook".parse().map_err(Failure::broken)?;
    let request = Request { cores: vec![core], ..Request::default() };
    let plan = Plan::new(project.clone(), request, &[Arc::clone(case)]);
    let plan = plan.map_err(Failure::nothing)?;
    let Some(trial) = plan.trials.first() else { return Ok(Vec::new()) };
    let record = run_trial(&plan.bench(), trial).record;
    let Outcome::Judged { finding } = &record.outcome else {
        return Ok(vec![labelled("detects", &record.outcome.statement())]);
    };
    let blame = if finding.false_alarm() > 0.0 {
        format!(
            "false-alarm probability on a correct core: at most {}",
            probability(finding.false_alarm())
        )
    } else {
        "deterministic: a correct core never fails it".to_owned()
    };
    Ok(vec![
        labelled("detects", &format!("on textbook it {}", finding.resolution)),
        labelled("error rate", &blame),
        labelled(
            "takes",
            &format!("{}, {} numbers", duration(record.timing.seconds), finding.measures.len()),
        ),
    ])
}

/// The mistakes that this case is the first to show, and how to watch it fail.
fn usual_causes(case: &Case) -> Vec<String> {
    let faults: Vec<_> = fault::all().filter(|fault| fault.caught_by == case.id).collect();
    let mut causes: Vec<_> = faults.iter().map(|fault| fault.cause.headline).collect();
    causes.dedup();
    let label_of = |number| if number == 0 { "often" } else { "" };
    let lines = causes.iter().enumerate();
    let mut lines: Vec<_> =
        lines.map(|(number, words)| labelled(label_of(number), words)).collect();
    if let Some(fault) = faults.first() {
        let command = format!("{} run {} --core textbook:{}", program(), case.id, fault.name);
        lines.push(labelled("fails with", &command));
    }
    lines
}

/// A label and a text that goes on below itself.
fn labelled(label: &str, text: &str) -> String {
    let lines = super::report::style(Detail::Usual).wrap(text, INDENT + 2);
    let label_of = |number| if number == 0 { label } else { "" };
    let lines = lines.iter().enumerate();
    let lines: Vec<_> =
        lines.map(|(n, line)| format!("  {:<INDENT$}{line}", label_of(n))).collect();
    lines.join("\n")
}
