//! How the lines of a block stand: their indent, and labels before them.

use super::style::wrap;

/// Where the text of a block begins.
pub(crate) const INDENT: usize = 8;

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
