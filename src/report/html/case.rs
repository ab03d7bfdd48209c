//! A case with what every core made of it: claim, evidence, pictures, and how to run it again.

use super::image::pictures;
use super::interval::plot;
use super::parts::{anchor, badge, case_anchor, cell, command};
use super::{Page, View};
use crate::case::Part;
use crate::checks::{Finding, Measure};
use crate::report::digest::{CaseGroup, by_case};
use crate::report::measure::{MeasureWords, worst_first};
use crate::run::TrialRecord;
use crate::stats::Verdict;
use crate::text::number::duration;
use maud::{Markup, html};

/// Measures shown before the rest is folded away.
const MEASURES: usize = 16;

pub(super) static PAGE: Page = Page { id: "cases", title: "Cases", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let cases = by_case(view.tree);
    let part = |case: &CaseGroup<'_>| Part::of_case(&case.first().case);
    Some(html! {
        @for same_part in cases.chunk_by(|a, b| part(a) == part(b)) {
            h3.part { (part(&same_part[0]).map_or("other cases", |part| part.title)) }
            @for case in same_part { (section(view, case)) }
        }
    })
}

/// Folded away unless something failed.
fn section(view: &View<'_>, case: &CaseGroup<'_>) -> Markup {
    let shared = case.first();
    let failed = case.trials.iter().any(|trial| trial.outcome.status().is_failure());
    html! {
        details.case.card id=(case_anchor(shared)) open[failed] {
            summary {
                span.cells { @for trial in &case.trials { (cell(trial)) } }
                span.case-name { (shared.case) }
                span.case-title { (shared.title) }
            }
            (about(shared))
            @for trial in &case.trials { (judgement(trial)) }
            (pictures(view, case))
        }
    }
}

fn about(trial: &TrialRecord) -> Markup {
    html! {
        dl.about {
            dt { "background" } dd { (trial.teaches) }
            dt { "source" } dd { (trial.source) }
            dt { "check" } dd { code { (trial.check) } " · case " (hash(&trial.case_hash)) }
            @if let Some(scene) = &trial.scene {
                dt { "scene" } dd { code { (scene.name) } " " (hash(&scene.hash)) }
            }
        }
    }
}

/// Enough of a hash to compare by eye; the whole of it on hovering.
fn hash(hex: &str) -> Markup {
    let short: String = hex.chars().take(12).collect();
    html! { code.faint title=(hex) { (short) } }
}

fn judgement(trial: &TrialRecord) -> Markup {
    html! {
        article id=(anchor(trial)) tabindex="-1" {
            h4 {
                (badge(trial.outcome.status())) " " (trial.core)
                span.faint { " · " (duration(trial.timing.seconds)) " · seed " (trial.seed) }
                @if !trial.with.is_empty() {
                    span.faint { " · with the bench's " (trial.with.in_words()) }
                }
            }
            p.said { (trial.outcome.statement()) }
            @if let Some(finding) = trial.outcome.finding() {
                (all_measures(finding))
                (resolution(finding))
            }
            @if !trial.printed.is_empty() {
                details { summary { "what the core printed" } pre { (trial.printed) } }
            }
            (command(&trial.rerun))
        }
    }
}

/// Every measure: in their own order if they are few, else the worst first and the rest folded away.
fn all_measures(finding: &Finding) -> Markup {
    if finding.measures.len() <= MEASURES {
        return measures(&finding.measures);
    }
    let sorted = worst_first(&finding.measures);
    let (shown, rest) = sorted.split_at(MEASURES);
    html! {
        (measures(shown.iter().copied()))
        details.rest {
            summary { (rest.len()) " more measures" }
            (measures(rest.iter().copied()))
        }
    }
}

pub(crate) fn measures<'a>(measures: impl IntoIterator<Item = &'a Measure>) -> Markup {
    let measures: Vec<_> = measures.into_iter().collect();
    let noisy = measures.iter().any(|measure| measure.interval.is_some());
    html! {
        @if !measures.is_empty() {
            div.wide {
                table.measures {
                    thead { tr {
                        th scope="col" { "measure" }
                        @for name in ["measured", "expected", "allowed", "ratio"] {
                            th.number scope="col" { (name) }
                        }
                        @if noisy {
                            th.number scope="col" { "99.9 % CI" }
                            th scope="col" { "confidence interval and tolerance band" }
                        }
                        th.number scope="col" { "catches" }
                        th scope="col" { "" }
                    } }
                    tbody { @for measure in measures { (row(measure, noisy)) } }
                }
            }
        }
    }
}

fn row(measure: &Measure, noisy: bool) -> Markup {
    let words = MeasureWords::of(measure);
    let ratio = if words.ratio.is_empty() { &words.off_by } else { &words.ratio };
    html! {
        tr.wrong[measure.verdict == Verdict::Fail] {
            th scope="row" { (words.name) }
            td.number { b { (words.measured) } }
            td.number { (words.expected) }
            td.number { (words.allowed) }
            td.number { (ratio) }
            @if noisy { td.number { (words.interval) } td.plot { (plot(measure)) } }
            td.number { (words.resolution) }
            td { (badge(measure.verdict.into())) }
        }
    }
}

/// The smallest error that the trial would have caught.
pub(crate) fn resolution(finding: &Finding) -> Markup {
    html! {
        @if !finding.resolution.is_empty() {
            p.resolution { b { "Smallest detectable error. " } (finding.resolution) }
        }
    }
}
