//! The kill matrix: which mistake is caught by which case, and how that case ended in this run. What a pass excludes.

use super::parts::{cell, scrolls, with_code};
use super::shell::Page;
use super::view::View;
use crate::run::{Excluded, TrialRecord, excluded};
use maud::{Markup, html};

/// Beside the index.
pub(super) const FILE: &str = "kill-matrix.html";

pub(super) fn page(view: &View<'_>) -> String {
    let body = html! {
        div.card {
            p {
                "Each of these mistakes, planted in the textbook core, fails the case beside it; the tests of the bench "
                "hold that. A core that passes the case does not make that mistake, unless another hides it. Most "
                "mistakes fail further cases too; " code { "furnace faults" } " puts each to all of them."
            }
            (scrolls("planted mistakes", &table(view)))
        }
    };
    Page { title: "Kill matrix".to_owned(), is_index: false, body }.render(view)
}

/// The way here.
pub(super) fn summary(view: &View<'_>) -> Markup {
    let words = format!("{} planted mistakes, and the case that catches each", excluded().len());
    view.way(FILE, &words)
}

fn table(view: &View<'_>) -> Markup {
    html! {
        table.small {
            thead { tr {
                th scope="col" { "part" }
                th scope="col" { "what was written" }
                th scope="col" { "caught by" }
                th scope="col" { "in this run" }
                th scope="col" { "told as" }
                th scope="col" { "planted by" }
            } }
            tbody { @for mistake in excluded() { (row(view, &mistake)) } }
        }
    }
}

fn row(view: &View<'_>, mistake: &Excluded) -> Markup {
    let is_it = |trial: &&TrialRecord| trial.case == mistake.caught_by;
    let trials: Vec<_> = view.tree.trials.iter().filter(is_it).collect();
    html! {
        tr {
            td { (mistake.part) }
            td { (with_code(mistake.wrote)) }
            td {
                @match trials.first().and_then(|trial| view.link(trial)) {
                    Some(link) => { a href=(link) { (mistake.caught_by) } }
                    None => { (mistake.caught_by) }
                }
            }
            td {
                @if trials.is_empty() { span.faint { "not tried" } }
                span.cells { @for trial in &trials { (cell(view, trial)) } }
            }
            td { (with_code(mistake.told)) }
            td { code { (mistake.name) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example::Example;
    use crate::report::html::view::Place;
    use std::path::Path;

    #[test]
    fn every_mistake_has_its_row_and_what_was_tried_leads_to_its_case() {
        let mistakes = excluded();
        let mut example = Example::green();
        mistakes[0].caught_by.clone_into(&mut example.trials[0].case);
        let tree = example.tree();
        let page = page(&View::new(&tree, Path::new("."), Place::Top));
        let has = |mistake: &Excluded| page.contains(&format!("<code>{}</code>", mistake.name));
        assert!(mistakes.len() > 100 && mistakes.iter().all(has));
        assert!(page.contains(&format!("href=\"case/{}.html", mistakes[0].caught_by)));
        assert!(page.contains("not tried"));
        assert!(page.contains("<code>d.unit();</code>") && !page.contains("`d.unit"));
    }
}
