//! A case with what every core made of it: verdict, images, numbers, background, and how to run it again.

use super::cause;
use super::image::pictures;
use super::interval;
use super::parts::{badge, command, scrolls};
use super::plot;
use super::shell::Page;
use super::view::{Place, View, anchor, has_failed};
use crate::checks::{Finding, Measure};
use crate::report::digest::{CaseGroup, by_case};
use crate::report::measure::{MeasureWords, worst_first};
use crate::report::tree::RunTree;
use crate::run::TrialRecord;
use crate::stats::Verdict;
use crate::text::number::duration;
use maud::{Markup, html};
use std::path::Path;

/// Measures shown before the rest is folded away.
const MEASURES: usize = 16;

/// The pages on all cases, by their names below the folder.
pub(super) fn pages<'a>(
    tree: &'a RunTree,
    folder: &'a Path,
) -> impl Iterator<Item = (String, String)> + 'a {
    let cases = by_case(tree);
    (0..cases.len()).map(move |number| {
        let case = &cases[number];
        let file = View::file_of(&case.first().case);
        let view = View::new(tree, folder, Place::Below(file.matches('/').count()));
        let body = html! {
            (neighbours(&view, &cases, number))
            (body(&view, case))
        };
        let title = case.first().title.clone();
        (file, Page { title, is_index: false, body }.render(&view))
    })
}

/// The failing cases on one page.
pub(super) fn failing(view: &View<'_>) -> Markup {
    let cases = by_case(view.tree);
    html! {
        section #cases aria-labelledby="cases-heading" {
            h2 #cases-heading { "Failing cases" }
            @for case in cases.iter().filter(|case| has_failed(case)) {
                details.case.card id=(case.first().case) {
                    summary {
                        span.cells { @for trial in &case.trials { (badge(trial.outcome.status())) } }
                        span.case-name { (case.first().case) }
                        span.case-title { (case.first().title) }
                    }
                    (body(view, case))
                }
            }
        }
    }
}

/// The failing cases before and after.
fn neighbours(view: &View<'_>, cases: &[CaseGroup<'_>], number: usize) -> Markup {
    let (before, rest) = cases.split_at(number);
    let before = before.iter().rfind(|case| has_failed(case));
    let after = rest.iter().skip(1).find(|case| has_failed(case));
    let link = |case: &CaseGroup<'_>| view.link(case.first()).unwrap_or_default();
    html! {
        @if before.is_some() || after.is_some() {
            nav.neighbours aria-label="Failing cases" {
                @if let Some(case) = before { a rel="prev" href=(link(case)) { "← " (case.first().case) } }
                span.faint { "failing cases" }
                @if let Some(case) = after { a rel="next" href=(link(case)) { (case.first().case) " →" } }
            }
        }
    }
}

fn body(view: &View<'_>, case: &CaseGroup<'_>) -> Markup {
    html! {
        @for trial in &case.trials { (judgement(view, trial)) }
        (pictures(view, case))
        @for trial in &case.trials { (plots(trial, case.trials.len() > 1)) }
        @for trial in &case.trials { (numbers(trial, case.trials.len() > 1)) }
        (about(case.first(), case.trials.iter().all(|trial| lacks_plots(trial))))
    }
}

fn judgement(view: &View<'_>, trial: &TrialRecord) -> Markup {
    html! {
        article.card id=(anchor(trial)) tabindex="-1" {
            p.kicker {
                (badge(trial.outcome.status())) " · " b { (trial.core) }
                " · " (duration(trial.timing.seconds)) " · seed " (trial.seed)
                @if !trial.with.is_empty() { " · with the bench's " (trial.with.in_words()) }
            }
            p.said.statement { (trial.outcome.statement()) }
            (cause::of_failure(view, trial))
            @if let Some(finding) = trial.outcome.finding() { (resolution(finding)) }
            @if !trial.printed.is_empty() {
                details { summary { "what the core printed" } pre { (trial.printed) } }
            }
            (command(&trial.rerun))
        }
    }
}

fn plots(trial: &TrialRecord, named: bool) -> Markup {
    let plots = trial.outcome.finding().map(plot::of_finding).unwrap_or_default();
    html! {
        @if !plots.is_empty() {
            div.card {
                h2.minor { "Plots" @if named { " of " (trial.core) } }
                @for plot in &plots { (plot.markup()) }
            }
        }
    }
}

fn numbers(trial: &TrialRecord, named: bool) -> Markup {
    let finding = trial.outcome.finding().filter(|finding| !finding.measures.is_empty());
    html! {
        @if let Some(finding) = finding {
            div.card {
                h2.minor { "Numbers" @if named { " of " (trial.core) } }
                (all_measures(finding))
            }
        }
    }
}

fn lacks_plots(trial: &TrialRecord) -> bool {
    trial.outcome.finding().is_none_or(|finding| plot::of_finding(finding).is_empty())
}

fn about(trial: &TrialRecord, lacks_plots: bool) -> Markup {
    html! {
        dl.about.card {
            dt { "case" } dd { code { (trial.case) } " " (hash(&trial.case_hash)) }
            dt { "background" } dd { (trial.teaches) }
            dt { "source" } dd { (trial.source) }
            dt { "check" } dd { code { (trial.check) } }
            @if lacks_plots {
                dt { "plots" } dd { "none: its numbers are all there is" }
            }
            @if let Some(scene) = &trial.scene {
                dt { "scene" } dd { code { (scene.name) } " " (hash(&scene.hash)) ", shown to the core as " (scene.shown) }
            }
        }
    }
}

/// Enough of a hash to compare by eye; the whole of it on hovering.
fn hash(hex: &str) -> Markup {
    let short: String = hex.chars().take(12).collect();
    html! { code.faint title=(hex) { (short) } }
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
    html! { @if !measures.is_empty() { (scrolls("measures", &table(&measures))) } }
}

fn table(measures: &[&Measure]) -> Markup {
    let noisy = measures.iter().any(|measure| measure.interval.is_some());
    html! {
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
                th scope="col" { "verdict" }
            } }
            tbody { @for measure in measures { (row(measure, noisy)) } }
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
            @if noisy { td.number { (words.interval) } td.plot { (interval::plot(measure)) } }
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
