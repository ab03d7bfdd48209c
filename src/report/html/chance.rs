//! What the numbers of a run show together: the p-values of its cases.

use super::plot::p_values;
use super::{Section, View};
use maud::{Markup, html};

pub(super) static SECTION: Section = Section { id: "chance", title: "Chance", body };

fn body(view: &View<'_>) -> Option<Markup> {
    let plot = p_values::plot(view.tree)?;
    Some(html! { div.card { (plot) } })
}
