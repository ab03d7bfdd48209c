//! A cause in the page: the mistake in one sentence, how sure that is, what speaks for it, what takes it away, where to
//! look, one command, and the failing cases that it explains.

use super::parts::{command, folded_rows, with_code};
use super::{Place, View, plot};
use crate::case::PARTS;
use crate::diagnosis::{Degree, Headline};
use crate::report::digest::capitalised;
use crate::report::transplants::proofs;
use crate::report::tree::RunTree;
use crate::run::TrialRecord;
use crate::text::number::count;
use maud::{Markup, html};

/// Failing cases of a cause that are listed before the others are folded away.
const CASES: usize = 5;
/// Sentences that are shown before the others are folded away.
const SENTENCES: usize = 3;
/// Causes that are printed whole, and those of which paper says what, where and how to mend it.
const PRINTED_WHOLE: usize = 2;
pub(super) const PRINTED: usize = 6;

/// The causes of all cores with the core of each, what is graded first. One failure without a cause is no headline.
pub(super) fn told(tree: &RunTree) -> Vec<(&str, &Headline)> {
    let of_core = |(core, diagnosis)| {
        let headlines: &Vec<Headline> = diagnosis;
        headlines.iter().map(move |headline| (core, headline))
    };
    let diagnoses = tree.diagnoses().into_iter().map(|(core, d)| (core, &d.headlines));
    let mut told: Vec<_> =
        diagnoses.flat_map(of_core).filter(|(_, headline)| !headline.is_alone()).collect();
    told.sort_by_key(|(_, headline)| !headline.tier.is_graded());
    told
}

/// The card of cause `number` of `all`.
pub(super) fn card(
    view: &View<'_>,
    core: &str,
    headline: &Headline,
    [number, all]: [usize; 2],
) -> Markup {
    let part = headline.part();
    let part = PARTS.iter().find(|known| known.number == part);
    html! {
        div.card.first.beside[!headline.tier.is_graded()].further[number > PRINTED_WHOLE].unprinted[number > PRINTED] {
            p.kicker {
                @if number == 1 { b { "Start here. " } }
                @if all > 1 { (number) " of " (all) " · " }
                @if !headline.tier.is_graded() { "not graded · " }
                @if view.has_several_cores() { "on " b { (core) } " · " }
                @if let Some(part) = part { "part " (part.number) ", " (part.title) }
            }
            h3.said { (sentence(&headline.mistake)) }
            @let [degree, certainty] = certainty(headline);
            p.degree { b { (degree) } ": " (certainty) "." }
            (what_to_do(headline))
            (command(&headline.command))
            (reasons(view.tree, core, headline))
            @if let Some(plot) = evidence_plot(view.tree, core, headline, number == 1) { (plot) }
            (cases(view, core, headline))
        }
    }
}

/// The causes of a failure, where it stands by itself: in a sentence each, where to look, what to mend, and the way to
/// all that is known of it.
pub(super) fn of_failure(view: &View<'_>, trial: &TrialRecord) -> Markup {
    let concerns = |(core, headline): &(&str, &Headline)| {
        *core == trial.core && headline.accounts_for(&trial.case)
    };
    html! {
        @for (_, headline) in told(view.tree).into_iter().filter(concerns) {
            p.degree {
                b { (degree_of(headline, &trial.case)) } ": " (sentence(&headline.mistake)) " "
                @if view.place != Place::Alone {
                    (view.way("index.html#start", &reach(headline)))
                }
            }
            (what_to_do(headline))
        }
    }
}

/// How much more is known of it.
fn reach(headline: &Headline) -> String {
    match headline.explains.len() {
        0 | 1 => "What speaks for it.".to_owned(),
        failures => format!("{} in all.", count(failures, "failure")),
    }
}

/// How sure the cause of this case is.
fn degree_of(headline: &Headline, case: &str) -> String {
    match headline.explains.iter().any(|known| known == case) {
        true => {
            let [degree, _] = certainty(headline);
            degree
        }
        false => "May follow from".to_owned(),
    }
}

/// The plot of a failing case that says the most.
fn evidence_plot(
    tree: &RunTree,
    core: &str,
    headline: &Headline,
    is_first: bool,
) -> Option<Markup> {
    let explained = trials(tree, core, &headline.explains);
    let findings: Vec<_> = explained.iter().filter_map(|trial| trial.outcome.finding()).collect();
    Some(plot::most_telling(&findings, is_first)?.markup())
}

/// How sure that is, and what it means.
fn certainty(headline: &Headline) -> [String; 2] {
    let what = match headline.degree {
        Degree::Named => "this mistake alone predicts the numbers",
        Degree::LooksLike => "it fits, and others may too",
        Degree::DiffersHere if headline.is_ending => {
            return ["Seen", "no answer came, so nothing was judged"].map(str::to_owned);
        }
        Degree::DiffersHere if !headline.laws.is_empty() => {
            "where, by how much, and what gives the wrong numbers"
        }
        Degree::DiffersHere => "where and by how much; no cause is known",
    };
    [capitalised(headline.degree.word()), what.to_owned()]
}

/// What differs without a known cause is no reason.
const fn fails(headline: &Headline) -> &'static str {
    match headline.degree {
        Degree::DiffersHere if !headline.is_ending => "Failing here",
        _ => "Failing because of it",
    }
}

/// Before why: a phone shows little at once.
fn what_to_do(headline: &Headline) -> Markup {
    html! {
        dl.cause {
            @if !headline.look_at.is_empty() {
                dt { "where" } dd { (sentence(&headline.look_at)) }
            }
            @if !headline.fix.is_empty() { dt { "fix" } dd { (with_code(&headline.fix)) } }
        }
    }
}

fn reasons(tree: &RunTree, core: &str, headline: &Headline) -> Markup {
    html! {
        dl.cause {
            (list("seen", &headline.evidence))
            (list("proof", &proofs_of(tree, core, headline)))
            (list("ruled out", &headline.ruled_out))
        }
    }
}

/// What putting the bench's own components in place has taken away of these failures.
fn proofs_of(tree: &RunTree, core: &str, headline: &Headline) -> Vec<String> {
    let record = tree.run.cores.iter().find(|record| record.spec == core);
    record.map(|record| proofs(record, &headline.explains)).unwrap_or_default()
}

fn list(label: &str, sentences: &[String]) -> Markup {
    let (shown, rest) = sentences.split_at(SENTENCES.min(sentences.len()));
    html! {
        @if !sentences.is_empty() {
            dt.reason { (label) }
            dd.reason {
                @for words in shown { p { (sentence(words)) } }
                @if !rest.is_empty() {
                    details.rest {
                        summary { (rest.len()) " more" }
                        @for words in rest { p { (sentence(words)) } }
                    }
                }
            }
        }
    }
}

/// The failures, those that may follow, and how many are blocked.
fn cases(view: &View<'_>, core: &str, headline: &Headline) -> Markup {
    let explained = trials(view.tree, core, &headline.explains);
    let following = trials(view.tree, core, &headline.may_follow);
    html! {
        p.kicker {
            (fails(headline)) ": " b { (explained.len()) }
            @if headline.blocked > 0 { " · blocked by it: " b { (headline.blocked) } }
        }
        (folded_rows(view, &explained, CASES))
        @if !following.is_empty() {
            p.kicker { "May follow from it: " b { (following.len()) } }
            (folded_rows(view, &following, CASES))
        }
    }
}

fn trials<'a>(tree: &'a RunTree, core: &str, cases: &[String]) -> Vec<&'a TrialRecord> {
    let of =
        |case: &String| tree.trials.iter().find(|trial| trial.core == core && trial.case == *case);
    cases.iter().filter_map(of).collect()
}

/// With a full stop, and a capital unless it begins with the name of a case.
fn sentence(words: &str) -> Markup {
    let words = words.trim_end_matches('.');
    let is_name = words.split(' ').next().is_some_and(|word| word.contains('/'));
    let begun = if is_name { words.to_owned() } else { capitalised(words) };
    with_code(&format!("{begun}."))
}
