//! The table of all trials, which can be searched.

use super::parts::{badge, class, glyph, link};
use super::{Page, View};
use crate::report::digest::{Tally, by_case};
use crate::run::TrialRecord;
use crate::text::number::duration;
use maud::{Markup, html};

pub(super) static PAGE: Page = Page { id: "trials", title: "All trials", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let cases = by_case(view.tree);
    let trials = cases.iter().flat_map(|case| &case.trials);
    Some(html! {
        (filter(&Tally::of(&view.tree.trials)))
        div.card.wide {
            table #all-trials {
                thead { tr {
                    th scope="col" { "outcome" }
                    th scope="col" { "case" }
                    th scope="col" { "core" }
                    th scope="col" { "what was found" }
                    th.number scope="col" { "time" }
                } }
                tbody { @for trial in trials { (row(trial)) } }
            }
        }
    })
}

/// Shown only where scripts run: without them it would do nothing.
fn filter(tally: &Tally) -> Markup {
    html! {
        div.filter.scripted role="search" {
            input #filter type="search" aria-label="Filter trials by words"
                placeholder="words: bvh, builtin, noise …";
            @for (status, number) in tally.iter() {
                button type="button" data-status=(class(status)) aria-pressed="false" {
                    (glyph(status)) " " (number) " " (status.word())
                }
            }
            span #filtered.faint aria-live="polite" {}
        }
    }
}

fn row(trial: &TrialRecord) -> Markup {
    let status = trial.outcome.status();
    html! {
        tr data-status=(class(status)) {
            td.mark { (badge(status)) }
            th scope="row" { a href=(link(trial)) { (trial.case) } }
            td { (trial.core) }
            td.said { (trial.outcome.statement()) }
            td.number { (duration(trial.timing.seconds)) }
        }
    }
}
