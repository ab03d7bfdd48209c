//! Error rates: what every trial has spent of the probability to fail a correct core, and what it would have caught.

use super::parts::{case_name, scrolls};
use super::shell::Page;
use super::view::{Place, View};
use crate::report::digest::{
    by_case, dearest_ledger, ledger, resolution_in_words, worst_resolution,
};
use crate::run::TrialRecord;
use crate::stats::{LedgerEntry, SUITE_FALSE_ALARM, TestKind};
use crate::text::number::{percent, probability, significant};
use maud::{Markup, html};

/// Beside the index.
pub(super) const FILE: &str = "ledger.html";

pub(super) fn page(view: &View<'_>) -> String {
    let body = html! {
        (sums(view))
        div.card { (scrolls("error rates trial by trial", &table(view))) }
    };
    let title = "Error rates and smallest detectable errors".to_owned();
    Page { title, is_index: false, body }.render(view)
}

/// The probability of a false alarm, and the way to the rest.
pub(super) fn summary(view: &View<'_>) -> Markup {
    html! {
        "the probability that a correct core fails any of its trials is at most "
        (probability(dearest_ledger(view.tree).spent()))
        @if view.place != Place::Alone {
            ": " a href={ (view.up()) (FILE) } { "by kind of test and trial by trial" }
        }
    }
}

/// Every core is judged for itself: a book a core.
fn sums(view: &View<'_>) -> Markup {
    html! {
        div.card {
            p {
                "A check that draws random numbers can fail a correct core by chance. The probabilities "
                "below add up to a bound for the whole run, whatever the trials have in common; "
                "checks without noise spend nothing. A suite may spend "
                (probability(SUITE_FALSE_ALARM)) "."
            }
            p {
                "Most tests have several stages, and only what every stage rejects fails. How "
                "often first stages suspect a correct core is known: if the counts below are far "
                "from what is expected, do not trust the bound."
            }
            (scrolls("error rates by kind of test", &books(view)))
        }
    }
}

fn books(view: &View<'_>) -> Markup {
    html! {
        table.small.sums {
            thead { tr {
                @if view.has_several_cores() { th scope="col" { "core" } }
                th scope="col" { "kind of test" }
                th.number scope="col" { "hypotheses" }
                th.number scope="col" { "needed a second look" }
                th.number scope="col" { "expected of a correct core" }
                th.number scope="col" { "would have caught at least" }
                th.number scope="col" { "probability that a correct core fails any, at most" }
            } }
            @for core in &view.tree.run.cores { (book(view, &core.spec)) }
        }
    }
}

fn book(view: &View<'_>, core: &str) -> Markup {
    let ledger = ledger(view.tree.trials_of(core));
    html! {
        tbody {
            @for (kind, entry) in ledger.entries() { (entry_row(view, core, kind, entry)) }
            tr {
                @if view.has_several_cores() { th scope="row" { (core) } }
                th scope="row" { b { "all" } }
                td.number { b { (ledger.hypotheses()) } }
                td.number { b { (ledger.suspected()) } }
                td {}
                td {}
                td.number { b { (probability(ledger.spent())) } }
            }
        }
    }
}

fn entry_row(view: &View<'_>, core: &str, kind: TestKind, entry: LedgerEntry) -> Markup {
    let expected = kind.suspicion().map(|share| share * entry.hypotheses as f64);
    let resolution = worst_resolution(view.tree.trials_of(core), kind);
    html! {
        tr {
            @if view.has_several_cores() { th scope="row" { (core) } }
            th scope="row" { (kind.plural()) }
            td.number { (entry.hypotheses) }
            td.number { @if expected.is_some() { (entry.suspected) } @else { "no stages" } }
            td.number { @if let Some(expected) = expected { (significant(expected, 2)) } }
            td.number { @if let Some(resolution) = resolution { (percent(resolution)) } }
            td.number { (probability(entry.false_alarm)) }
        }
    }
}

fn table(view: &View<'_>) -> Markup {
    let cases = by_case(view.tree);
    html! {
        table {
            thead { tr {
                th scope="col" { "case" }
                @if view.has_several_cores() { th scope="col" { "core" } }
                th.number scope="col" { "probability spent" }
                th scope="col" { "the smallest detectable error" }
            } }
            tbody { @for trial in cases.iter().flat_map(|case| &case.trials) { (row(view, trial)) } }
        }
    }
}

fn row(view: &View<'_>, trial: &TrialRecord) -> Markup {
    html! {
        tr {
            th scope="row" { (case_name(view, trial)) }
            @if view.has_several_cores() { td { (trial.core) } }
            td.number { (probability(ledger([trial]).spent())) }
            td { (resolution_in_words(trial)) }
        }
    }
}
