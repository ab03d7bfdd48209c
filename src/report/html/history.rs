//! What became of the cores since earlier runs of the same question.

use super::plot::{history::plot, tell_once};
use super::{Section, View};
use crate::report::history::histories;
use maud::{Markup, html};

pub(super) static SECTION: Section = Section { id: "history", title: "History", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let histories = histories(view.tree);
    let mut plots: Vec<_> = histories.iter().filter_map(plot).collect();
    tell_once(&mut plots);
    let alone = histories.iter().filter(|history| history.runs.len() < 2);
    Some(html! {
        div.card {
            @for plot in &plots { (plot.markup()) }
            @for history in alone {
                p.faint { (history.core) ": no earlier run with the same filters and budget has ended in this folder" }
            }
        }
    })
}
