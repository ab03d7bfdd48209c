//! The head of the page, and the first screen: how many of what, and one cell a trial, part by part.

use super::parts::{badge, cell, command, link};
use super::{Page, View};
use crate::report::digest::{
    PartGroup, Tally, by_part, capitalised, dearest_ledger, weakest_first,
};
use crate::run::{Status, TrialRecord};
use crate::text::number::{count, duration, percent, probability};
use maud::{Markup, html};
use std::time::{Duration, UNIX_EPOCH};

pub(super) static PAGE: Page = Page { id: "overview", title: "Overview", body };

fn body(view: &View<'_>) -> Option<Markup> {
    Some(html! {
        (unfinished(view))
        div.top {
            (score(view))
            (grid(view))
        }
    })
}

/// The result, and who was asked what, when, on what.
pub(crate) fn header(view: &View<'_>, headline: &str) -> Markup {
    let run = &view.tree.run;
    html! {
        header {
            h1 { (capitalised(headline)) }
            p.facts {
                @for (number, core) in run.cores.iter().enumerate() {
                    @if number > 0 { " and " }
                    b { (core.name) } " " (core.version)
                }
                " · budget " (run.budget) " · seed " (run.seed) " · " (date(run.timing.started))
                " · " (count(run.machine.threads, "thread"))
                @if let Some(seconds) = run.timing.seconds { " · " (duration(seconds)) }
            }
            button #theme.scripted type="button" { "light / dark" }
        }
    }
}

/// `2026-11-21 03:14 UTC`
pub(crate) fn date(seconds: u64) -> String {
    // Later dates have no four-digit year, and are somebody's mistake.
    const YEAR_10000: u64 = 253_402_300_800;
    if seconds >= YEAR_10000 {
        return format!("second {seconds}");
    }
    let time = UNIX_EPOCH + Duration::from_secs(seconds);
    let text = humantime::format_rfc3339_seconds(time).to_string();
    format!("{} {} UTC", &text[..10], &text[11..16])
}

fn unfinished(view: &View<'_>) -> Markup {
    let (present, planned) = (view.tree.trials.len(), view.tree.run.trials);
    html! {
        @if !view.tree.is_finished() {
            div.card.notice {
                @if view.tree.stopped_at_failure() {
                    strong { "This run stopped at the first failure." }
                } @else {
                    strong { "This run is incomplete." }
                }
                " " (present) " of " (planned) " planned trials have a result; "
                "the others were not run."
                (command(&format!("cargo furnace run --resume {}", view.tree.folder.display())))
            }
        }
    }
}

const FALSE_ALARM: &str = "the probability that a correct core fails any of its trials";
const WEAKEST_PASS: &str = "the largest of the smallest detectable errors";

fn score(view: &View<'_>) -> Markup {
    let tally = Tally::of(view.tree.graded());
    let planned = tally.total() + view.tree.missing();
    html! {
        div.card.score {
            p.large { b { (tally.count(Status::Pass)) } " of " (planned) " pass" }
            ul {
                @for (status, number) in tally.iter() {
                    li { (badge(status)) span.number { (number) } }
                }
                @if view.tree.missing() > 0 {
                    li { "no result" span.number { (view.tree.missing()) } }
                }
                li.fact {
                    a href="#ledger" title=(FALSE_ALARM) { "false alarm" }
                    span.number { "≤ " (probability(dearest_ledger(view.tree).spent())) }
                }
                @if let Some((trial, resolution)) = weakest_first(view.tree.graded()).first() {
                    li.fact {
                        a href=(link(trial)) title=(WEAKEST_PASS) { "weakest pass" }
                        span.number { (percent(*resolution)) }
                    }
                }
            }
        }
    }
}

/// Parts below each other, cores beside each other.
fn grid(view: &View<'_>) -> Markup {
    let cores = &view.tree.run.cores;
    html! {
        div.card.parts {
            table {
                thead { tr {
                    th scope="col" { "part" }
                    @for core in cores { th scope="col" { (core.name) } }
                } }
                tbody {
                    @for group in by_part(&view.tree.trials) {
                        tr {
                            th scope="row" {
                                @if let Some(number) = group.number {
                                    span.part-number { (number) } " "
                                }
                                (group.title)
                            }
                            @for core in cores {
                                td data-label=(core.name) {
                                    @if core.problem.is_some() { "no trial" }
                                    @else { (cells(&group, &core.spec)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn cells(group: &PartGroup<'_>, core: &str) -> Markup {
    let trials: Vec<&TrialRecord> =
        group.trials.iter().copied().filter(|trial| trial.core == core).collect();
    let passes = Tally::of(trials.iter().copied()).count(Status::Pass);
    html! {
        div.strip {
            span.cells { @for trial in &trials { (cell(trial)) } }
            span.fraction {
                @if trials.is_empty() { "no result" } @else { (passes) "/" (trials.len()) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_read_in_utc() {
        assert_eq!(date(1_795_230_840), "2026-11-21 03:14 UTC");
        assert_eq!(date(u64::MAX), format!("second {}", u64::MAX));
    }
}
