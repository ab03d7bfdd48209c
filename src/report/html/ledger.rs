//! Error rates: what every trial has spent of the chance to fail a correct core, and what it would
//! have caught.

use super::parts::link;
use super::{Page, View};
use crate::report::digest::{by_case, false_alarm, resolution_in_words};
use crate::report::number::{count, probability};
use crate::run::TrialRecord;
use maud::{Markup, html};

/// Error budget and resolution.
pub struct Ledger;

impl Page for Ledger {
    fn id(&self) -> &'static str {
        "ledger"
    }

    fn title(&self) -> &'static str {
        "Error rates and resolution"
    }

    fn summary(&self) -> &'static str {
        "what every trial has spent of the error budget, and what it would have caught"
    }

    fn body(&self, view: &View<'_>) -> Option<Markup> {
        Some(html! {
            (sums(view))
            details.card.wide {
                summary { "trial by trial" }
                (table(view))
            }
        })
    }
}

/// Every core is judged for itself: a sum a core.
fn sums(view: &View<'_>) -> Markup {
    html! {
        div.card {
            p {
                "A check that draws random numbers can fail a correct core by chance. The chances "
                "below add up to a bound for the whole run, whatever the trials have in common; "
                "checks without noise spend nothing."
            }
            table.small.sums {
                thead { tr {
                    th scope="col" { "core" }
                    th.number scope="col" { "trials that spend" }
                    th.number scope="col" { "chance that a correct core fails any, at most" }
                } }
                tbody {
                    @for core in &view.tree.run.cores { (sum(view, &core.spec)) }
                }
            }
        }
    }
}

fn sum(view: &View<'_>, core: &str) -> Markup {
    let spends = |trial: &&TrialRecord| false_alarm([*trial]) != 0.0;
    let spending = view.tree.trials_of(core).filter(spends).count();
    html! {
        tr {
            th scope="row" { (core) }
            td.number { (count(spending, "trial")) }
            td.number { b { (probability(false_alarm(view.tree.trials_of(core)))) } }
        }
    }
}

fn table(view: &View<'_>) -> Markup {
    let cases = by_case(view.tree);
    html! {
        table {
            thead { tr {
                th scope="col" { "case" }
                th scope="col" { "core" }
                th.number scope="col" { "chance spent" }
                th scope="col" { "the smallest error it would have caught" }
            } }
            tbody { @for trial in cases.iter().flat_map(|case| &case.trials) { (row(trial)) } }
        }
    }
}

fn row(trial: &TrialRecord) -> Markup {
    html! {
        tr {
            th scope="row" { a href=(link(trial)) { (trial.case) } }
            td { (trial.core) }
            td.number { (probability(false_alarm([trial]))) }
            td { (resolution_in_words(trial)) }
        }
    }
}
