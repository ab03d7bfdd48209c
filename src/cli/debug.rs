//! `furnace debug`: the answers of one case, one at a time, beside those of the textbook core; and the commands that stop a
//! debugger in the function that is asked.

use super::hosting::HostingArguments;
use super::report::style;
use super::run::salt;
use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Case, Filter};
use crate::contract::beside::{Beside, Note, Notes, Shown, Which};
use crate::contract::{Core, CoreError};
use crate::cores::{CoreSpec, Hosted};
use crate::report::text::Detail;
use crate::report::text::blocks::measures;
use crate::run::{Bench, Outcome, Plan, Request, attempt};
use crate::stats::Budget;
use crate::text::number::count;
use crate::text::program;
use crate::worker::CoreOrigin;
use clap::Args;
use std::sync::Arc;

/// Column where the text begins.
const INDENT: usize = 12;
/// Questions that are told of.
const MOST: usize = 4;
/// Cases that are told where several are meant.
const MOST_NAMES: usize = 5;

/// What `furnace debug` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct DebugArguments {
    /// Which case: its name, or a part of it that no other has.
    case: String,
    /// The renderer to look at.
    #[arg(long, value_name = "CORE")]
    core: CoreSpec,
    /// Ask the core for this alone, in this process: the number of a question, and of its element.
    #[arg(long, value_name = "QUESTION:ELEMENT", value_parser = which)]
    ask: Option<Which>,
    /// How small an error is looked for.
    #[arg(long, default_value_t)]
    budget: Budget,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Questions are counted from 1, and elements from 0, as in a core.
fn which(word: &str) -> Result<Which, String> {
    let parts = word.split_once(':').and_then(|(question, element)| {
        let question = question.parse::<usize>().ok()?.checked_sub(1)?;
        Some(Which { question, element: element.parse().ok()? })
    });
    parts
        .ok_or_else(|| "must be two numbers as `furnace debug` tells them, such as 1:17".to_owned())
}

/// Looks at a case, or asks one question of it.
pub(crate) fn debug(arguments: &DebugArguments) -> Answer {
    let (bench, case) = find(arguments)?;
    let right: CoreSpec = "textbook".parse().map_err(Failure::broken)?;
    let mut right = right.make().map_err(Failure::broken)?;
    match arguments.ask {
        Some(which) => ask(arguments, &bench, &case, right.as_mut(), which),
        None => overview(arguments, &bench, &case, right.as_mut()),
    }
}

/// What its trial shares, and the one case that is meant.
fn find(arguments: &DebugArguments) -> Result<(Bench, Arc<Case>), Failure> {
    let project = arguments.project.find()?;
    let cases = case::load_project(&project).map_err(Failure::request)?;
    let filter = Filter::new(std::slice::from_ref(&arguments.case));
    let found = filter.select(&cases).map_err(Failure::nothing)?;
    let whole = found.iter().find(|case| case.id == arguments.case);
    let case = match (whole, found.as_slice()) {
        (Some(case), _) | (None, [case]) => Arc::clone(case),
        _ => {
            return Err(Failure::request(several(&arguments.case, &found)));
        }
    };
    let request = Request {
        cores: vec![arguments.core.clone()],
        budget: arguments.budget,
        ..Request::default()
    };
    let runs = project.runs();
    let plan = Plan::new(project, request, &[Arc::clone(&case)]).map_err(Failure::nothing)?;
    let plan = plan.hosted(arguments.hosting.hosting(&runs)).salted(salt());
    Ok((plan.bench(), case))
}

fn several(word: &str, found: &[&Arc<Case>]) -> String {
    let names: Vec<_> = found.iter().take(MOST_NAMES).map(|case| case.id.as_str()).collect();
    let more = found.len() - names.len();
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    let names = names.join(", ");
    format!("`{word}` is a part of {} names\nhint: one of {names}{more}", found.len())
}

/// The whole case, with the core where a run has it: a crash ends it there and not here.
fn overview(
    arguments: &DebugArguments,
    bench: &Bench,
    case: &Case,
    right: &mut dyn Core,
) -> Answer {
    let mut hosted = bench.host(&arguments.core).map_err(Failure::request)?;
    let notes = Notes::default();
    let core = hosted.core_mut();
    let mut beside = Beside { core, right, notes: notes.clone(), alone: None };
    let attempt = attempt(bench, case, &mut beside);
    tell_outcome(arguments, case, &attempt.outcome);
    let notes = notes.lock();
    tell_questions(arguments, case, &notes);
    Ok(match attempt.outcome.status().is_failure() {
        true => ExitCode::Failed,
        false => ExitCode::Good,
    })
}

fn tell_outcome(arguments: &DebugArguments, case: &Case, outcome: &Outcome) {
    let style = style(Detail::Usual);
    say_line!("\n  {}  {} on {}", outcome.status().word().to_uppercase(), case.id, arguments.core);
    style.wrap(&outcome.statement(), 4).iter().for_each(|line| say_line!("    {line}"));
    let measures = outcome.finding().map(|finding| measures(finding, style)).unwrap_or_default();
    measures.iter().for_each(|line| say_line!("{line}"));
}

/// The questions without an answer, which ended the case, and then those whose answers differ; or else the first ones. Then
/// how to stop in the first of them.
fn tell_questions(arguments: &DebugArguments, case: &Case, notes: &[Note]) {
    let numbered = || notes.iter().enumerate();
    let is_told = |note: &Note| note.error.is_some() || note.differing.is_some_and(|n| n > 0);
    let mut differing: Vec<_> = numbered().filter(|(_, note)| is_told(note)).collect();
    differing.sort_by_key(|(_, note)| note.error.is_none());
    let told = if differing.is_empty() { numbered().collect() } else { differing };
    for (number, note) in told.iter().take(MOST) {
        say_line!();
        tell_question(*number, note);
    }
    if told.len() > MOST {
        say_line!("\n  {:<INDENT$}{} more questions", "and", told.len() - MOST);
    }
    let Some((question, note)) = told.first() else {
        return say_line!("\n  nothing was asked of the core");
    };
    let element = note.shown.first().map_or(0, |shown| shown.index);
    commands(arguments, case, note, &format!("{}:{element}", question + 1));
}

fn tell_question(number: usize, note: &Note) {
    let of =
        if note.count == 1 { "1 answer".to_owned() } else { format!("{} answers", note.count) };
    let differs = match (&note.error, note.differing) {
        (Some(error), _) => error.to_string(),
        (None, Some(0)) => "the same as textbook's".to_owned(),
        (None, Some(differing)) => format!("{differing} not as textbook's"),
        (None, None) => "random, or the core's own to choose".to_owned(),
    };
    say_line!("  {:<INDENT$}{}. {}, {of}: {differs}", "asked", number + 1, note.method);
    let has_answered = !matches!(note.error, Some(CoreError::Crashed { .. }));
    note.shown.iter().for_each(|shown| tell_element(shown, has_answered));
}

fn tell_element(shown: &Shown, has_answered: bool) {
    for (number, (name, words)) in shown.asked.iter().enumerate() {
        let label = if number == 0 { format!("element {}", shown.index) } else { String::new() };
        say_line!("  {label:<INDENT$}{name}: {words}");
    }
    let yours = if has_answered { &shown.yours } else { "no answer" };
    say_line!("  {:<INDENT$}{yours}", "  yours");
    say_line!("  {:<INDENT$}{}", "  textbook", shown.right);
}

/// The commands that ask for one element alone.
fn commands(arguments: &DebugArguments, case: &Case, note: &Note, which: &str) {
    let core = shell_words::quote(arguments.core.as_str());
    let budget = match arguments.budget == Budget::default() {
        true => String::new(),
        false => format!(" --budget {}", arguments.budget),
    };
    let words = format!("debug {} --core {core}{budget} --ask {which}", case.id);
    say_line!("\n  {:<INDENT$}{} {words}", "alone", program());
    let CoreOrigin::Library(library) = arguments.core.origin() else { return };
    let this = std::env::current_exe().unwrap_or_else(|_| "furnace".into());
    let this = this.to_string_lossy();
    let this = shell_words::quote(&this);
    let functions = if note.in_c.is_empty() { &[note.method][..] } else { note.in_c };
    let file = library.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stops = |command: &str| {
        functions.iter().map(|name| format!("{command} {name}'")).collect::<Vec<_>>().join(" ")
    };
    let load = shell_words::quote(&file).into_owned();
    say_line!(
        "  {:<INDENT$}gdb -ex 'catch load {load}' -ex run {} -ex continue --args {this} {words}",
        "gdb",
        stops("-ex 'break")
    );
    let lldb = format!("-o 'breakpoint set --shlib {load} --name");
    say_line!("  {:<INDENT$}lldb {} -o run -- {this} {words}", "lldb", stops(&lldb));
    let advice = "compile the core with -g and -O0; where gdb stops in `@plt`, `continue`";
    say_line!("  {:<INDENT$}{advice}", "");
}

/// One question of the core, in this process, where a debugger is; the textbook core answers all before.
fn ask(
    arguments: &DebugArguments,
    bench: &Bench,
    case: &Case,
    right: &mut dyn Core,
    which: Which,
) -> Answer {
    let mut hosted = match arguments.core.origin() {
        CoreOrigin::BuiltIn | CoreOrigin::Library(_) => {
            Hosted::Here(arguments.core.make().map_err(Failure::request)?)
        }
        // A program is a process of its own.
        _ => bench.host(&arguments.core).map_err(Failure::request)?,
    };
    let core = hosted.core_mut();
    let notes = Notes::default();
    let mut beside = Beside { core, right, notes: notes.clone(), alone: Some(which) };
    let attempt = attempt(bench, case, &mut beside);
    let notes = notes.lock();
    let Some(note) = notes.get(which.question) else {
        let asks = count(notes.len(), "question");
        let end = match &attempt.outcome {
            Outcome::Judged { .. } => String::new(),
            other => format!(": {}", other.statement()),
        };
        return Err(Failure::nothing(format!("{} asks {asks}{end}", case.id)));
    };
    if note.shown.is_empty() {
        let (asked, elements) = (which.question + 1, count(note.count, "element"));
        return Err(Failure::nothing(format!(
            "question {asked} of {} has {elements}, counted from 0",
            case.id
        )));
    }
    tell_question(which.question, note);
    Ok(ExitCode::Good)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_are_counted_from_one_and_elements_from_zero() {
        assert_eq!(which("1:17"), Ok(Which { question: 0, element: 17 }));
        assert_eq!(which("3:0"), Ok(Which { question: 2, element: 0 }));
        for wrong in ["0:1", "1", "a:b", "1:-1", ""] {
            assert!(which(wrong).is_err(), "{wrong}");
        }
    }
}
