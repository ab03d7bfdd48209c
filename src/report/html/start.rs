//! The card that says what to look at first; when nothing failed, what is left to look at.

use super::case::{measures, resolution};
use super::cause;
use super::parts::{badge, cell, command, link};
use super::{Page, View};
use crate::case::Part;
use crate::diagnosis::Headline;
use crate::report::digest::{Tally, failures, slowest_first, weakest_first};
use crate::report::measure::worst_first;
use crate::report::transplants::sentences;
use crate::report::tree::AbsentCore;
use crate::run::{Status, TrialRecord};
use crate::text::number::{duration, percent};
use maud::{Markup, html};

/// Measures in the card; the case has them all.
const MEASURES: usize = 4;
const FURTHER: usize = 6;
/// Rows of the small tables of a green run.
const ROWS: usize = 5;

pub(super) static PAGE: Page = Page { id: "start", title: "Start here", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let absent: Vec<_> = view.tree.absent_cores().collect();
    if absent.is_empty() {
        return of_trials(view);
    }
    let present = View { tree: &view.tree.of_present_cores(), folder: view.folder };
    Some(html! {
        @for core in absent { (does_not_start(core)) }
        @if failures(present.tree).is_empty() { @if let Some(causes) = causes(&present) { (causes) } }
        @else if let Some(card) = of_trials(&present) { (card) }
    })
}

/// What to look at first in the answers of cores.
fn of_trials(view: &View<'_>) -> Option<Markup> {
    let tally = Tally::of(view.tree.graded());
    let causes = causes(view);
    match failures(view.tree).split_first() {
        Some(_) if causes.is_some() => causes,
        Some((first, others)) => Some(html! { (failed(first, others)) (transplants(view)) }),
        None if tally.total() == 0 => causes,
        None => {
            Some(html! { (not_failed(view, &tally)) @if let Some(causes) = causes { (causes) } })
        }
    }
}

/// One cause for every trial of a core: why, what it printed, and how to try that alone.
fn does_not_start(core: AbsentCore<'_>) -> Markup {
    html! {
        div.card.first {
            p.kicker { b { "Start here. " } (badge(core.witness.outcome.status())) }
            h3.said { (core.spec) " fails to start: no trial could run." }
            p { (core.problem) }
            @if !core.witness.printed.is_empty() { pre { (core.witness.printed) } }
            (command(&core.command()))
        }
    }
}

/// The causes of every core, and the failures that no cause explains.
fn causes(view: &View<'_>) -> Option<Markup> {
    let diagnoses = view.tree.diagnoses();
    let mut told: Vec<_> = diagnoses
        .iter()
        .flat_map(|(core, diagnosis)| diagnosis.headlines.iter().map(move |h| (*core, h)))
        .filter(|(_, headline)| !headline.is_alone())
        .collect();
    told.sort_by_key(|(_, headline)| !headline.tier.is_graded());
    let unexplained = |trial: &&TrialRecord| {
        let of_core = diagnoses.iter().filter(|(core, _)| *core == trial.core);
        of_core.clone().any(|(_, diagnosis)| diagnosis.unexplained.contains(&trial.case))
    };
    let others: Vec<_> = failures(view.tree).into_iter().filter(unexplained).collect();
    let kicker = |number: usize, headline: &Headline| match (headline.tier.is_graded(), number) {
        (false, _) => "Not graded.",
        (true, 0) => "Start here.",
        (true, _) => "Then.",
    };
    (!told.is_empty()).then(|| {
        html! {
            @for (number, (core, headline)) in told.iter().enumerate() {
                (cause::card(view.tree, core, headline, kicker(number, headline)))
            }
            (transplants(view))
            @if !others.is_empty() {
                div.card.first { (further(&others)) }
            }
        }
    })
}

/// What the bench's own components take away of the failures of each core.
fn transplants(view: &View<'_>) -> Markup {
    html! {
        @for core in &view.tree.run.cores {
            @let sentences = sentences(core);
            @if !sentences.is_empty() {
                div.card.first {
                    p.kicker { b { "Proof. " } "Failures of " b { (core.name) } ", tried again" }
                    ul { @for sentence in &sentences { li { (sentence) } } }
                }
            }
        }
    }
}

fn failed(first: &TrialRecord, others: &[&TrialRecord]) -> Markup {
    html! {
        div.card.first {
            p.kicker {
                b { "Start here. " } (badge(first.outcome.status())) " "
                a href=(link(first)) { (first.case) } " on " b { (first.core) }
                @if let Some(part) = Part::of_case(&first.case) {
                    " · part " (part.number) ", " (part.title)
                }
            }
            h3.said { (first.outcome.statement()) }
            p { b { "Claim. " } (first.title) ". " b { "Background. " } (first.teaches) }
            @if let Some(finding) = first.outcome.finding() {
                (measures(worst_first(&finding.measures).into_iter().take(MEASURES)))
                (resolution(finding))
            }
            (command(&first.rerun))
            (further(others))
        }
    }
}

fn further(others: &[&TrialRecord]) -> Markup {
    html! {
        @if !others.is_empty() {
            p.kicker { "Next, in the order in which one part rests on another" }
            ul.further {
                @for trial in others.iter().take(FURTHER) { (item(trial)) }
                @if others.len() > FURTHER {
                    li { a href="#trials" { "and " (others.len() - FURTHER) " more" } }
                }
            }
        }
    }
}

fn not_failed(view: &View<'_>, tally: &Tally) -> Markup {
    let passes = tally.count(Status::Pass);
    let all_good = passes == tally.total() && view.tree.is_finished();
    html! {
        div class={ "card " (if all_good { "good" } else { "open" }) } {
            h3 {
                @if all_good { "Every trial passes." }
                @else { "Nothing fails, but not everything is decided." }
            }
            @if !all_good { (unknown(view)) }
            div.two {
                (weakest(view))
                (slowest(view))
            }
        }
    }
}

/// The trials that say nothing about their core.
fn unknown(view: &View<'_>) -> Markup {
    let silent = |trial: &&TrialRecord| trial.outcome.status() != Status::Pass;
    html! {
        ul.further {
            @for trial in view.tree.graded().filter(silent).take(2 * FURTHER) { (item(trial)) }
        }
    }
}

fn item(trial: &TrialRecord) -> Markup {
    html! {
        li {
            (badge(trial.outcome.status())) " "
            a href=(link(trial)) { (trial.case) } " on " (trial.core)
            ": " span.said { (trial.outcome.statement()) }
        }
    }
}

fn weakest(view: &View<'_>) -> Markup {
    html! {
        div {
            h4 { "Weakest passes, with the smallest detectable error of each" }
            table.small {
                @for (trial, resolution) in weakest_first(view.tree.graded()).iter().take(ROWS) {
                    tr { (named(trial)) td.number { (percent(*resolution)) } }
                }
            }
        }
    }
}

fn slowest(view: &View<'_>) -> Markup {
    html! {
        div {
            h4 { "Slowest trials" }
            table.small {
                @for trial in slowest_first(&view.tree.trials).iter().take(ROWS) {
                    tr { (named(trial)) td.number { (duration(trial.timing.seconds)) } }
                }
            }
        }
    }
}

fn named(trial: &TrialRecord) -> Markup {
    html! {
        td.mark { (cell(trial)) }
        td { a href=(link(trial)) { (trial.case) } span.faint { " on " (trial.core) } }
    }
}
