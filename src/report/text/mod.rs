//! The summary that a run ends with on the terminal: each part, what did not pass, and last the ending: verdict, cause,
//! place, fix, next command, in that order.
//!
//! A pure function of the run's folder: no clock, no core, no look at the terminal beyond the
//! [`Style`] it is given.

pub(crate) mod blocks;
mod ending;
mod headlines;
mod layout;
mod style;
mod subject;

pub use style::Style;
use style::mark;
pub(crate) use style::{Detail, Paint, clean, cut, paint_of};

use super::digest::{
    PartGroup, Tally, by_case, by_part, dearest_ledger, resolution_in_words, weakest_first,
};
use super::tree::RunTree;
use crate::contract::Precision;
use crate::run::record::CoreRecord;
use crate::run::{Status, TrialRecord};
use crate::stats::{Ledger, LedgerEntry, SUITE_FALSE_ALARM, TestKind};
use crate::text::number::{count, duration, probability};
use std::collections::BTreeSet;

/// The longest bar of cells in one line; longer ones go on below.
const LONGEST_BAR: usize = 30;
/// Columns of a part's line before its bar, of what passes, and of the time, for which a narrow terminal has no room.
const BEFORE_BAR: usize = 32;
const PASSES: usize = 18;
const TIME: usize = 10;
const WIDE: usize = 72;

/// What a run has shown, for people at a terminal. Where to read on is the caller's to say: only it
/// knows whether a page was written.
pub fn summary(tree: &RunTree, style: Style) -> String {
    let style = Style { names_cores: tree.run.cores.len() > 1, ..style };
    let lines = match style.detail {
        Detail::Counts => ending::totals(tree, style),
        _ => in_full(tree, style),
    };
    lines.join("\n") + "\n"
}

/// That a run was cut off or stopped, and how to go on; nothing of one that has come to its end.
pub(crate) fn unfinished(tree: &RunTree, style: Style) -> String {
    ending::unfinished(tree, style).into_iter().map(|line| line + "\n").collect()
}

fn in_full(tree: &RunTree, style: Style) -> Vec<String> {
    let mut lines = vec![String::new()];
    lines.extend(header(tree, style));
    let present = &tree.of_present_cores();
    for core in &present.run.cores {
        lines.push(String::new());
        lines.extend(core_lines(present, core, style));
    }
    lines.extend(legend(present, style));
    lines.extend(blocks::all(present, style));
    if style.is_verbose() {
        lines.extend(resolutions(tree, style));
        lines.push(String::new());
        lines.extend(chance(tree, style));
        lines.extend(weakest(tree, style));
    }
    lines.extend(ending::ending(tree, present, style));
    lines
}

/// What was asked of whom.
fn header(tree: &RunTree, style: Style) -> Vec<String> {
    let run = &tree.run;
    let cores: Vec<_> = run.cores.iter().map(|core| clean(&core.spec)).collect();
    let mut facts = vec![
        cores.join(" and "),
        count(by_case(tree).len(), "case"),
        format!("seed {}", run.seed),
        format!("budget {}", run.budget),
    ];
    // Of every trial: put in by hand.
    let lent = tree.trials.iter().map(|trial| trial.with).reduce(|all, with| all & with);
    let lent = lent.filter(|with| !with.is_empty());
    facts.extend(lent.map(|with| format!("with the bench's {}", with.in_words())));
    let line = |line| format!("  {}", style.paint(Paint::Strong, line));
    style.wrap(&facts.join(", "), 2).iter().map(|words| line(words)).collect()
}

fn core_lines(tree: &RunTree, core: &CoreRecord, style: Style) -> Vec<String> {
    let trials: Vec<_> = tree.trials_of(&core.spec).collect();
    let name = style.paint(Paint::Strong, &clean(&core.name));
    let arithmetic = match core.precision {
        Precision::Single => "f32",
        Precision::Double => "f64",
    };
    let title = format!("  {name} {} ({arithmetic})", clean(&core.version));
    let groups = by_part(trials);
    let most = groups.iter().map(|group| group.asked().count()).max().unwrap_or(0);
    let bar = most.min(longest_bar(style));
    let mut lines = vec![title];
    if groups.is_empty() {
        lines.push("    no trial has a result".to_owned());
    }
    lines.extend(groups.iter().flat_map(|group| part_lines(group, bar, style)));
    lines
}

fn longest_bar(style: Style) -> usize {
    let time = if style.columns < WIDE { 0 } else { TIME };
    LONGEST_BAR.min(style.columns.saturating_sub(BEFORE_BAR + PASSES + time)).max(1)
}

/// One part: its name, one cell a trial, how many pass, how long it took.
fn part_lines(group: &PartGroup<'_>, bar: usize, style: Style) -> Vec<String> {
    let number = group.number.map_or_else(|| " ".to_owned(), |number| number.to_string());
    let asked: Vec<_> = group.asked().collect();
    let passes = Tally::of(asked.iter().copied()).count(Status::Pass);
    let counts = match asked.len() {
        0 => "not asked".to_owned(),
        asked => format!("{passes} of {asked} pass"),
    };
    let mut rows = asked.chunks(bar.max(1)).map(|row| cells(row, bar, style));
    let first = rows.next().unwrap_or_else(|| " ".repeat(bar));
    let mut head = format!("    {number} {:<25} {first}  {counts:>16}", group.title);
    if style.columns >= WIDE {
        head += &format!(" {:>9}", duration(group.seconds()));
    }
    std::iter::once(head)
        .chain(rows.map(|row| format!("{:BEFORE_BAR$}{row}", "")))
        .map(|line| line.trim_end().to_owned())
        .collect()
}

/// A row of marks, filled up with spaces to `width`. Equal marks share one colour code.
fn cells(trials: &[&TrialRecord], width: usize, style: Style) -> String {
    let statuses: Vec<_> = trials.iter().map(|trial| trial.outcome.status()).collect();
    let mut row = String::new();
    for same in statuses.chunk_by(|a, b| a == b) {
        let marks: String = same.iter().map(|status| mark(*status)).collect();
        row += &style.paint(paint_of(same[0]), &marks);
    }
    row + &" ".repeat(width.saturating_sub(trials.len()))
}

/// What the marks mean, if there are others than passes.
fn legend(tree: &RunTree, style: Style) -> Vec<String> {
    let occurring = Tally::of(&tree.trials);
    let words: Vec<_> = occurring
        .iter()
        .filter(|(status, _)| !matches!(status, Status::Pass | Status::Skipped))
        .map(|(status, _)| format!("{} {}", mark(status), status.word()))
        .collect();
    if words.is_empty() {
        return Vec::new();
    }
    let lines = style.wrap(&words.join("   "), 4).into_iter();
    let lines = lines.map(|line| style.paint(Paint::Faint, &format!("    {line}")));
    std::iter::once(String::new()).chain(lines).collect()
}

fn resolutions(tree: &RunTree, style: Style) -> Vec<String> {
    let heading = style.paint(Paint::Strong, "what each case would have caught");
    let mut lines = vec![String::new(), format!("  {heading}")];
    for case in by_case(tree) {
        lines.push(format!("    {}", clean(&case.first().case)));
        let sentences: BTreeSet<_> =
            case.trials.iter().map(|trial| resolution_in_words(trial)).collect();
        for sentence in sentences {
            let said_by = case.trials.iter().filter(|trial| resolution_in_words(trial) == sentence);
            let cores: Vec<_> = said_by.map(|trial| clean(&trial.core)).collect();
            let text = format!("{}: {sentence}", cores.join(", "));
            lines.extend(style.wrap(&text, 6).into_iter().map(|line| format!("      {line}")));
        }
    }
    lines
}

/// What the dearest ledger says: its sum, and of how many tests of which kind.
fn chance(tree: &RunTree, style: Style) -> Vec<String> {
    let ledger = dearest_ledger(tree);
    let (spent, whole) = (probability(ledger.spent()), probability(SUITE_FALSE_ALARM));
    let mut text = match ledger.is_within_budget() {
        true => format!("probability that a correct core fails any of them: at most {spent}"),
        false => format!(
            "probability that a correct core fails any of them: up to {spent}, more than the {whole} \
             that a suite may spend"
        ),
    };
    if ledger.hypotheses() > 0 {
        text += &format!("\n{}", entries(&ledger));
    }
    style.wrap(&text, 2).into_iter().map(|line| format!("  {line}")).collect()
}

/// `40 hypotheses: 38 means 1.9e-8, 2 pictures 1e-8; 1 needed a second look`
fn entries(ledger: &Ledger) -> String {
    let entry = |(kind, entry): (TestKind, LedgerEntry)| {
        let name = if entry.hypotheses == 1 { kind.singular() } else { kind.plural() };
        format!("{} {name} {}", entry.hypotheses, probability(entry.false_alarm))
    };
    let entries: Vec<_> = ledger.entries().map(entry).collect();
    let hypotheses = match ledger.hypotheses() {
        1 => "1 hypothesis".to_owned(),
        many => format!("{many} hypotheses"),
    };
    let suspected = Some(ledger.suspected()).filter(|count| *count > 0);
    let suspected = suspected.map_or("none".to_owned(), |count| count.to_string());
    format!("{hypotheses}: {}; {suspected} needed a second look", entries.join(", "))
}

fn weakest(tree: &RunTree, style: Style) -> Vec<String> {
    let Some((trial, _)) = weakest_first(tree.graded()).into_iter().next() else {
        return Vec::new();
    };
    let (case, core) = (clean(&trial.case), clean(&trial.core));
    let caught = clean(&resolution_in_words(trial));
    let text = format!("weakest pass: {case} on {core} {caught}");
    style.wrap(&text, 2).into_iter().map(|line| format!("  {line}")).collect()
}

#[cfg(test)]
mod tests;
