//! What did not pass, one block each. What to look at first stands last, next to the ending: there a terminal is read.

use super::headlines;
use super::layout::{INDENT, briefly, command, head, indented, labelled, on};
use super::style::{Paint, Style, clean, cut, paint_of};
use super::subject::{Subject, subjects};
use crate::case::Part;
use crate::checks::{Finding, Measure};
use crate::image::CHANNELS;
use crate::report::digest::{in_order_of_parts, ungraded_failures};
use crate::report::measure::{MeasureWords, worst_in_order};
use crate::report::transplants::sentences;
use crate::report::tree::RunTree;
use crate::run::record::CoreRecord;
use crate::run::{Outcome, Status, TrialRecord};
use crate::stats::Verdict;
use crate::text::number::count;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Blocks of one kind. A core that is wrong everywhere is not helped by pages of them.
const MOST: usize = 5;
/// Measures shown of a failure, the worst of them.
const MEASURES: usize = 4;
/// Columns for the name of a measure.
const NAME: usize = 30;
/// Reasons told why something was not tried, those of the most cases.
const REASONS: usize = 3;
/// Lines shown of what a core printed before it crashed.
const LAST_WORDS: usize = 3;

pub(crate) fn all(tree: &RunTree, style: Style) -> Vec<String> {
    let untried = [Status::Skipped, Status::Blocked].map(|status| untried(tree, status, style));
    let mut lines = untried.concat();
    lines.extend(notes(tree, style));
    for status in [Status::Inconclusive, Status::Broken] {
        let trials = graded(tree, status).into_iter();
        let blocks = trials.map(|trial| brief_block(trial, style)).collect();
        lines.extend(first_of(blocks, paint_of(status), &status.word().to_uppercase(), style));
    }
    lines.extend(failures(tree, style));
    lines.extend(tree.run.cores.iter().flat_map(|core| transplants(core, style)));
    lines
}

/// What counts against the cores, the first of it last; in few words, and of the first only what the ending leaves out,
/// unless all is asked for.
fn failures(tree: &RunTree, style: Style) -> Vec<String> {
    let subjects = subjects(tree);
    let Some((first, others)) = subjects.split_first() else { return Vec::new() };
    let block = |subject: &Subject<'_>| match subject {
        Subject::Cause(core, headline) => headlines::block(core, headline, style),
        Subject::Alone(trial) if style.is_verbose() => full_block(trial, style),
        Subject::Alone(trial) => brief_block(trial, style),
    };
    let mut lines = more(others.len().saturating_sub(MOST), Paint::Bad, "FAIL", style);
    lines.extend(others.iter().take(MOST).rev().flat_map(block));
    lines.extend(match first {
        _ if style.is_verbose() => block(first),
        Subject::Alone(trial) => numbers_of(trial, style),
        Subject::Cause(..) => first.witness(tree).map_or(Vec::new(), |t| last_words(t, style)),
    });
    lines
}

/// The first blocks of a kind, and how many more there are.
fn first_of(blocks: Vec<Vec<String>>, paint: Paint, word: &str, style: Style) -> Vec<String> {
    let more = more(blocks.len().saturating_sub(MOST), paint, word, style);
    blocks.into_iter().take(MOST).flatten().chain(more).collect()
}

/// That there are more than are told, if there are.
fn more(number: usize, paint: Paint, word: &str, style: Style) -> Vec<String> {
    match number {
        0 => Vec::new(),
        1 => head(style, paint, word, "1 more is in the report"),
        _ => head(style, paint, word, &format!("{number} more are in the report")),
    }
}

/// What the bench's own components take away of a core's failures.
fn transplants(core: &CoreRecord, style: Style) -> Vec<String> {
    let sentences = sentences(core);
    if sentences.is_empty() {
        return Vec::new();
    }
    let what = format!("failures{}, tried again", on(&core.spec, style));
    let told = sentences.iter().flat_map(|sentence| indented(sentence, style));
    head(style, Paint::Strong, "PROOF", &what).into_iter().chain(told).collect()
}

/// Verdict and size, the numbers, the place, the next command.
pub(crate) fn full_block(trial: &TrialRecord, style: Style) -> Vec<String> {
    let mut lines = brief_block(trial, style);
    lines.push(String::new());
    lines.extend(numbers(trial, style));
    lines.push(String::new());
    lines.extend(labelled("claim", &claim(trial), style));
    lines.extend(labelled("theory", &trial.teaches, style));
    lines.push(command(&trial.rerun));
    lines
}

/// The same below the name of the case, if there is anything.
fn numbers_of(trial: &TrialRecord, style: Style) -> Vec<String> {
    let numbers = numbers(trial, style);
    if numbers.is_empty() {
        return numbers;
    }
    let name = format!("  {}{}", clean(&trial.case), on(&trial.core, style));
    [String::new(), name].into_iter().chain(numbers).collect()
}

/// What was measured, or what a core printed that came to no answer.
fn numbers(trial: &TrialRecord, style: Style) -> Vec<String> {
    let measured = trial.outcome.finding().map(|finding| measures(finding, style));
    measured.into_iter().flatten().chain(last_words(trial, style)).collect()
}

/// Verdict and size: `grep FAIL -A1` finds both.
fn brief_block(trial: &TrialRecord, style: Style) -> Vec<String> {
    let what = clean(&trial.case) + &on(&trial.core, style);
    let mut lines = head_of(trial.outcome.status(), &what, style);
    lines.extend(indented(&trial.outcome.statement(), style));
    lines
}

fn head_of(status: Status, what: &str, style: Style) -> Vec<String> {
    head(style, paint_of(status), &status.word().to_uppercase(), what)
}

/// What fails and is not graded: in few words, unless all is asked for.
fn notes(tree: &RunTree, style: Style) -> Vec<String> {
    let trials = ungraded_failures(tree);
    if trials.is_empty() {
        return Vec::new();
    }
    let told = trials.iter().take(MOST).flat_map(|trial| note(trial, style));
    let what = format!("{} not graded", count(trials.len(), "failure"));
    head(style, Paint::Unknown, "NOTE", &what).into_iter().chain(told).collect()
}

fn note(trial: &TrialRecord, style: Style) -> Vec<String> {
    let words = format!(
        "{}{}, {}: {}",
        clean(&trial.case),
        on(&trial.core, style),
        trial.tier.word(),
        trial.outcome.statement()
    );
    match style.is_verbose() {
        true => indented(&words, style),
        false => briefly(style, |style| indented(&words, style)),
    }
}

/// The end of what a core printed that has crashed or hung.
pub(super) fn last_words(trial: &TrialRecord, style: Style) -> Vec<String> {
    if !matches!(trial.outcome.status(), Status::Crashed | Status::TimedOut) {
        return Vec::new();
    }
    let printed: Vec<_> = trial.printed.lines().filter(|line| !line.trim().is_empty()).collect();
    let last = &printed[printed.len().saturating_sub(LAST_WORDS)..];
    last.iter().flat_map(|line| labelled("printed", line, style)).collect()
}

/// The claim, and the part of a path tracer that it is about.
pub(super) fn claim(trial: &TrialRecord) -> String {
    match Part::of_case(&trial.case) {
        Some(part) => format!("{} ({})", trial.title, part.title),
        None => trial.title.clone(),
    }
}

/// The worst measures as a table, and how many there are besides.
pub(crate) fn measures(finding: &Finding, style: Style) -> Vec<String> {
    if finding.measures.is_empty() {
        return Vec::new();
    }
    let shown = worst_in_order(&finding.measures, MEASURES);
    let mut lines = table(&shown, style);
    let rest = finding.measures.len() - shown.len();
    if rest > 0 {
        let is_wrong = |measure: &&Measure| measure.verdict == Verdict::Fail;
        let shown_wrong = shown.iter().copied().filter(is_wrong).count();
        let wrong = finding.measures.iter().filter(is_wrong).count() - shown_wrong;
        lines.push(format!("{:INDENT$}  and {rest} more, {wrong} of them wrong", ""));
    }
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
    [brief(&words.name), words.measured, words.expected, words.allowed, words.off_by]
}

/// A name cut before its channel, which tells it from others: `brightness of the wh..., red`.
fn brief(name: &str) -> String {
    let is_channel = |last: &str| {
        let begins = |word: &str| last.starts_with(word);
        begins("luminance") || CHANNELS.iter().any(|channel| begins(&channel.to_string()))
    };
    match name.rsplit_once(", ").filter(|(_, last)| is_channel(last)) {
        Some((of, last)) => {
            let room = NAME.saturating_sub(2 + last.chars().count());
            format!("{}, {last}", cut(of, room))
        }
        None => cut(name, NAME),
    }
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

/// How many trials of each core were not tried, and why: that says nothing about them.
fn untried(tree: &RunTree, status: Status, style: Style) -> Vec<String> {
    let mut of_cores: BTreeMap<&str, Vec<(usize, String)>> = BTreeMap::new();
    for ((core, reason), trials) in by_reason(tree, status) {
        of_cores.entry(core).or_default().push((trials, reason));
    }
    let paragraph = |(core, mut reasons): (&str, Vec<(usize, String)>)| {
        reasons.sort_by_key(|(trials, _)| Reverse(*trials));
        let all: usize = reasons.iter().map(|(trials, _)| trials).sum();
        let (told, others) = reasons.split_at(reasons.len().min(REASONS));
        if let [(_, why)] = &reasons[..] {
            return head_of(status, &format!("{all}{}: {why}", on(core, style)), style);
        }
        let mut lines = head_of(status, &format!("{all}{}", on(core, style)), style);
        lines.extend(told.iter().flat_map(|(n, why)| indented(&format!("{n}: {why}"), style)));
        if !others.is_empty() {
            let rest: usize = others.iter().map(|(trials, _)| trials).sum();
            let why = count(others.len(), "other reason");
            lines.extend(indented(&format!("{rest}: for {why}"), style));
        }
        lines
    };
    of_cores.into_iter().flat_map(paragraph).collect()
}

/// How many graded trials were not tried, by core and reason.
fn by_reason(tree: &RunTree, status: Status) -> BTreeMap<(&str, String), usize> {
    let mut reasons = BTreeMap::new();
    for trial in graded(tree, status) {
        *reasons.entry((&*trial.core, reason(&trial.outcome))).or_default() += 1;
    }
    reasons
}

fn graded(tree: &RunTree, status: Status) -> Vec<&TrialRecord> {
    let mut trials = in_order_of_parts(tree, status);
    trials.retain(|trial| trial.tier.is_graded());
    trials
}

fn reason(outcome: &Outcome) -> String {
    match outcome {
        Outcome::Blocked { by } => format!("{by} failed, and these rest on it"),
        _ => outcome.statement(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_keeps_its_channel() {
        assert_eq!(brief("bounce 2, red"), "bounce 2, red");
        let long = brief("brightness of the whole picture, green");
        assert_eq!(long, "brightness of the wh..., green");
        let whole = brief("pixels that see another shape, of 12123");
        assert_eq!(whole, "pixels that see another sha...");
        assert!(brief("a name without any part that is very long").ends_with("..."));
    }
}
