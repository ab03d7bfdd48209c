//! The table of all trials, which can be searched.

use super::parts::{badge, case_name, class, glyph, scrolls};
use super::{Section, View};
use crate::case::Part;
use crate::report::digest::Tally;
use crate::run::{Status, TrialRecord};
use crate::text::number::duration;
use maud::{Markup, html};

pub(super) static SECTION: Section = Section { id: "trials", title: "All trials", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let trials = failures_first(view);
    Some(html! {
        (filter(&Tally::of(&view.tree.trials)))
        @let apart = trials.iter().filter(|trial| !trial.tier.is_graded()).count();
        @if apart > 0 { p.faint { (apart) " of these " (trials.len()) " trials are not graded" } }
        div.card { (scrolls("all trials", &table(view, &trials))) }
    })
}

fn table(view: &View<'_>, trials: &[&TrialRecord]) -> Markup {
    let many = view.has_several_cores();
    html! {
        table #all-trials {
            thead { tr {
                th scope="col" { "outcome" }
                th scope="col" { "case" }
                @if many { th scope="col" { "core" } }
                th scope="col" { "what was found" }
                th.number scope="col" { "time" }
            } }
            tbody { @for trial in trials { (row(view, trial, many)) } }
        }
    }
}

/// What fails, what is not decided, what was not asked, what passes; each in the order of parts.
fn failures_first<'a>(view: &View<'a>) -> Vec<&'a TrialRecord> {
    let mut trials: Vec<_> = view.tree.trials.iter().collect();
    let rank = |status: Status| match status {
        Status::Crashed | Status::TimedOut | Status::Fail => 0,
        Status::Broken | Status::Inconclusive => 1,
        Status::Blocked => 2,
        Status::Skipped => 3,
        Status::Pass => 4,
    };
    trials.sort_by_key(|t| (rank(t.outcome.status()), Part::position(&t.case), &t.case));
    trials
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

fn row(view: &View<'_>, trial: &TrialRecord, many: bool) -> Markup {
    let status = trial.outcome.status();
    html! {
        tr data-status=(class(status)) {
            td.mark { (badge(status)) }
            th scope="row" { (case_name(view, trial)) }
            @if many { td.core { (trial.core) } }
            td.said { (trial.outcome.statement()) }
            td.number { (duration(trial.timing.seconds)) }
        }
    }
}
