//! The page for the browser: one file that works from disk, without a network, and says the same without scripts.
//!
//! The first screen answers what is wrong and what to do next; everything below is evidence. A
//! section is a `Page` in a file of its own and a line in `PAGES`. Text from cores and cases is
//! escaped by the templates; only our own style sheet and script are not.

mod bounces;
mod case;
mod cause;
mod develop;
mod image;
mod interval;
mod ledger;
mod overview;
mod parts;
mod provenance;
mod start;
mod trials;

use super::ReportError;
use super::digest::Tally;
use super::tree::RunTree;
use crate::disk;
use crate::run::Status;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::path::{Path, PathBuf};

struct Page {
    id: &'static str,
    title: &'static str,
    /// What stands below the heading; none where the run has nothing to show there.
    body: fn(&View<'_>) -> Option<Markup>,
}

static PAGES: &[&Page] =
    &[&overview::PAGE, &start::PAGE, &trials::PAGE, &case::PAGE, &ledger::PAGE, &provenance::PAGE];

#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    pub(crate) tree: &'a RunTree,
    /// The folder of the page, which links are relative to.
    pub(crate) folder: &'a Path,
}

const STYLE: &str = include_str!("assets/report.css");
const SCRIPT: &str = include_str!("assets/report.js");
/// Before anything is drawn: what needs scripts is shown, and the reader's choice of colours holds.
const EARLY_SCRIPT: &str = "{const root=document.documentElement;root.classList.add('js');\
    try{const t=localStorage.getItem('furnace-theme');if(t)root.dataset.theme=t}catch{}}";

/// Writes `index.html` into `folder`, whole or not at all.
///
/// # Errors
/// On an I/O error.
pub fn write(tree: &RunTree, folder: &Path) -> Result<PathBuf, ReportError> {
    let path = folder.join("index.html");
    match disk::replace(&path, render(tree, folder).as_bytes()) {
        Ok(()) => Ok(path),
        Err(error) => Err(ReportError::Io { path, error }),
    }
}

/// The text of the page that is to stand in `folder`.
pub(crate) fn render(tree: &RunTree, folder: &Path) -> String {
    let view = View { tree, folder };
    let tally = Tally::of(tree.graded());
    let cores: Vec<_> = tree.run.cores.iter().map(|core| core.spec.as_str()).collect();
    let title = format!("{} · {} · furnace", headline(tree, &tally), cores.join(" and "));
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width,initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                link rel="icon" href=(icon(&tally));
                style { (PreEscaped(STYLE)) }
                script { (PreEscaped(EARLY_SCRIPT)) }
            }
            body {
                a.skip href="#trials" { "Skip to the results" }
                (overview::header(&view, &headline(tree, &tally)))
                main { @for page in PAGES { (section(page, &view)) } }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    // Control characters are no text in HTML; they come from cores that print to terminals.
    page.into_string().replace(|c: char| c.is_control() && !matches!(c, '\n' | '\t'), "\u{fffd}")
}

fn section(page: &Page, view: &View<'_>) -> Markup {
    let heading = format!("{}-heading", page.id);
    html! {
        @if let Some(body) = (page.body)(view) {
            section id=(page.id) aria-labelledby=(heading) {
                h2 id=(heading) { (page.title) }
                (body)
            }
        }
    }
}

/// The result in a few words; a run that was cut off says so first, and claims nothing of the rest.
fn headline(tree: &RunTree, tally: &Tally) -> String {
    if tree.is_finished() {
        return tally.headline();
    }
    let fail = match tally.failures() {
        0 => "none fails".to_owned(),
        1 => "1 fails".to_owned(),
        failures => format!("{failures} fail"),
    };
    format!("unfinished at {} of {} trials: {fail} so far", tally.total(), tree.run.trials)
}

/// A tab's icon: shape and colour of the result.
fn icon(tally: &Tally) -> String {
    let shape = match () {
        () if tally.failures() > 0 => "%3Ccircle cx='8' cy='8' r='7' fill='%23b3261e'/%3E",
        () if tally.count(Status::Pass) == tally.total() => {
            "%3Crect x='2' y='2' width='12' height='12' rx='2' fill='%231a7f4b'/%3E"
        }
        () => "%3Cpath d='M8 0l8 8-8 8-8-8z' fill='%238a5a00'/%3E",
    };
    let svg = "%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E";
    format!("data:image/svg+xml,{svg}{shape}%3C/svg%3E")
}

#[cfg(test)]
mod tests;
