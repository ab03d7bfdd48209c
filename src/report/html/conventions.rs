//! Conventions: what the contract fixes for every core, and what each core of the run has freely chosen.

use super::parts::{scrolls, with_code};
use super::shell::Page;
use super::view::View;
use crate::contract::{Conventions, RULES};
use maud::{Markup, html};

/// Beside the index.
pub(super) const FILE: &str = "conventions.html";

pub(super) fn page(view: &View<'_>) -> String {
    let body = html! {
        div.card {
            h2.minor { "What the contract fixes" }
            ul { @for rule in rules() { li { (with_code(&rule.replace('*', ""))) } } }
        }
        div.card {
            h2.minor { "What a core chooses, and declares" }
            p {
                "No core is blamed for a choice: cases are judged by what it declares, and a core that does "
                "otherwise than it declares fails."
            }
            (scrolls("conventions", &table(view)))
        }
    };
    Page { title: "Conventions".to_owned(), is_index: false, body }.render(view)
}

/// The way here.
pub(super) fn summary(view: &View<'_>) -> Markup {
    view.way(FILE, "what the contract fixes, and what each core has chosen")
}

/// The points of the list, each as one line.
fn rules() -> Vec<String> {
    let points = RULES.trim_start_matches("- ").split("\n- ");
    points.map(|point| point.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

fn table(view: &View<'_>) -> Markup {
    let cores = &view.tree.run.cores;
    let chosen: Vec<_> = cores.iter().map(|core| choices(core.conventions)).collect();
    let usual = choices(Conventions::default());
    html! {
        table.small {
            thead { tr {
                th scope="col" { "convention" }
                th scope="col" { "where nothing is declared" }
                @for core in cores { th scope="col" { (core.spec) } }
            } }
            tbody { @for (row, (name, choice)) in usual.iter().enumerate() {
                tr {
                    th scope="row" { (name) }
                    td { (choice) }
                    @for of_core in &chosen { td { (of_core[row].1) } }
                }
            } }
        }
    }
}

/// Name and choice of every convention, by the words that files use, so that a new one needs no line here.
pub(super) fn choices(conventions: Conventions) -> Vec<(String, String)> {
    let Ok(serde_json::Value::Object(fields)) = serde_json::to_value(conventions) else {
        return Vec::new();
    };
    let words = |value: &serde_json::Value| match value.as_str() {
        Some(word) => word.replace('-', " "),
        None => value.to_string(),
    };
    fields.iter().map(|(name, value)| (name.replace('-', " "), words(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_of_the_contract_is_one_point() {
        let rules = rules();
        assert!(rules.len() >= 6, "{rules:?}");
        assert!(rules.iter().all(|rule| rule.ends_with('.')), "{rules:?}");
        assert!(rules.iter().all(|rule| rule.matches('`').count() % 2 == 0), "{rules:?}");
    }

    #[test]
    fn every_convention_is_shown_by_its_words() {
        let shown = choices(Conventions::default());
        assert!(shown.contains(&("smith term".to_owned(), "separable".to_owned())), "{shown:?}");
    }
}
