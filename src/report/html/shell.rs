//! What all pages share: head, header, scripts.

use super::assets::{EARLY_SCRIPT, FOLDER, STYLE, pages_script, viewer_script};
use super::cause::told;
use super::overview;
use super::view::{Place, View};
use crate::report::digest::{Tally, capitalised, failures};
use crate::report::tree::{RunTree, Unfinished};
use crate::run::{Outcome, Status};
use maud::{DOCTYPE, Markup, PreEscaped, html};

pub(super) struct Page {
    pub(super) title: String,
    /// Whether it is the page of the run, and not one that it leads to.
    pub(super) is_index: bool,
    pub(super) body: Markup,
}

/// A page of any kind: what every one has around its body.
pub(super) struct Document {
    pub(super) title: String,
    pub(super) icon: String,
    pub(super) style: Markup,
    pub(super) body: Markup,
}

impl Document {
    pub(super) fn render(self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width,initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    link rel="icon" href=(self.icon);
                    (self.style)
                    script { (PreEscaped(EARLY_SCRIPT)) }
                }
                body { (self.body) }
            }
        };
        // Control characters are no text in HTML; they come from cores that print to terminals.
        page.into_string()
            .replace(|c: char| c.is_control() && !matches!(c, '\n' | '\t'), "\u{fffd}")
    }
}

impl Page {
    pub(super) fn render(self, view: &View<'_>) -> String {
        let tree = view.tree;
        let cores: Vec<_> = tree.run.cores.iter().map(|core| core.spec.as_str()).collect();
        let tally = Tally::of(tree.graded());
        let passes = tally.count(Status::Pass) == tally.total();
        let body = html! {
            a.skip href="#main" { "Skip to the results" }
            (overview::header(view, &self.title, self.is_index))
            main #main .index[self.is_index] { (self.body) }
            (self.scripts(view))
        };
        Document {
            title: format!("{} · {} · furnace", self.title.replace('`', ""), cores.join(" and ")),
            icon: icon(tally.failures() > 0, passes),
            style: self.style(view),
            body,
        }
        .render()
    }

    /// The index is often sent alone: it has its style in itself.
    fn style(&self, view: &View<'_>) -> Markup {
        html! {
            @if self.is_index { style { (PreEscaped(STYLE)) } }
            @else { link rel="stylesheet" href={ (view.up()) (FOLDER) "/report.css" }; }
        }
    }

    fn scripts(&self, view: &View<'_>) -> Markup {
        html! {
            @if self.is_index { script { (PreEscaped(pages_script())) } }
            @else { script src={ (view.up()) (FOLDER) "/page.js" } {} }
            @match (view.place, self.is_index) {
                (Place::Alone, _) => { script { (PreEscaped(viewer_script())) } }
                (_, true) => {}
                _ => { script src={ (view.up()) (FOLDER) "/viewer.js" } {} }
            }
        }
    }
}

/// The first cause, and how many fail; a run that was cut off says so first, and claims nothing of the rest.
pub(super) fn index_title(tree: &RunTree) -> String {
    let counts = tree.counts();
    let counted = counted(&counts.graded);
    match tree.unfinished() {
        None => {}
        Some(Unfinished::Causes) => return format!("Search for causes cut off: {counted}"),
        Some(_) => return unfinished(tree, &counts.graded),
    }
    let absent = tree.absent_cores().next();
    if let Some(core) = absent {
        return format!("{} fails to start: no trial could run", core.spec);
    }
    let graded = told(tree).into_iter().filter(|(_, headline)| headline.tier.is_graded());
    let mut mistakes: Vec<_> = graded.map(|(_, headline)| &headline.mistake).collect();
    mistakes.dedup();
    match mistakes[..] {
        [] => match died(tree) {
            Some(how) => format!("{how}: {counted}"),
            None => capitalised(&counts.headline()),
        },
        [first] => format!("{}: {counted}", capitalised(first)),
        [first, ref others @ ..] => {
            format!("{}, and {} more: {counted}", capitalised(first), others.len())
        }
    }
}

/// What a core was doing when it died or hung, if that comes first.
fn died(tree: &RunTree) -> Option<String> {
    let question = |during: &str| during.split(',').next().unwrap_or_default().to_owned();
    match &failures(tree).first()?.outcome {
        Outcome::Crashed { during, .. } => Some(format!("Crash during {}", question(during))),
        Outcome::TimedOut { during, .. } => Some(format!("No answer to {}", question(during))),
        _ => None,
    }
}

/// `22 fail, 53 blocked`: the page says of how many.
fn counted(tally: &Tally) -> String {
    let blocked = tally.count(Status::Blocked);
    let untried = (blocked > 0).then(|| format!(", {blocked} blocked"));
    format!("{}{}", failing(tally), untried.unwrap_or_default())
}

fn failing(tally: &Tally) -> String {
    match tally.failures() {
        0 => "none fails".to_owned(),
        1 => "1 fails".to_owned(),
        failures => format!("{failures} fail"),
    }
}

fn unfinished(tree: &RunTree, tally: &Tally) -> String {
    let (ended, planned) = (tree.trials.len(), tree.run.trials);
    format!("Unfinished at {ended} of {planned} trials: {} so far", failing(tally))
}

/// A tab's icon: shape and colour of the result.
pub(super) fn icon(fails: bool, passes: bool) -> String {
    let shape = match () {
        () if fails => "%3Ccircle cx='8' cy='8' r='7' fill='%23b3261e'/%3E",
        () if passes => "%3Crect x='2' y='2' width='12' height='12' rx='2' fill='%231a7f4b'/%3E",
        () => "%3Cpath d='M8 0l8 8-8 8-8-8z' fill='%238a5a00'/%3E",
    };
    let svg = "%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E";
    format!("data:image/svg+xml,{svg}{shape}%3C/svg%3E")
}
