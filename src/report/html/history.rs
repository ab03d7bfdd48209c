//! What became of the cores since earlier runs of the same question.

use super::plot::history::plot;
use super::{Section, View};
use crate::report::history::{History, histories};
use maud::{Markup, html};

pub(super) static SECTION: Section = Section { id: "history", title: "History", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let histories = histories(view.tree);
    let of = |history: &History| match plot(history) {
        Some(figure) => figure.markup(),
        None => html! {
            p.faint { (history.core) ": no earlier run with the same filters and budget has ended in this folder" }
        },
    };
    Some(html! { div.card { @for history in &histories { (of(history)) } } })
}
