//! How the lines of a block stand: their indent, and labels before them.

use super::style::{Paint, Style, clean, wrap};

/// Where the text of a block begins.
pub(crate) const INDENT: usize = 8;

/// An empty line and the first line of a block: `  FAIL  bvh/a on builtin`.
pub(crate) fn head(style: Style, paint: Paint, word: &str, what: &str) -> Vec<String> {
    vec![String::new(), format!("  {}  {what}", style.paint(paint, word))]
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
pub(crate) fn indented(text: &str) -> Vec<String> {
    wrap(text, INDENT).into_iter().map(|line| format!("{:INDENT$}{line}", "")).collect()
}

/// A label and a text that goes on below itself.
pub(crate) fn labelled(label: &str, text: &str) -> Vec<String> {
    let label_of = |number| if number == 0 { label } else { "" };
    let lines = wrap(text, INDENT + 8).into_iter().enumerate();
    lines.map(|(number, line)| format!("{:INDENT$}{:<8}{line}", "", label_of(number))).collect()
}
