//! What to look at first: a card a cause with the failing cases that it explains; when nothing failed, what is left to
//! look at.

use super::case::{measures, resolution};
use super::cause::{self, PRINTED, told};
use super::parts::{badge, case_name, cell, command, folded_rows};
use super::{Section, View};
use crate::case::{Part, best_step};
use crate::contract::Capabilities;
use crate::diagnosis::Headline;
use crate::report::digest::{Tally, capitalised, failures, slowest_first, weakest_first};
use crate::report::measure::worst_first;
use crate::report::transplants::sentences;
use crate::report::tree::AbsentCore;
use crate::run::{Outcome, Status, TrialRecord};
use crate::text::number::{count, duration, percent};
use crate::text::program;
use maud::{Markup, html};

/// Measures in the card; the case has them all.
const MEASURES: usize = 4;
/// Trials that are listed before the others are folded away.
const ROWS: usize = 6;

pub(super) static SECTION: Section = Section { id: "start", title: "Start here", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let absent: Vec<_> = view.tree.absent_cores().collect();
    if absent.is_empty() {
        return Some(of_trials(view));
    }
    let present = View { tree: &view.tree.of_present_cores(), ..*view };
    Some(html! {
        @for core in absent { (does_not_start(core)) }
        @if present.tree.graded().next().is_some() { (of_trials(&present)) }
    })
}

/// What to look at first in the answers of cores.
fn of_trials(view: &View<'_>) -> Markup {
    let tally = Tally::of(view.tree.graded());
    let told = told(view.tree);
    let failures = failures(view.tree);
    html! {
        @for (number, (core, headline)) in told.iter().enumerate() {
            (cause::card(view, core, headline, [number + 1, told.len()]))
        }
        @if told.len() > PRINTED {
            p.printed { (told.len() - PRINTED) " more in the report on screen" }
        }
        @if failures.is_empty() && tally.total() > 0 { (not_failed(view, &tally)) }
        @if told.is_empty() && let Some((first, others)) = failures.split_first() {
            (failed(view, first, others))
        } @else { (unexplained(view, &told, &failures)) }
        (transplants(view, &told))
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

/// Failures that no cause explains, and no card of what differs lists.
fn unexplained(view: &View<'_>, told: &[(&str, &Headline)], failures: &[&TrialRecord]) -> Markup {
    let diagnoses = view.tree.diagnoses();
    let is_open = |trial: &&TrialRecord| {
        let of_core = diagnoses.iter().filter(|(core, _)| *core == trial.core);
        of_core.clone().any(|(_, diagnosis)| diagnosis.unexplained.contains(&trial.case))
    };
    let is_told = |trial: &TrialRecord| {
        told.iter()
            .any(|(core, headline)| *core == trial.core && headline.accounts_for(&trial.case))
    };
    let open: Vec<_> =
        failures.iter().copied().filter(|trial| is_open(trial) && !is_told(trial)).collect();
    html! {
        @if !open.is_empty() {
            div.card.beside {
                p.kicker { "No cause is known for these, in the order in which one part rests on another" }
                (folded_rows(view, &open, ROWS))
            }
        }
    }
}

/// What the bench's own components take away of the failures of each core, all together.
fn transplants(view: &View<'_>, told: &[(&str, &Headline)]) -> Markup {
    html! {
        @for core in &view.tree.run.cores {
            @let sentences = sentences(core);
            // One that takes all of them away stands in its card.
            @if sentences.len() > 1 || told.is_empty() && !sentences.is_empty() {
                div.card.proof {
                    p.kicker { b { "Proof. " } "Failures of " b { (core.name) } ", tried again" }
                    ul { @for sentence in &sentences { li { (sentence) } } }
                }
            }
        }
    }
}

fn failed(view: &View<'_>, first: &TrialRecord, others: &[&TrialRecord]) -> Markup {
    html! {
        div.card.first {
            p.kicker {
                b { "Start here. " } (badge(first.outcome.status())) " "
                (case_name(view, first)) " on " b { (first.core) }
                @if let Some(part) = Part::of_case(&first.case) {
                    " · part " (part.number) ", " (part.title)
                }
            }
            h3.said { (capitalised(&first.outcome.statement())) }
            p { b { "Claim. " } (first.title) ". " b { "Background. " } (first.teaches) }
            @if let Some(finding) = first.outcome.finding() {
                (measures(worst_first(&finding.measures).into_iter().take(MEASURES)))
                (resolution(finding))
            }
            (command(&first.rerun))
            @if !others.is_empty() {
                p.kicker { "Next, in the order in which one part rests on another" }
                (folded_rows(view, others, ROWS))
            }
        }
    }
}

fn not_failed(view: &View<'_>, tally: &Tally) -> Markup {
    let passes = tally.count(Status::Pass);
    let all_good = passes == tally.total() && view.tree.is_finished();
    let silent = |trial: &&TrialRecord| trial.outcome.status() != Status::Pass;
    let unknown: Vec<_> = view.tree.graded().filter(silent).collect();
    let mut unpassed = view.tree.trials.iter().filter(silent);
    html! {
        div class={ "card " (if all_good { "good" } else { "open" }) } {
            @if !all_good { p.kicker { b { "Start here. " } } }
            h3 {
                @if all_good && unpassed.next().is_some() { "Every graded trial passes." }
                @else if all_good { "Every trial passes." }
                @else { "Nothing fails, but not everything is decided." }
            }
            @for core in &view.tree.run.cores { (next_step(view, &core.spec)) }
            (folded_rows(view, &unknown, ROWS))
            div.two {
                (weakest(view))
                (slowest(view))
            }
        }
    }
}

/// What to implement next, if the core lacks something.
fn next_step(view: &View<'_>, core: &str) -> Markup {
    let lacks = |trial: &TrialRecord| match &trial.outcome {
        Outcome::Skipped { missing } => {
            Some((trial.case.clone(), Capabilities::from_names(missing).ok()?))
        }
        _ => None,
    };
    let lacking: Vec<_> = view.tree.trials_of(core).filter_map(lacks).collect();
    let Some(step) = best_step(&lacking) else { return html! {} };
    html! {
        p.said {
            b { "Write next: " } (step.missing.names().join(", ")) ". It opens "
            (count(step.cases.len(), "case")) " of the " (lacking.len()) " that " (core) " was not tried on."
        }
        (command(&format!("{} doctor --core {}", program(), shell_words::quote(core))))
    }
}

fn weakest(view: &View<'_>) -> Markup {
    html! {
        div {
            h4 { "Weakest passes, with the smallest detectable error of each" }
            table.small {
                @for (trial, resolution) in weakest_first(view.tree.graded()).iter().take(ROWS) {
                    tr { (named(view, trial)) td.number { (percent(*resolution)) } }
                }
            }
        }
    }
}

fn slowest(view: &View<'_>) -> Markup {
    let tried = view.tree.trials.iter().filter(|trial| trial.outcome.finding().is_some());
    html! {
        div {
            h4 { "Slowest trials" }
            table.small {
                @for trial in slowest_first(tried).iter().take(ROWS) {
                    tr { (named(view, trial)) td.number { (duration(trial.timing.seconds)) } }
                }
            }
        }
    }
}

fn named(view: &View<'_>, trial: &TrialRecord) -> Markup {
    html! {
        td.mark { (cell(view, trial)) }
        td {
            (case_name(view, trial))
            @if view.has_several_cores() { span.faint { " on " (trial.core) } }
        }
    }
}
