//! Causes before symptoms: what is wrong in one sentence, what speaks for it, what was ruled out, where to look, and
//! one command.

use super::layout::{INDENT, indented, labelled};
use super::style::{Paint, Style, clean};
use crate::diagnosis::{Diagnosis, Headline};

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
    let (word, grade) = match headline.tier.is_graded() {
        true => (style.paint(Paint::Bad, "FAIL"), String::new()),
        false => (
            style.paint(Paint::Unknown, "NOTE"),
            format!(" ({}, not graded)", headline.tier.word()),
        ),
    };
    let (core, cases) = (clean(core), cases(headline));
    let mut lines = vec![
        String::new(),
        format!("  {word}  {} on {core}: {cases}{grade}", count(headline)),
        String::new(),
    ];
    let sentence = format!("{}.", capitalised(&headline.mistake));
    let sentence = indented(&sentence).into_iter();
    lines.extend(sentence.map(|line| style.paint(Paint::Strong, &line)));
    lines.push(String::new());
    lines.extend(headline.evidence.iter().flat_map(|evidence| labelled("seen", evidence)));
    for ruled_out in &headline.ruled_out {
        lines.extend(labelled("not", ruled_out));
    }
    lines.extend(labelled("where", &headline.look_at));
    lines.extend(labelled("fix", &headline.fix));
    lines.push(format!("{:INDENT$}try     {}", "", clean(&headline.command)));
    lines
}

/// `one cause explains 3 failures`, and how many more may follow or were not tried.
fn count(headline: &Headline) -> String {
    let explained = headline.explains.len();
    let mut words = match explained {
        1 => "one cause explains 1 failure".to_owned(),
        _ => format!("one cause explains {explained} failures"),
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

/// A sentence begins with a capital.
fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
