//! Causes before symptoms: what is wrong in one sentence, what speaks for it, what was ruled out, where to look, and
//! one command.

use super::layout::{command, head, indented, labelled, on};
use super::style::{Paint, Style, clean};
use crate::diagnosis::{Degree, Diagnosis, Headline};
use crate::report::digest::capitalised;
use crate::text::number;

/// Causes told; a core that is wrong everywhere is not helped by a page of them.
const MOST: usize = 6;
/// Cases named of those that a cause explains.
const CASES: usize = 4;

/// The causes of every core, the one to look at first in front. What has one failure and no cause has a block below.
pub(crate) fn all(diagnoses: &[(&str, &Diagnosis)], style: Style) -> Vec<String> {
    let of_core = |(core, diagnosis): &(&str, &Diagnosis)| {
        let headlines: Vec<_> = diagnosis.headlines.iter().filter(|h| !h.is_alone()).collect();
        let told = headlines.iter().take(MOST);
        let mut lines: Vec<_> = told.flat_map(|told| block(core, told, style)).collect();
        lines.extend(further(core, headlines.len(), style));
        lines
    };
    diagnoses.iter().flat_map(of_core).collect()
}

/// How many headlines there are, where not all are told.
fn further(core: &str, headlines: usize, style: Style) -> Vec<String> {
    if headlines <= MOST {
        return Vec::new();
    }
    let on = on(core, style);
    let what =
        format!("{MOST} of {headlines} headlines{on}; all are in the report: cargo furnace report");
    head(style, Paint::Bad, "FAIL", &what)
}

/// `grep FAIL -A2` finds verdict and cause.
fn block(core: &str, headline: &Headline, style: Style) -> Vec<String> {
    let what = format!("{}{}: {}", count(headline), on(core, style), cases(headline));
    let mut lines = match headline.tier.is_graded() {
        true => head(style, Paint::Bad, "FAIL", &what),
        false => {
            let what = format!("{what} ({}, not graded)", headline.tier.word());
            head(style, Paint::Unknown, "NOTE", &what)
        }
    };
    lines.push(String::new());
    let sentence = indented(&format!("{}.", capitalised(&headline.mistake)));
    lines.extend(sentence.iter().map(|line| style.paint(Paint::Strong, line)));
    lines.push(String::new());
    lines.extend(headline.evidence.iter().flat_map(|evidence| labelled("seen", evidence)));
    lines.extend(headline.ruled_out.iter().flat_map(|ruled_out| labelled("not", ruled_out)));
    let places = [("where", &headline.look_at), ("fix", &headline.fix)];
    let places = places.into_iter().filter(|(_, words)| !words.is_empty());
    lines.extend(places.flat_map(|(label, words)| labelled(label, words)));
    lines.push(command(&headline.command));
    lines
}

/// `one cause explains 3 failures`, and how many more may follow or were not tried.
fn count(headline: &Headline) -> String {
    let failures = number::count(headline.explains.len(), "failure");
    let mut words = match headline.degree {
        Degree::Named => format!("one cause explains {failures}"),
        Degree::LooksLike => format!("looks like one cause of {failures}"),
        Degree::DiffersHere => format!("differs here: {failures} without a known cause"),
    };
    if !headline.may_follow.is_empty() {
        words += &format!(", {} more may follow from it", headline.may_follow.len());
    }
    if headline.blocked > 0 {
        words += &format!(", {} blocked by it", headline.blocked);
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
