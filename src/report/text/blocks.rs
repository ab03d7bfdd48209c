//! What did not pass, one block each: first what counts against a core, then what is not known.

use super::headlines;
use super::layout::{INDENT, command, head, indented, labelled, on};
use super::style::{Paint, Style, clean, cut, paint_of, wrap};
use crate::case::Part;
use crate::checks::{Finding, Measure};
use crate::diagnosis::Diagnosis;
use crate::report::digest::{failures, in_order_of_parts, ungraded_failures};
use crate::report::measure::{MeasureWords, worst_first};
use crate::report::transplants::sentences;
use crate::report::tree::{AbsentCore, RunTree};
use crate::run::record::CoreRecord;
use crate::run::{Outcome, Status, TrialRecord};
use crate::stats::Verdict;
use crate::text::number::count;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Failures that are told in full. A core that fails everything is not helped by pages of numbers.
const FULL_BLOCKS: usize = 5;
/// Cases named of those that have one reason.
const NAMES: usize = 8;
/// Measures shown of a failure, the worst first.
const MEASURES: usize = 4;
/// Reasons told why something cannot be asked, those of the most cases.
const REASONS: usize = 3;
/// Lines shown of what a core printed before it crashed.
const LAST_WORDS: usize = 3;

pub(crate) fn all(tree: &RunTree, style: Style) -> Vec<String> {
    let diagnoses = tree.diagnoses();
    let mut lines = headlines::all(&diagnoses, style);
    lines.extend(tree.run.cores.iter().flat_map(|core| transplants(core, style)));
    let (explained, alone): (Vec<_>, Vec<_>) =
        failures(tree).into_iter().partition(|trial| is_explained(&diagnoses, trial));
    lines.extend(of_these_causes(&explained, style));
    let (full, brief) = alone.split_at(alone.len().min(FULL_BLOCKS));
    lines.extend(full.iter().flat_map(|trial| full_block(trial, style)));
    lines.extend(brief.iter().flat_map(|trial| brief_block(trial, style)));
    lines.extend(ungraded_failures(tree).into_iter().flat_map(|trial| note(trial, style)));
    for status in [Status::Broken, Status::Inconclusive] {
        let trials = in_order_of_parts(tree, status);
        lines.extend(trials.into_iter().flat_map(|trial| undecided_block(trial, style)));
    }
    lines.extend(blocked(tree, style));
    lines.extend(not_asked(tree, style));
    lines
}

/// What the bench's own components take away of a core's failures.
fn transplants(core: &CoreRecord, style: Style) -> Vec<String> {
    let sentences = sentences(core);
    if sentences.is_empty() {
        return Vec::new();
    }
    let word = style.paint(Paint::Strong, "PROOF");
    let head = format!("  {word}  failures{}, tried again", on(&core.spec, style));
    let told = sentences.iter().flat_map(|sentence| indented(&clean(sentence)));
    [String::new(), head].into_iter().chain(told).collect()
}

/// A core that fails to start: why, and how to try that alone.
pub(crate) fn absent(core: AbsentCore<'_>, style: Style) -> Vec<String> {
    let what = format!("{} fails to start: no trial could run", clean(core.spec));
    let mut lines = head_of(core.witness.outcome.status(), &what, style);
    lines.extend(indented(core.problem));
    lines.extend(last_words(core.witness));
    lines.push(command(&core.command()));
    lines
}

/// Whether a cause has been told that the trial shows, or may follow from.
fn is_explained(diagnoses: &[(&str, &Diagnosis)], trial: &TrialRecord) -> bool {
    let told = |(core, diagnosis): &(&str, &Diagnosis)| {
        *core == trial.core && !diagnosis.unexplained.contains(&trial.case)
    };
    diagnoses.iter().any(told)
}

/// Verdict and size, the numbers, the place, the next command.
fn full_block(trial: &TrialRecord, style: Style) -> Vec<String> {
    let mut lines = brief_block(trial, style);
    if let Some(finding) = trial.outcome.finding() {
        lines.extend(measures(finding, style));
    }
    lines.extend(last_words(trial));
    lines.extend(labelled("claim", &claim(trial)));
    lines.extend(labelled("theory", &trial.teaches));
    lines.push(command(&trial.rerun));
    lines
}

/// Failures of causes that are told already, by their names.
fn of_these_causes(trials: &[&TrialRecord], style: Style) -> Vec<String> {
    let mut of_cores: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for trial in trials {
        of_cores.entry(&trial.core).or_default().push(&trial.case);
    }
    let paragraph = |(core, cases): (&str, Vec<&str>)| {
        let what = format!("{} of these causes{}", count(cases.len(), "failure"), on(core, style));
        let head = head(style, Paint::Bad, "FAIL", &what);
        head.into_iter().chain(names(&cases)).collect::<Vec<_>>()
    };
    of_cores.into_iter().flat_map(paragraph).collect()
}

/// The first of these cases.
fn names(cases: &[&str]) -> Vec<String> {
    let mut names: Vec<_> = cases.iter().take(NAMES).map(|case| clean(case)).collect();
    if cases.len() > NAMES {
        names.push("…".to_owned());
    }
    indented(&names.join(", "))
}

/// Verdict and size: `grep FAIL -A1` finds both.
fn brief_block(trial: &TrialRecord, style: Style) -> Vec<String> {
    let what = clean(&trial.case) + &on(&trial.core, style);
    let mut lines = head_of(trial.outcome.status(), &what, style);
    lines.extend(indented(&trial.outcome.statement()));
    lines
}

fn head_of(status: Status, what: &str, style: Style) -> Vec<String> {
    head(style, paint_of(status), &status.word().to_uppercase(), what)
}

fn note(trial: &TrialRecord, style: Style) -> Vec<String> {
    let (case, on) = (clean(&trial.case), on(&trial.core, style));
    let what = format!("{case}{on} ({}, not graded)", trial.tier.word());
    let mut lines = head(style, Paint::Unknown, "NOTE", &what);
    lines.extend(indented(&trial.outcome.statement()));
    lines
}

/// The end of what a core printed that has crashed or hung.
fn last_words(trial: &TrialRecord) -> Vec<String> {
    if !matches!(trial.outcome.status(), Status::Crashed | Status::TimedOut) {
        return Vec::new();
    }
    let printed: Vec<_> = trial.printed.lines().filter(|line| !line.trim().is_empty()).collect();
    let last = &printed[printed.len().saturating_sub(LAST_WORDS)..];
    last.iter().flat_map(|line| labelled("printed", &clean(line))).collect()
}

/// Nothing counts against the core: what is missing, and how to learn more.
fn undecided_block(trial: &TrialRecord, style: Style) -> Vec<String> {
    let mut lines = brief_block(trial, style);
    if let Some(Finding { resolution, .. }) = trial.outcome.finding()
        && !resolution.is_empty()
    {
        lines.extend(indented(resolution));
    }
    lines.push(command(&trial.rerun));
    lines
}

/// The claim, and the part of a path tracer that it is about.
fn claim(trial: &TrialRecord) -> String {
    match Part::of_case(&trial.case) {
        Some(part) => format!("{} ({})", trial.title, part.title),
        None => trial.title.clone(),
    }
}

/// The worst measures as a table, and how many there are besides.
fn measures(finding: &Finding, style: Style) -> Vec<String> {
    if finding.measures.is_empty() {
        return Vec::new();
    }
    let sorted = worst_first(&finding.measures);
    let shown = &sorted[..sorted.len().min(MEASURES)];
    let mut lines = vec![String::new()];
    lines.extend(table(shown, style));
    let rest = &sorted[shown.len()..];
    if !rest.is_empty() {
        let wrong = rest.iter().filter(|measure| measure.verdict == Verdict::Fail).count();
        lines.push(format!("{:INDENT$}  and {} more, {wrong} of them wrong", "", rest.len()));
    }
    lines.push(String::new());
    lines
}

fn table(measures: &[&Measure], style: Style) -> Vec<String> {
    let head = ["", "measured", "expected", "allowed", "off by"].map(str::to_owned);
    let rows: Vec<_> = measures.iter().map(|measure| row(measure)).collect();
    let width = |column: usize| {
        let cells = rows.iter().chain([&head]).map(|row| row[column].chars().count());
        cells.max().unwrap_or(0)
    };
    let widths = std::array::from_fn::<_, 5, _>(width);
    let head = style.paint(Paint::Faint, &aligned("  ", &head, &widths));
    let lines = measures.iter().zip(&rows).map(|(measure, row)| {
        let wrong = measure.verdict == Verdict::Fail;
        aligned(if wrong { "x " } else { "  " }, row, &widths)
    });
    std::iter::once(head).chain(lines).collect()
}

fn row(measure: &Measure) -> [String; 5] {
    let words = MeasureWords::of(measure);
    [cut(&words.name, 30), words.measured, words.expected, words.allowed, words.off_by]
}

/// Names to the left, numbers to the right.
fn aligned(mark: &str, row: &[String; 5], widths: &[usize; 5]) -> String {
    let [name, numbers @ ..] = row;
    let mut line = format!("{:INDENT$}{mark}{name:<width$}", "", width = widths[0]);
    for (number, width) in numbers.iter().zip(&widths[1..]) {
        line += &format!("   {number:>width$}");
    }
    line.trim_end().to_owned()
}

/// Trials that rest on the same failure, in one paragraph.
fn blocked(tree: &RunTree, style: Style) -> Vec<String> {
    let paragraph = |((core, reason), cases): ((&str, String), Vec<&str>)| {
        let what = format!("{}{}: {reason}", cases.len(), on(core, style));
        let mut what = wrap(&what, Status::Blocked.word().len() + 4).into_iter();
        let mut lines = head_of(Status::Blocked, &what.next().unwrap_or_default(), style);
        lines.extend(what.map(|line| format!("{:INDENT$}{line}", "")));
        lines.extend(names(&cases));
        lines
    };
    by_reason(tree, Status::Blocked).into_iter().flat_map(paragraph).collect()
}

/// What a core cannot be asked, in one paragraph: it says nothing about the core.
fn not_asked(tree: &RunTree, style: Style) -> Vec<String> {
    let mut of_cores: BTreeMap<&str, Vec<(usize, String)>> = BTreeMap::new();
    for ((core, reason), cases) in by_reason(tree, Status::Skipped) {
        of_cores.entry(core).or_default().push((cases.len(), reason));
    }
    let paragraph = |(core, mut reasons): (&str, Vec<(usize, String)>)| {
        reasons.sort_by_key(|(cases, _)| Reverse(*cases));
        let all: usize = reasons.iter().map(|(cases, _)| cases).sum();
        let (told, others) = reasons.split_at(reasons.len().min(REASONS));
        let mut lines = head_of(Status::Skipped, &format!("{all}{}", on(core, style)), style);
        lines.extend(told.iter().flat_map(|(cases, why)| indented(&format!("{cases}: {why}"))));
        if !others.is_empty() {
            let rest: usize = others.iter().map(|(cases, _)| cases).sum();
            lines.extend(indented(&format!("{rest}: for {}", count(others.len(), "other reason"))));
        }
        lines
    };
    of_cores.into_iter().flat_map(paragraph).collect()
}

/// Trials without a result, by core and reason.
fn by_reason(tree: &RunTree, status: Status) -> BTreeMap<(&str, String), Vec<&str>> {
    let mut reasons: BTreeMap<(&str, String), Vec<&str>> = BTreeMap::new();
    for trial in in_order_of_parts(tree, status) {
        reasons.entry((&trial.core, reason(&trial.outcome))).or_default().push(&trial.case);
    }
    reasons
}

fn reason(outcome: &Outcome) -> String {
    match outcome {
        Outcome::Blocked { by } => format!("{by} failed, and these rest on it"),
        _ => outcome.statement(),
    }
}
