//! Feedback in Markdown, for Gradescope and for GitHub: verdict, size, place, cause, next command.
//!
//! Words of cores stand in code spans and blocks, where nothing of them is markup.

use super::{CaseGrade, Grade, Told, hundredths, warning};
use std::fmt::Write;

/// What is wrong with the core, as far as its author may know.
pub(super) fn causes(grade: &Grade) -> String {
    let mut text = String::new();
    if let Some(problem) = &grade.problem {
        _ = write!(text, "**Nothing could be asked.**\n\n{}\n", block(problem));
    }
    for told in &grade.causes {
        text += &cause(told);
    }
    if !grade.warnings.is_empty() {
        let warnings = warning::shown(&grade.warnings).join("\n");
        _ = write!(text, "### What the compiler warned of\n\n{}\n", block(&warnings));
    }
    text
}

fn cause(told: &Told) -> String {
    let mut text = format!("### {}\n\n", plain(&told.in_words()));
    if let Some(seen) = told.evidence.first() {
        _ = writeln!(text, "- **seen** {}", plain(seen));
    }
    for (label, words) in [("where", &told.look_at), ("fix", &told.fix)] {
        if !words.is_empty() {
            _ = writeln!(text, "- **{label}** {}", plain(words));
        }
    }
    if !told.command.is_empty() {
        _ = writeln!(text, "- **try** {}", span(&told.command));
    }
    text + "\n"
}

/// What became of one case.
pub(super) fn case(case: &CaseGrade) -> String {
    let mut text = format!("{}\n", block(&case.statement));
    if case.rows[1] > 1 {
        _ = writeln!(text, "{} of {} rows pass.\n", case.rows[0], case.rows[1]);
    }
    if !case.with.is_empty() {
        _ = writeln!(
            text,
            "Judged with the bench's own {} in place of yours.\n",
            case.with.join(", ")
        );
    }
    if case.points.open > 0.0 {
        let open = hundredths(case.points.open);
        _ = writeln!(
            text,
            "{open} points are open: this is neither proven right nor proven wrong.\n"
        );
    }
    if case.points.are_lost() {
        _ = writeln!(text, "{}\n", plain(&case.teaches));
    }
    if !case.rerun.is_empty() {
        _ = writeln!(text, "{}", span(&case.rerun));
    }
    text
}

/// The table of parts.
pub(super) fn table(grade: &Grade) -> String {
    let mut text = "| part | points | open |\n|---|---:|---:|\n".to_owned();
    let all = grade.parts.iter().map(|part| (part.name.as_str(), part.points));
    for (name, points) in all.chain([("all", grade.points)]) {
        let [earned, of, open] = [points.earned, points.of, points.open].map(hundredths);
        _ = writeln!(text, "| {} | {earned} of {of} | {open} |", plain(name));
    }
    text
}

/// Words in which nothing is markup.
fn plain(words: &str) -> String {
    let escaped = words.chars().flat_map(|letter| {
        let marks = "\\`*_{}[]<>#|!";
        marks.contains(letter).then_some('\\').into_iter().chain([letter])
    });
    escaped.collect::<String>().replace(['\n', '\r'], " ")
}

/// `words`, whatever backticks are in them.
fn span(words: &str) -> String {
    let fence = "`".repeat(longest_fence(words) + 1);
    format!("{fence} {} {fence}", words.replace(['\n', '\r'], " "))
}

fn block(words: &str) -> String {
    let fence = "`".repeat(longest_fence(words).max(2) + 1);
    format!("{fence}text\n{words}\n{fence}\n")
}

fn longest_fence(words: &str) -> usize {
    words.split(|letter| letter != '`').map(str::len).max().unwrap_or(0)
}
