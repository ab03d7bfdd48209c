//! Pieces that several sections share: marks of verdicts, links to cases, commands to copy.

use super::view::View;
use crate::run::{Status, TrialRecord};
use maud::{Markup, html};

/// A table that scrolls sideways where it is wider than the page, with the keyboard too.
pub(crate) fn scrolls(of: &str, table: &Markup) -> Markup {
    html! { div.wide role="group" aria-label=(of) tabindex="0" { (table) } }
}

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
pub(crate) fn cell(view: &View<'_>, trial: &TrialRecord) -> Markup {
    let status = trial.outcome.status();
    let words = format!("{} on {}: {}", trial.case, trial.core, status.word());
    html! {
        @match view.link(trial) {
            Some(link) => { a class={ "cell " (class(status)) } href=(link) title=(words) {} }
            None => { span class={ "cell " (class(status)) } title=(words) {} }
        }
    }
}

/// The name of a trial's case, which leads to it.
pub(crate) fn case_name(view: &View<'_>, trial: &TrialRecord) -> Markup {
    html! {
        @match view.link(trial) {
            Some(link) => { a href=(link) { (trial.case) } }
            None => { (trial.case) }
        }
    }
}

/// Trials below each other: how each ended, and what was found.
pub(crate) fn trial_rows(view: &View<'_>, trials: &[&TrialRecord]) -> Markup {
    html! {
        table.small.rows {
            @for trial in trials {
                tr {
                    td.mark { (badge(trial.outcome.status())) }
                    td {
                        (case_name(view, trial))
                        @if view.has_several_cores() { span.faint { " on " (trial.core) } }
                        p.said.faint { (trial.outcome.statement()) }
                    }
                }
            }
        }
    }
}

/// The first of some trials, and the others folded away.
pub(crate) fn folded_rows(view: &View<'_>, trials: &[&TrialRecord], shown: usize) -> Markup {
    let (first, rest) = trials.split_at(shown.min(trials.len()));
    html! {
        (trial_rows(view, first))
        @if !rest.is_empty() {
            details.rest {
                summary { (rest.len()) " more" }
                (trial_rows(view, rest))
            }
        }
    }
}

/// Words of ours, in which every second piece between backticks is code.
pub(crate) fn with_code(words: &str) -> Markup {
    html! {
        @for (number, piece) in words.split('`').enumerate() {
            @if number % 2 == 1 { code { (piece) } } @else { (piece) }
        }
    }
}

/// A command to copy. A line ends between its words and not at their hyphens.
pub(crate) fn command(text: &str) -> Markup {
    html! {
        div.command {
            code {
                @for (number, word) in text.split(' ').enumerate() {
                    @if number > 0 { " " }
                    span { (word) }
                }
            }
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
}
