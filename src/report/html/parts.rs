//! Pieces that several sections share: marks of verdicts, links to cases, commands to copy.

use crate::run::{Status, TrialRecord};
use maud::{Markup, html};

pub(crate) fn class(status: Status) -> &'static str {
    match status {
        Status::TimedOut => "timed-out",
        _ => status.word(),
    }
}

/// The character beside the word, for those who do not see the colour.
pub(crate) fn glyph(status: Status) -> &'static str {
    match status {
        Status::Pass => "✓",
        Status::Fail => "✗",
        Status::Inconclusive => "?",
        Status::Skipped => "–",
        Status::Blocked => "~",
        Status::Crashed => "!",
        Status::TimedOut => "@",
        Status::Broken => "*",
    }
}

pub(crate) fn badge(status: Status) -> Markup {
    html! { span class={ "status " (class(status)) } { (glyph(status)) " " (status.word()) } }
}

/// One trial as a small shape that leads to its case.
pub(crate) fn cell(trial: &TrialRecord) -> Markup {
    let status = trial.outcome.status();
    let words = format!("{} on {}: {}", trial.case, trial.core, status.word());
    html! {
        a class={ "cell " (class(status)) } href=(link(trial)) title=(words) aria-label=(words) {}
    }
}

/// The anchor of a case: its name, which always has a slash, as no section has.
pub(crate) fn case_anchor(trial: &TrialRecord) -> String {
    trial.case.clone()
}

pub(crate) fn anchor(trial: &TrialRecord) -> String {
    format!("{}@{}", trial.case, trial.core)
}

pub(crate) fn link(trial: &TrialRecord) -> String {
    format!("#{}", escaped(&anchor(trial)))
}

/// `text` as it may stand in an address.
pub(crate) fn escaped(text: &str) -> String {
    let escape = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'@' | b'-' | b'_' | b'.' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    };
    text.bytes().map(escape).collect()
}

pub(crate) fn command(text: &str) -> Markup {
    html! {
        div.command {
            code { (text) }
            button.copy.scripted type="button" { "copy" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_single_words() {
        assert!(Status::ALL.into_iter().all(|status| !class(status).contains(' ')));
    }

    #[test]
    fn an_address_holds_no_quote_and_no_space() {
        assert_eq!(escaped("a b\"<%/c"), "a%20b%22%3C%25/c");
    }
}
