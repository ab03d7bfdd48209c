//! The course's write-up of a core: the tables and ladders of images that students hand in, as Markdown and as one
//! page. What is shown is data ([`ladder`]); images are files, and what is there with equal settings is not made again.
//!
//! It shows and times; verdicts are what `furnace run` gives. What a core cannot do stands there as a sentence.

mod bvh;
mod cast;
mod develop;
mod html;
mod ladder;
mod maker;
mod markdown;
mod measured;
mod page;
mod store;

pub(crate) use cast::Cast;
pub(crate) use ladder::Effort;

use crate::contract::CoreInfo;
use crate::cores::{CoreSpec, Hosting};
use crate::render::Shot;
use crate::scene::Library;
use bvh::Mesh;
use ladder::ladders;
use maker::Maker;
use measured::Pace;
use page::Page;
use std::path::{Path, PathBuf};
use store::Store;

/// What is to be written.
pub(crate) struct Plan<'a> {
    pub(crate) core: &'a CoreSpec,
    /// What the core says of itself.
    pub(crate) info: CoreInfo,
    pub(crate) hosting: &'a Hosting,
    pub(crate) scenes: &'a Library,
    pub(crate) cast: &'a Cast,
    pub(crate) effort: Effort,
    pub(crate) folder: &'a Path,
    /// Whether figures of an earlier write-up are made again.
    pub(crate) fresh: bool,
}

impl Plan<'_> {
    /// Every scene that figures ask for.
    fn roles(&self) -> Vec<cast::Role> {
        let ladders = ladders(self.effort);
        let rungs = ladders.iter().flat_map(|ladder| ladder.rungs.iter().map(|rung| rung.role));
        Mesh::all().map(|mesh| mesh.role).chain(rungs).collect()
    }
}

/// Why there is no write-up: its folder takes no files.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WriteupError(String);

impl WriteupError {
    fn new(path: &Path, error: &dyn std::fmt::Display) -> Self {
        Self(format!("cannot write `{}`: {error}", path.display()))
    }
}

/// How it goes on.
pub(crate) struct Told<'a> {
    /// The figure that is made now.
    pub(crate) name: &'a str,
    /// Figures before it, and all.
    pub(crate) figures: [usize; 2],
    /// Samples of a pixel that it has, and all; none before the first.
    pub(crate) samples: Option<[u32; 2]>,
    /// Seconds that the rest may take, once that is known.
    pub(crate) left: Option<f64>,
}

/// The pages of a write-up, and what they do not show.
pub(crate) struct Written {
    pub(crate) markdown: PathBuf,
    pub(crate) page: PathBuf,
    pub(crate) made: usize,
    pub(crate) kept: usize,
    pub(crate) missing: usize,
}

/// A figure or a line of a table: what came of it, or why nothing did.
struct Row<T> {
    label: String,
    /// None where there is no scene.
    shot: Option<Shot>,
    command: String,
    result: Result<T, String>,
}

/// Makes what is not there yet, and writes the pages.
///
/// # Errors
/// If the folder takes no files.
pub(crate) fn write(
    plan: &Plan<'_>,
    tell: &mut dyn FnMut(Told<'_>),
) -> Result<Written, WriteupError> {
    let ladders = ladders(plan.effort);
    let store = Store::at(plan.folder)?;
    let all = Mesh::all().count() + ladders.iter().map(|ladder| ladder.rungs.len()).sum::<usize>();
    let mut maker =
        Maker { plan, store, pace: Pace::of(plan, &ladders), all, done: 0, kept: 0, tell };
    let meshes = Mesh::all().map(|mesh| maker.mesh(mesh)).collect::<Result<Vec<_>, _>>()?;
    let mut shown = Vec::new();
    for ladder in ladders {
        shown.push((maker.ladder(&ladder)?, ladder));
    }
    let missing = unmade(&meshes) + shown.iter().map(|(rows, _)| unmade(rows)).sum::<usize>();
    let (store, kept) = (maker.store, maker.kept);
    let page = Page::new(plan, &store, &meshes, &shown)?;
    Ok(Written {
        markdown: put(&plan.folder.join("writeup.md"), &markdown::text(&page))?,
        page: put(&plan.folder.join("writeup.html"), &html::text(&page))?,
        made: all - kept - missing,
        kept,
        missing,
    })
}

fn unmade<T>(rows: &[Row<T>]) -> usize {
    rows.iter().filter(|row| row.result.is_err()).count()
}

fn put(path: &Path, text: &str) -> Result<PathBuf, WriteupError> {
    let written = crate::disk::replace(path, text.as_bytes());
    written.map(|()| path.to_owned()).map_err(|error| WriteupError::new(path, &error))
}
