//! Causes before symptoms: what is wrong in one sentence; if all is asked for what speaks for it, what was ruled out,
//! where to look, and one command.

use super::layout::{command, head, indented, labelled, on};
use super::style::{Paint, Style, clean};
use crate::diagnosis::{Degree, Headline};
use crate::report::digest::capitalised;
use crate::text::number;

/// Cases named of those that a cause explains.
const CASES: usize = 4;

/// `grep FAIL -A1` finds the verdict.
pub(super) fn block(core: &str, headline: &Headline, style: Style) -> Vec<String> {
    let what = format!("{}{}: {}", count(headline), on(core, style), cases(headline));
    let mut lines = match headline.tier.is_graded() {
        true => head(style, Paint::Bad, "FAIL", &what),
        false => {
            let what = format!("{what} ({}, not graded)", headline.tier.word());
            head(style, Paint::Unknown, "NOTE", &what)
        }
    };
    let sentence = indented(&sentence(headline), style);
    lines.extend(sentence.iter().map(|line| style.paint(Paint::Strong, line)));
    if style.is_verbose() {
        lines.extend(particulars(headline, style));
    }
    lines
}

/// The mistake as a sentence.
pub(super) fn sentence(headline: &Headline) -> String {
    format!("{}.", capitalised(&headline.mistake))
}

fn particulars(headline: &Headline, style: Style) -> Vec<String> {
    let seen = headline.evidence.iter().flat_map(|seen| labelled("seen", seen, style));
    let not = headline.ruled_out.iter().flat_map(|not| labelled("not", not, style));
    let places = [("where", &headline.look_at), ("fix", &headline.fix)];
    let places = places.into_iter().filter(|(_, words)| !words.is_empty());
    let places = places.flat_map(|(label, words)| labelled(label, words, style));
    seen.chain(not).chain(places).chain([command(&headline.command)]).collect()
}

/// `one cause explains 3 failures`, and how many more may follow or are blocked.
pub(super) fn count(headline: &Headline) -> String {
    let failures = number::count(headline.explains.len(), "failure");
    let mut words = match headline.degree {
        Degree::Named => format!("one cause explains {failures}"),
        Degree::LooksLike => format!("looks like one cause of {failures}"),
        Degree::DiffersHere if headline.is_ending => format!("the core stops here: {failures}"),
        // A law gives the wrong numbers, though nobody has planted that mistake.
        Degree::DiffersHere if !headline.laws.is_empty() => format!("differs here: {failures}"),
        Degree::DiffersHere => format!("differs here: {failures} without a known cause"),
    };
    if !headline.may_follow.is_empty() {
        words += &format!(", {} more may follow", headline.may_follow.len());
    }
    if headline.blocked > 0 {
        words += &format!(", {} blocked", headline.blocked);
    }
    words
}

fn cases(headline: &Headline) -> String {
    let mut named: Vec<_> = headline.explains.iter().take(CASES).map(|c| clean(c)).collect();
    if headline.explains.len() > CASES {
        named.push("…".to_owned());
    }
    named.join(", ")
}
