//! A cause in the page: the mistake in one sentence, what speaks for it, what was ruled out, where to look, one
//! command.

use super::bounces;
use super::parts::{command, escaped};
use crate::case::Part;
use crate::diagnosis::Headline;
use crate::report::digest::capitalised;
use crate::report::tree::RunTree;
use maud::{Markup, html};

/// Cases named of those that a cause explains.
const CASES: usize = 8;

pub(crate) fn card(tree: &RunTree, core: &str, headline: &Headline, kicker: &str) -> Markup {
    let part = headline.explains.first().and_then(|case| Part::of_case(case));
    html! {
        div.card.first.beside[!headline.tier.is_graded()] {
            p.kicker {
                b { (kicker) } " on " b { (core) }
                " · " (headline.degree.word())
                @if let Some(part) = part { " · part " (part.number) ", " (part.title) }
            }
            h3.said { (sentence(&headline.mistake)) }
            @if let Some(plot) = bounces::plot(tree, core, headline) { (plot) }
            dl.cause {
                (list("seen", &headline.evidence))
                (list("ruled out", &headline.ruled_out))
                @if !headline.look_at.is_empty() {
                    dt { "where" } dd { (sentence(&headline.look_at)) }
                }
                @if !headline.fix.is_empty() { dt { "fix" } dd { (headline.fix) } }
                dt { "explains" } dd { (explained(core, headline)) }
            }
            (command(&headline.command))
        }
    }
}

fn list(label: &str, sentences: &[String]) -> Markup {
    html! {
        @if !sentences.is_empty() {
            dt { (label) }
            dd { @for sentence in sentences { p { (sentence) } } }
        }
    }
}

/// The failures, those that may follow, and how many were not tried.
fn explained(core: &str, headline: &Headline) -> Markup {
    html! {
        (cases(core, &headline.explains))
        @if !headline.may_follow.is_empty() {
            "; these may follow from it: " (cases(core, &headline.may_follow))
        }
        @if headline.blocked > 0 {
            "; " (headline.blocked) " were not tried because of it"
        }
    }
}

fn cases(core: &str, cases: &[String]) -> Markup {
    html! {
        @for (number, case) in cases.iter().take(CASES).enumerate() {
            @if number > 0 { ", " }
            a href=(format!("#{}", escaped(&format!("{case}@{core}")))) { (case) }
        }
        @if cases.len() > CASES { " and " (cases.len() - CASES) " more" }
    }
}

/// With a capital and a full stop.
fn sentence(words: &str) -> String {
    format!("{}.", capitalised(words))
}
