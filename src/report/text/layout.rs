//! How the lines of a block stand: their indent, and labels before them.

use super::style::{Paint, Style, clean};

/// Where the text of a block begins.
pub(crate) const INDENT: usize = 8;

/// Lines of what is told briefly: the rest is in the report.
const FEW: usize = 2;

/// An empty line and the first line of a block: `  FAIL  bvh/a on builtin`. It goes on below itself.
pub(crate) fn head(style: Style, paint: Paint, word: &str, what: &str) -> Vec<String> {
    let painted = style.paint(paint, word);
    let before = word.chars().count() + "    ".len();
    let what = clean(what).replace('\n', " ");
    let mut lines = style.wrap(&what, before.max(INDENT)).into_iter();
    let first = format!("  {painted}  {}", lines.next().unwrap_or_default());
    let rest = lines.map(|line| format!("{:INDENT$}{line}", ""));
    [String::new(), first].into_iter().chain(rest).collect()
}

/// ` on builtin`, where there are several cores.
pub(crate) fn on(core: &str, style: Style) -> String {
    if style.names_cores { format!(" on {}", clean(core)) } else { String::new() }
}

/// The last line of a block.
pub(crate) fn command(command: &str) -> String {
    format!("{:INDENT$}try     {}", "", clean(command))
}

/// A paragraph below the first line of a block.
pub(crate) fn indented(text: &str, style: Style) -> Vec<String> {
    style.wrap(text, INDENT).into_iter().map(|line| format!("{:INDENT$}{line}", "")).collect()
}

/// A label and a text that goes on below itself.
pub(crate) fn labelled(label: &str, text: &str, style: Style) -> Vec<String> {
    labelled_at(INDENT, label, text, style)
}

/// The same at another column.
pub(crate) fn labelled_at(column: usize, label: &str, text: &str, style: Style) -> Vec<String> {
    let label_of = |number| if number == 0 { label } else { "" };
    let lines = style.wrap(text, column + 8).into_iter().enumerate();
    lines.map(|(number, line)| format!("{:column$}{:<8}{line}", "", label_of(number))).collect()
}

/// The first few lines of what is laid out, and dots where there is more.
pub(super) fn briefly(style: Style, lay_out: impl Fn(Style) -> Vec<String>) -> Vec<String> {
    let lines = lay_out(style);
    if lines.len() <= FEW {
        return lines;
    }
    let narrower = Style { columns: style.columns.saturating_sub(" …".chars().count()), ..style };
    let mut lines = lay_out(narrower);
    lines.truncate(FEW);
    lines.iter_mut().skip(FEW - 1).for_each(|last| last.push_str(" …"));
    lines
}
