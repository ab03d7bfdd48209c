//! What a terminal shows when a run has ended: its last dozen lines. Verdict, cause, where, fix, command; the counts;
//! and where the report is, which is the caller's to say.

use super::blocks::{claim, last_words};
use super::headlines;
use super::layout::{briefly, head, labelled_at, on};
use super::style::{Paint, Style, clean, is_drawn, paint_of};
use super::subject::{Subject, subjects};
use crate::diagnosis::{Degree, Headline};
use crate::report::digest::in_order_of_parts;
use crate::report::tree::{AbsentCore, RunTree, Unfinished};
use crate::run::{Counts, Status, TrialRecord};
use crate::text::number::{count, duration};
use crate::text::program;

/// Where labels begin.
const MARGIN: usize = 2;

/// The verdict, and the counts.
pub(super) fn ending(tree: &RunTree, present: &RunTree, style: Style) -> Vec<String> {
    let subjects = subjects(present);
    let verdict = match (tree.absent_cores().next(), subjects.split_first()) {
        (Some(core), _) => absent(core, style),
        (None, Some((first, others))) => failed(first, others.len(), style),
        (None, None) => calm(tree, style),
    };
    verdict.into_iter().chain([String::new()]).chain(totals(tree, style)).collect()
}

/// A core that fails to start: why, and how to try that alone.
fn absent(core: AbsentCore<'_>, style: Style) -> Vec<String> {
    let what = format!("{} fails to start: no trial could run", core.spec);
    let status = core.witness.outcome.status();
    let mut lines = head(style, paint_of(status), &status.word().to_uppercase(), &what);
    lines.extend(labelled("cause", core.problem, style));
    lines.extend(last_words(core.witness, style));
    lines.extend(command("try", &core.command()));
    lines
}

/// The first thing that counts against a core.
fn failed(first: &Subject<'_>, others: usize, style: Style) -> Vec<String> {
    let others = match others {
        0 => String::new(),
        others => format!("; {others} more above"),
    };
    match first {
        Subject::Cause(core, headline) => cause(core, headline, &others, style),
        Subject::Alone(trial) => alone(trial, &others, style),
    }
}

fn cause(core: &str, headline: &Headline, others: &str, style: Style) -> Vec<String> {
    let what = format!("{}{}{others}", headlines::count(headline), on(core, style));
    let mut lines = match headline.tier.is_graded() {
        true => head(style, Paint::Bad, "FAIL", &what),
        false => head(style, Paint::Unknown, "NOTE", &format!("{what} (not graded)")),
    };
    let is_known = headline.is_ending || headline.degree > Degree::DiffersHere;
    let label = if is_known { "cause" } else { "found" };
    let sentence = labelled(label, &headlines::sentence(headline), style);
    lines.extend(sentence.iter().map(|line| style.paint(Paint::Strong, line)));
    let seen = headline.evidence.first().map_or("", String::as_str);
    for (label, words) in [("seen", seen), ("where", &headline.look_at), ("fix", &headline.fix)] {
        lines.extend(labelled(label, words, style));
    }
    lines.extend(command("try", &headline.command));
    lines
}

fn alone(trial: &TrialRecord, others: &str, style: Style) -> Vec<String> {
    let status = trial.outcome.status();
    let what = format!("{}{}{others}", trial.case, on(&trial.core, style));
    let mut lines = head(style, paint_of(status), &status.word().to_uppercase(), &what);
    lines.extend(labelled("found", &trial.outcome.statement(), style));
    lines.extend(labelled("claim", &claim(trial), style));
    lines.extend(labelled("theory", &trial.teaches, style));
    lines.extend(command("try", &trial.rerun));
    lines
}

/// Nothing counts against a core: that is a pass only where something was proven, and all was tried.
fn calm(tree: &RunTree, style: Style) -> Vec<String> {
    let counts = tree.counts();
    if !tree.is_finished() {
        return Vec::new();
    }
    if let Some(broken) = in_order_of_parts(tree, Status::Broken).first() {
        let what = "the bench, not the core: what it needs is missing or wrong";
        let mut lines = head(style, Paint::Unknown, "BROKEN", what);
        let statement = broken.outcome.statement();
        let written: Vec<_> = statement.lines().filter(|line| !is_drawn(line)).collect();
        lines.extend(labelled("cause", &written.join("\n"), style));
        return lines;
    }
    match counts.graded.count(Status::Pass) {
        0 => nothing_proven(tree, &counts, style),
        passes => {
            let lines = head(style, Paint::Good, "PASS", &passed(passes, &counts));
            let skipped = tree.graded().find(|trial| trial.outcome.status() == Status::Skipped);
            lines.into_iter().chain(skipped.and_then(|trial| doctor(&trial.core))).collect()
        }
    }
}

/// Who tells what a core can do, and what to write next.
fn doctor(core: &str) -> Option<String> {
    command("try", &format!("{} doctor --core {}", program(), shell_words::quote(core)))
}

fn passed(passes: usize, counts: &Counts) -> String {
    let silent = counts.graded.total() - passes;
    match silent {
        0 => "all that was asked".to_owned(),
        _ => format!("all that was decided; of {silent} nothing is known"),
    }
}

/// Nothing fails, and nothing passes either.
fn nothing_proven(tree: &RunTree, counts: &Counts, style: Style) -> Vec<String> {
    let mut lines =
        head(style, Paint::Unknown, "NOTHING PROVEN", "no graded trial passes or fails");
    let Some(trial) = tree.graded().next().or(tree.trials.first()) else { return lines };
    lines.extend(labelled("cause", &trial.outcome.statement(), style));
    lines.extend(match counts.graded.count(Status::Skipped) {
        0 => command("try", &trial.rerun),
        _ => doctor(&trial.core),
    });
    lines
}

pub(super) fn totals(tree: &RunTree, style: Style) -> Vec<String> {
    let counts = tree.counts();
    let paint = match () {
        () if counts.graded.failures() > 0 => Paint::Bad,
        () if counts.graded.count(Status::Pass) == counts.ended() && tree.is_finished() => {
            Paint::Good
        }
        () => Paint::Unknown,
    };
    let took = tree.run.timing.seconds.map(|seconds| format!(" in {}", duration(seconds)));
    let text = format!("{}{}: {}", counts.trials(), took.unwrap_or_default(), counts.words());
    let painted = |line: String| format!("  {}", style.paint(paint, &line));
    let mut lines: Vec<_> = style.wrap(&text, MARGIN).into_iter().map(painted).collect();
    lines.extend(unfinished(tree, style));
    lines
}

/// That a run was cut off or stopped, and how to go on.
pub(super) fn unfinished(tree: &RunTree, style: Style) -> Vec<String> {
    let Some(why) = tree.unfinished() else { return Vec::new() };
    let missing = format!("{} of {}", tree.missing(), count(tree.run.trials, "trial"));
    let what = match why {
        Unfinished::AtFailure => format!("  NOT RUN: {missing}, after the first failure"),
        Unfinished::OutOfTime => format!("  NOT RUN: {missing}, for the time was up"),
        Unfinished::Trials => format!("  UNFINISHED: {missing} have no result"),
        Unfinished::Causes => {
            "  UNFINISHED: every trial has a result, and the search for causes was \
                               cut off"
                .to_owned()
        }
    };
    let resume = command("resume", &tree.resume());
    vec![style.paint(Paint::Unknown, &what)].into_iter().chain(resume).collect()
}

/// A label and what it says, unless that is nothing, in few lines.
fn labelled(label: &str, words: &str, style: Style) -> Vec<String> {
    if words.is_empty() {
        return Vec::new();
    }
    briefly(style, |style| labelled_at(MARGIN, label, words, style))
}

/// A label and a command, which stays whole.
fn command(label: &str, command: &str) -> Option<String> {
    Some(format!("{:MARGIN$}{label:<8}{}", "", clean(command)))
}
