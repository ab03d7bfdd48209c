//! The pages for the browser: they work from disk, without a network, and say the same without scripts.
//!
//! `index.html` answers what is wrong and what to do next; each case has a page with its images, its numbers and
//! its command. A section of the index is a `Section` in a file of its own and a line in `SECTIONS`. Text from
//! cores and cases is escaped by the templates; only our own style sheet and scripts are not.

mod assets;
mod case;
mod cause;
mod chance;
pub(crate) mod comparison;
mod conventions;
pub(crate) mod develop;
mod history;
mod image;
mod interval;
mod kill_matrix;
mod ledger;
mod overview;
mod parts;
mod pixels;
mod plot;
mod provenance;
mod shell;
mod start;
mod trials;
mod view;
mod viewer;

use super::ReportError;
use super::tree::RunTree;
use crate::disk;
use assets::{FOLDER, STYLE, pages_script, viewer_script};
use maud::{Markup, html};
pub(crate) use parts::with_code;
use shell::{Page, index_title};
use std::path::{Path, PathBuf};
use view::{Place, View};

struct Section {
    id: &'static str,
    title: &'static str,
    /// What stands below the heading; none where the run has nothing to show there.
    body: fn(&View<'_>) -> Option<Markup>,
}

/// Of the index; the single file has the failing cases after them.
static SECTIONS: &[&Section] = &[
    &start::SECTION,
    &overview::SECTION,
    &trials::SECTION,
    &chance::SECTION,
    &history::SECTION,
    &provenance::SECTION,
];

/// The text of a page.
type Text = fn(&View<'_>) -> String;

/// Pages beside the index: what the whole run rests on. The section on the run leads to them.
static BESIDE: &[(&str, Text)] = &[
    (ledger::FILE, ledger::page),
    (conventions::FILE, conventions::page),
    (kill_matrix::FILE, kill_matrix::page),
];

/// Writes `index.html` and the pages that it leads to into `folder`, each whole or not at all.
///
/// # Errors
/// On an I/O error.
pub fn write(tree: &RunTree, folder: &Path) -> Result<PathBuf, ReportError> {
    for (name, text) in pages(tree, folder) {
        put(&folder.join(name), &text)?;
    }
    put(&folder.join("index.html"), &index(tree, folder))
}

/// Writes `report.html` into `folder`: one file with the failing cases and their images, to be sent.
///
/// # Errors
/// On an I/O error.
pub(crate) fn write_single(tree: &RunTree, folder: &Path) -> Result<PathBuf, ReportError> {
    put(&folder.join("report.html"), &single(tree, folder))
}

fn put(path: &Path, text: &str) -> Result<PathBuf, ReportError> {
    let written = disk::replace(path, text.as_bytes());
    written.map_err(|error| ReportError::Io { path: path.to_owned(), error })?;
    Ok(path.to_owned())
}

/// Every file but the index, by its name below the folder.
fn pages<'a>(tree: &'a RunTree, folder: &'a Path) -> impl Iterator<Item = (String, String)> + 'a {
    let assets = [
        ("report.css", STYLE.to_owned()),
        ("page.js", pages_script()),
        ("viewer.js", viewer_script()),
    ];
    let assets = assets.into_iter().map(|(name, text)| (format!("{FOLDER}/{name}"), text));
    let beside = BESIDE
        .iter()
        .map(move |(name, page)| ((*name).to_owned(), page(&View::new(tree, folder, Place::Top))));
    assets.chain(beside).chain(case::pages(tree, folder))
}

/// The text of the index that is to stand in `folder`.
fn index(tree: &RunTree, folder: &Path) -> String {
    let view = View::new(tree, folder, Place::Top);
    let sections = html! { @for section in SECTIONS { (section.markup(&view)) } };
    Page { title: index_title(tree), is_index: true, body: sections }.render(&view)
}

/// What mail servers take, bytes; more than what a report may weigh.
const HEAVIEST: usize = 10_000_000;
/// The longest sides that images may have in the page that stands alone, pixels: the first that is light enough.
const SIDES: [usize; 6] = [usize::MAX, 512, 256, 128, 64, 32];

/// The text of the page that stands for all of them. If it is too heavy, it goes without bounces and earlier runs, and then
/// with smaller images.
fn single(tree: &RunTree, folder: &Path) -> String {
    let whole = single_with(View::new(tree, folder, Place::Alone));
    if whole.len() < HEAVIEST {
        return whole;
    }
    let view = View { whole: false, ..View::new(tree, folder, Place::Alone) };
    light_enough(|longest| single_with(View { longest, ..view }))
}

/// The first page that is light enough, of the longest sides that its images may have.
fn light_enough(page: impl Fn(usize) -> String) -> String {
    let light = |page: &String| page.len() < HEAVIEST;
    let [sides @ .., smallest] = SIDES;
    sides.into_iter().map(&page).find(light).unwrap_or_else(|| page(smallest))
}

fn single_with(view: View<'_>) -> String {
    let body = html! {
        @for section in SECTIONS { (section.markup(&view)) }
        (case::failing(&view))
    };
    Page { title: index_title(view.tree), is_index: true, body }.render(&view)
}

impl Section {
    fn markup(&self, view: &View<'_>) -> Markup {
        let heading = format!("{}-heading", self.id);
        html! {
            @if let Some(body) = (self.body)(view) {
                section id=(self.id) aria-labelledby=(heading) {
                    h2 id=(heading) { (self.title) }
                    (body)
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
