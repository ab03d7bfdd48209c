//! Everything needed to repeat the run: cores, conventions, seeds, versions, machine.

use super::conventions::choices;
use super::overview::date;
use super::{Section, View, conventions, kill_matrix, ledger};
use crate::contract::Precision;
use crate::run::RunRecord;
use crate::run::record::CoreRecord;
use crate::text::number::duration;
use crate::worker::Confinement;
use maud::{Markup, html};

pub(super) static SECTION: Section = Section { id: "run", title: "This run", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let run = &view.tree.run;
    Some(html! {
        div.card {
            dl.about {
                dt { "furnace" } dd { (run.furnace) }
                dt { "selected" } dd {
                    @if let Some(suite) = &run.suite { "the suite " code { (suite) } }
                    @else if run.filters.is_empty() { "every case" }
                    @else { code { (run.filters.join(" ")) } }
                }
                dt { "budget" } dd { (run.budget) }
                dt { "seed" } dd { (run.seed) }
                dt { "started" } dd { (date(run.timing.started)) }
                dt { "took" } dd { (took(run)) }
                dt { "machine" } dd {
                    (run.machine.system) ", " (run.machine.architecture) ", "
                    (run.machine.threads) " hardware threads"
                }
                @for core in &run.cores { (about(core)) }
                dt { "error rates" } dd { (ledger::summary(view)) }
                dt { "conventions" } dd { (conventions::summary(view)) }
                dt { "kill matrix" } dd { (kill_matrix::summary(view)) }
            }
        }
    })
}

fn took(run: &RunRecord) -> String {
    run.timing.seconds.map_or_else(|| "incomplete".to_owned(), duration)
}

fn about(core: &CoreRecord) -> Markup {
    let arithmetic = match core.precision {
        Precision::Single => "single precision",
        Precision::Double => "double precision",
    };
    html! {
        dt { "core " b { (core.spec) } }
        dd {
            p { (core.name) " " (core.version) ", " (arithmetic) }
            p {
                @for (name, choice) in choices(core.conventions) {
                    span.choice { (name) ": " (choice) }
                }
            }
            @if let Some(problem) = &core.problem { p { (problem) } }
            details {
                summary { (core.capabilities.len()) " capabilities" }
                p { (core.capabilities.join(", ")) }
            }
            @if let Some(confinement) = &core.confinement { (walls(confinement)) }
        }
    }
}

/// What kept the core from looking up answers and from harming others, and what did not.
fn walls(confinement: &Confinement) -> Markup {
    html! {
        details open[!confinement.lacking.is_empty()] {
            summary { "in a process of its own" }
            ul {
                @for sentence in &confinement.in_force { li { (sentence) } }
                @for sentence in &confinement.lacking { li { b { "not enforced: " } (sentence) } }
            }
        }
    }
}
