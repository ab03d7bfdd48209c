//! Causes before symptoms: what is wrong in one sentence, what speaks for it, what was ruled out, where to look, and
//! one command.

use super::layout::{command, head, indented, labelled};
use super::style::{Paint, Style, clean};
use crate::diagnosis::{Diagnosis, Headline};
use crate::report::digest::capitalised;
use crate::text::number;

/// Causes told; a core that is wrong everywhere is not helped by a page of them.
const MOST: usize = 3;
/// Cases named of those that a cause explains.
const CASES: usize = 4;

/// The causes of every core, the one to look at first in front.
pub(crate) fn all(diagnoses: &[(&str, &Diagnosis)], style: Style) -> Vec<String> {
    let of_core = |(core, diagnosis): &(&str, &Diagnosis)| {
        let told = diagnosis.headlines.iter().take(MOST);
        told.flat_map(|headline| block(core, headline, style)).collect::<Vec<_>>()
    };
    diagnoses.iter().flat_map(of_core).collect()
}

/// `grep FAIL -A2` finds verdict and cause.
fn block(core: &str, headline: &Headline, style: Style) -> Vec<String> {
    let what = format!("{} on {}: {}", count(headline), clean(core), cases(headline));
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
    lines.extend(labelled("where", &headline.look_at));
    lines.extend(labelled("fix", &headline.fix));
    lines.push(command(&headline.command));
    lines
}

/// `one cause explains 3 failures`, and how many more may follow or were not tried.
fn count(headline: &Headline) -> String {
    let mut words =
        format!("one cause explains {}", number::count(headline.explains.len(), "failure"));
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
