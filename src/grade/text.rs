//! A grade on the terminal: its parts, where points are lost or open, and why.

use super::{CaseGrade, Grade, Standing, Told, hundredths, warning};
use crate::report::text::clean;
use crate::text::number::count;

/// Cases that are told; the rest is in the report.
const MOST: usize = 12;

/// The table.
pub(crate) fn table(grade: &Grade) -> String {
    let mut lines = vec![format!("  {} ({} {})", grade.title, grade.suite, grade.suite_version)];
    lines.push(String::new());
    let width = grade.parts.iter().map(|part| part.name.chars().count()).max().unwrap_or(0).max(4);
    for part in &grade.parts {
        let counting = part.cases.iter().filter(|case| case.standing != Standing::LeftOut).count();
        let passes = part.cases.iter().filter(|case| case.standing == Standing::Pass).count();
        let words = part.points.words();
        lines.push(format!("    {:width$}  {words:<22}  {passes} of {counting} pass", part.name));
    }
    lines.push(format!("    {:width$}  {}", "all", grade.points.words()));
    lines.extend(grade.problem.iter().map(|problem| format!("\n  {}", clean(problem))));
    let mut cases: Vec<_> =
        grade.cases().map(|(_, case)| case).filter(|c| costs(c) > 0.0).collect();
    cases.sort_by(|a, b| costs(b).total_cmp(&costs(a)));
    if !cases.is_empty() {
        lines.push(format!("\n  {} below full points", count(cases.len(), "case")));
    }
    lines.extend(cases.iter().take(MOST).map(|case| row(case)));
    if cases.len() > MOST {
        lines.push(format!("    … and {} more: see the report, or --csv", cases.len() - MOST));
    }
    if !grade.causes.is_empty() {
        lines.push("\n  what is wrong".to_owned());
    }
    lines.extend(grade.causes.iter().flat_map(what_is_wrong));
    if !grade.warnings.is_empty() {
        lines.push("\n  what the compiler warned of".to_owned());
    }
    lines.extend(warning::shown(&grade.warnings).iter().map(|it| format!("    {}", clean(it))));
    lines.join("\n") + "\n"
}

/// The mistake, and below it where to look and what to do.
fn what_is_wrong(told: &Told) -> impl Iterator<Item = String> {
    let rest = [("where", &told.look_at), ("fix", &told.fix)].into_iter();
    let rest = rest.filter(|(_, words)| !words.is_empty());
    let rest = rest.map(|(label, words)| format!("      {label:<5}  {}", clean(words)));
    std::iter::once(format!("    {}", clean(&told.in_words()))).chain(rest)
}

fn costs(case: &CaseGrade) -> f64 {
    case.points.of - case.points.earned
}

/// `  -1.25  fail          shape/rays-meet …, 3 of 4 rows pass`
fn row(case: &CaseGrade) -> String {
    let rows = match case.rows {
        [_, 0 | 1] => String::new(),
        [passing, rows] => format!(", {passing} of {rows} rows pass"),
    };
    let with = match case.with.is_empty() {
        true => String::new(),
        false => format!(", with the bench's {}", case.with.join(", ")),
    };
    let lost = if case.points.are_lost() { -costs(case) } else { 0.0 };
    let word = if lost == 0.0 { "open".to_owned() } else { hundredths(lost).to_string() };
    format!("    {word:>6}  {:<12}  {}{rows}{with}", case.standing.word(), case.case)
}
