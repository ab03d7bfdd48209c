//! The head of a page, and the run at a glance: how many of what, and one cell a trial, part by part.

use super::parts::{badge, cell, command, with_code};
use super::view::Place;
use super::{Section, View};
use crate::report::digest::{PartGroup, Tally, by_part};
use crate::report::tree::Unfinished;
use crate::run::{Outcome, Status, TrialRecord};
use crate::text::number::{count, duration};
use maud::{Markup, html};
use std::collections::BTreeMap;
use std::time::{Duration, UNIX_EPOCH};

pub(super) static SECTION: Section = Section { id: "overview", title: "Overview", body };

fn body(view: &View<'_>) -> Option<Markup> {
    Some(html! {
        (unfinished(view))
        (score(view))
        (grid(view))
    })
}

/// The result, and who was asked what, when, on what.
pub(crate) fn header(view: &View<'_>, title: &str, is_index: bool) -> Markup {
    let run = &view.tree.run;
    html! {
        header {
            h1 { (with_code(title)) }
            @if !is_index && view.place != Place::Alone {
                p.facts { a href={ (view.up()) "index.html" } { "← the whole run" } }
            }
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
        @if let Some(why) = view.tree.unfinished() {
            div.card.notice {
                strong {
                    @match why {
                        Unfinished::AtFailure => "This run stopped at the first failure.",
                        Unfinished::OutOfTime => "The time of this run was up.",
                        Unfinished::Trials | Unfinished::Causes => "This run is incomplete.",
                    }
                }
                @match why {
                    Unfinished::Causes => {
                        " Every trial has a result; the search for causes was cut off."
                    }
                    _ => {
                        " " (present) " of " (planned) " planned trials have a result; "
                        "the others were not run."
                    }
                }
                (command(&view.tree.resume()))
            }
        }
    }
}

fn score(view: &View<'_>) -> Markup {
    let counts = view.tree.counts();
    html! {
        div.card.score {
            p.large { b { (counts.graded.count(Status::Pass)) } " pass" }
            ul {
                @for (status, number) in counts.graded.iter().filter(|(status, _)| *status != Status::Pass) {
                    li { (badge(status)) span.number { (number) } }
                }
                @for (number, words) in [(counts.ungraded, "not graded"), (view.tree.missing(), "no result")] {
                    @if number > 0 { li { (words) span.number { (number) } } }
                }
                li { "trials" span.number { (counts.planned) } }
            }
            (untried(view))
        }
    }
}

/// Why trials were not judged: how many for each reason.
fn untried(view: &View<'_>) -> Markup {
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    for trial in view.tree.graded() {
        let reason = match &trial.outcome {
            Outcome::Blocked { by } => format!("blocked by {by}"),
            Outcome::Skipped { missing } => format!("the core lacks {}", missing.join(", ")),
            _ => continue,
        };
        *reasons.entry(reason).or_default() += 1;
    }
    html! {
        @if !reasons.is_empty() {
            details.rest {
                summary { "why these were not judged" }
                ul { @for (reason, number) in &reasons { li { (reason) span.number { (number) } } } }
            }
        }
    }
}

/// Parts below each other, in each the cores.
fn grid(view: &View<'_>) -> Markup {
    let cores: Vec<_> = view.tree.run.cores.iter().filter(|core| core.problem.is_none()).collect();
    html! {
        div.card.parts {
            @for group in by_part(&view.tree.trials) {
                h3 {
                    @if let Some(number) = group.number { span.part-number { (number) } " " }
                    (group.title)
                }
                @for core in &cores {
                    @if cores.len() > 1 { p.core { (core.name) } }
                    (cells(view, &group, &core.spec))
                }
            }
        }
    }
}

fn cells(view: &View<'_>, group: &PartGroup<'_>, core: &str) -> Markup {
    let of_core = |trial: &&TrialRecord| trial.core == core;
    let trials: Vec<&TrialRecord> = group.trials.iter().copied().filter(of_core).collect();
    let asked = Tally::of(group.asked().filter(of_core));
    html! {
        div.strip {
            span.cells { @for trial in &trials { (cell(view, trial)) } }
            span.fraction {
                @if trials.is_empty() { "no result" }
                @else if asked.total() == 0 { "not asked" }
                @else { (asked.count(Status::Pass)) "/" (asked.total()) }
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
