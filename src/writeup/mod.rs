//! The course's write-up of a core: the tables and ladders of images that students hand in, as Markdown and as one
//! page. What is shown is data ([`ladder`]); images are files, and what is there with equal settings is not made again.
//!
//! It shows and times; verdicts are what `furnace run` gives. What a core cannot do stands there as a sentence.

mod bvh;
mod cast;
mod develop;
mod html;
mod ladder;
mod markdown;
mod measured;
mod page;
mod store;

pub(crate) use cast::Cast;
pub(crate) use ladder::Effort;

use crate::contract::{Core, CoreError, CoreInfo};
use crate::cores::{CoreSpec, Hosting};
use crate::render::{Output, Request, Shot, missing, renders_codes_alone};
use crate::scene::{Library, SceneDescription};
use bvh::{Mesh, Timed};
use ladder::{Ladder, ladders};
use measured::{Measured, Pace};
use page::Page;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use store::{FIGURES, Figure, Kept, Key, Store};

/// What is to be written.
pub(crate) struct Plan<'a> {
    pub(crate) core: &'a CoreSpec,
    /// What the core says of itself.
    pub(crate) info: CoreInfo,
    pub(crate) hosting: &'a Hosting,
    pub(crate) library: &'a Library,
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
    let meshes = maker.meshes()?;
    let mut shown = Vec::new();
    for ladder in ladders {
        shown.push((maker.ladder(&ladder)?, ladder));
    }
    let missing = meshes.iter().filter(|row| row.result.is_err()).count()
        + shown.iter().flat_map(|(rows, _)| rows).filter(|row| row.result.is_err()).count();
    let (store, kept) = (maker.store, maker.kept);
    let page = Page::new(plan, &store, &meshes, &shown)?;
    let file = |name: &str, text: String| {
        let path = plan.folder.join(name);
        let written = crate::disk::replace(&path, text.as_bytes());
        written.map(|()| path.clone()).map_err(|error| WriteupError::new(&path, &error))
    };
    Ok(Written {
        markdown: file("writeup.md", markdown::text(&page))?,
        page: file("writeup.html", html::text(&page))?,
        made: all - kept - missing,
        kept,
        missing,
    })
}

struct Maker<'a> {
    plan: &'a Plan<'a>,
    store: Store,
    pace: Pace,
    all: usize,
    done: usize,
    kept: usize,
    tell: &'a mut dyn FnMut(Told<'_>),
}

impl Maker<'_> {
    fn meshes(&mut self) -> Result<Vec<Row<Timed>>, WriteupError> {
        Mesh::all().map(|mesh| self.mesh(mesh)).collect()
    }

    fn mesh(&mut self, mesh: Mesh) -> Result<Row<Timed>, WriteupError> {
        let name = format!("bvh-{}", mesh.role.name);
        let shot = mesh.shot(self.plan.cast, self.plan.effort.size);
        let label = self.plan.cast.name(mesh.role);
        self.row(&name, label, shot, |maker, shot, scene, _| {
            maker.with_core(|core| bvh::time(core, scene, shot))
        })
    }

    fn ladder(&mut self, ladder: &Ladder) -> Result<Vec<Row<Figure>>, WriteupError> {
        let mut rows = Vec::new();
        for rung in &ladder.rungs {
            let name = format!("{}-{}", ladder.name, rung.name);
            let shot = rung.shot(self.plan.cast, self.plan.effort);
            let label = rung.label.clone().unwrap_or_else(|| self.plan.cast.name(rung.role));
            rows.push(self.row(&name, label, shot, |maker, shot, scene, file| {
                maker.figure(shot, scene, file)
            })?);
        }
        Ok(rows)
    }

    /// One that is kept, or one that is made and kept from now on.
    fn row<T: Kept>(
        &mut self,
        name: &str,
        label: String,
        shot: Result<Shot, String>,
        make: impl FnOnce(&mut Self, &Shot, &SceneDescription, &str) -> Result<T, String>,
    ) -> Result<Row<T>, WriteupError> {
        self.tell(name);
        let ending = if renders_codes_alone(&self.plan.info) { "png" } else { "exr" };
        let file = format!("{name}.{ending}");
        let command = shot.as_ref().map_or(String::new(), |shot| self.command(shot, &file));
        let read = shot.and_then(|shot| Ok((self.scene(&shot)?, shot)));
        self.done += 1;
        let (scene, shot) = match read {
            Ok(read) => read,
            Err(why) => return Ok(Row { label, shot: None, command, result: Err(why) }),
        };
        let key = Key::new(&command, &scene, self.plan.core);
        let kept = (!self.plan.fresh).then(|| self.store.kept::<T>(name, &key)).flatten();
        self.kept += usize::from(kept.is_some());
        let lacking = missing(&shot, &self.plan.info);
        let result = match kept {
            Some(kept) => Ok(kept),
            None if !lacking.is_empty() => Err(CoreError::Unsupported(lacking).to_string()),
            None => make(self, &shot, &scene, &file),
        };
        if let Ok(result) = &result {
            self.store.keep(name, key, result)?;
        }
        self.pace.is_done(self.plan, &shot);
        Ok(Row { label, shot: Some(shot), command, result })
    }

    fn scene(&self, shot: &Shot) -> Result<Arc<SceneDescription>, String> {
        shot.load(self.plan.library).map_err(|error| error.to_string())
    }

    fn command(&self, shot: &Shot, file: &str) -> String {
        let core = self.plan.core.as_str();
        let file = format!("{FIGURES}/{file}");
        let words = ["furnace", "render"].into_iter().map(str::to_owned);
        let more = ["--core", core, "-o", &file].map(str::to_owned);
        shell_words::join(words.chain(shot.words()).chain(more))
    }

    fn figure(
        &mut self,
        shot: &Shot,
        scene: &SceneDescription,
        file: &str,
    ) -> Result<Figure, String> {
        let camera = shot.camera(scene)?;
        let settings = shot.settings(&camera, 0);
        let passes = shot.passes(self.plan.core.program().is_some());
        let request = Request { shot, scene, camera: &camera, settings: &settings, passes };
        let made = self.with_core(|core| request.put_to(core, |_| {}))?;
        self.pace.took(shot, made.seconds);
        let path = self.store.path(file);
        let output: Output = path.to_string_lossy().parse()?;
        output.write(&made.shown, Vec::new()).map_err(|error| error.to_string())?;
        Ok(Figure { file: file.to_owned(), measured: Measured::of(&made) })
    }

    /// A core of its own for each figure: whatever becomes of it, the next begins anew.
    fn with_core<T>(
        &self,
        ask: impl FnOnce(&mut dyn Core) -> Result<T, CoreError>,
    ) -> Result<T, String> {
        let hosted = self.plan.hosting.host(self.plan.core);
        let mut hosted = hosted.map_err(|error| format!("the core fails to start: {error}"))?;
        ask(hosted.core_mut()).map_err(|error| error.to_string())
    }

    fn tell(&mut self, name: &str) {
        let (figures, left) = ([self.done, self.all], self.pace.left());
        (self.tell)(Told { name, figures, left });
    }
}
