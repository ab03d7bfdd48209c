//! One figure after another: what an earlier write-up has made with equal settings is taken, the rest is rendered.

use super::bvh::{self, Mesh, Timed};
use super::ladder::Ladder;
use super::measured::{Measured, Pace, rays};
use super::store::{FIGURES, Figure, Kept, Key, Store};
use super::{Plan, Row, Told, WriteupError};
use crate::contract::{Core, CoreError};
use crate::render::{Output, Request, Shot, missing, renders_codes_alone};
use crate::scene::SceneDescription;
use std::sync::Arc;
use std::time::Instant;

/// Makes one figure after another, or takes it from an earlier write-up.
pub(super) struct Maker<'a> {
    pub(super) plan: &'a Plan<'a>,
    pub(super) store: Store,
    pub(super) pace: Pace,
    pub(super) all: usize,
    pub(super) done: usize,
    pub(super) kept: usize,
    pub(super) tell: &'a mut dyn FnMut(Told<'_>),
}

impl Maker<'_> {
    pub(super) fn mesh(&mut self, mesh: Mesh) -> Result<Row<Timed>, WriteupError> {
        let name = format!("bvh-{}", mesh.role.name);
        let shot = mesh.shot(self.plan.cast, self.plan.effort.size);
        let label = self.plan.cast.name(mesh.role);
        self.row(&name, label, shot, |maker, shot, scene| {
            with_core(maker.plan, |core| bvh::time(core, scene, shot))
        })
    }

    pub(super) fn ladder(&mut self, ladder: &Ladder) -> Result<Vec<Row<Figure>>, WriteupError> {
        let mut rows = Vec::new();
        for rung in &ladder.rungs {
            let name = format!("{}-{}", ladder.name, rung.name);
            let shot = rung.shot(self.plan.cast, self.plan.effort);
            let label = rung.label.clone().unwrap_or_else(|| self.plan.cast.name(rung.role));
            rows.push(
                self.row(&name, label, shot, |maker, shot, scene| {
                    maker.figure(&name, shot, scene)
                })?,
            );
        }
        Ok(rows)
    }

    /// One that is kept, or one that is made and kept from now on.
    fn row<T: Kept>(
        &mut self,
        name: &str,
        label: String,
        shot: Result<Shot, String>,
        make: impl FnOnce(&mut Self, &Shot, &SceneDescription) -> Result<T, String>,
    ) -> Result<Row<T>, WriteupError> {
        let left = self.pace.left(0.0, 0.0);
        (self.tell)(Told { name, figures: [self.done, self.all], samples: None, left });
        self.done += 1;
        let command = shot.as_ref().map_or(String::new(), |shot| self.command(shot, name));
        let read = shot.and_then(|shot| Ok((self.scene(&shot)?, shot)));
        let (scene, shot) = match read {
            Ok(read) => read,
            Err(why) => return Ok(Row { label, shot: None, command, result: Err(why) }),
        };
        let key = Key::new(&command, &scene, self.plan.core);
        let result = match self.taken(name, &key) {
            Some(taken) => Ok(taken),
            None => self.able(&shot).and_then(|()| make(self, &shot, &scene)),
        };
        if let Ok(result) = &result {
            self.store.keep(name, key, result)?;
        }
        self.pace.is_done(self.plan, &shot);
        Ok(Row { label, shot: Some(shot), command, result })
    }

    fn taken<T: Kept>(&mut self, name: &str, key: &Key) -> Option<T> {
        let taken = (!self.plan.fresh).then(|| self.store.kept(name, key)).flatten();
        self.kept += usize::from(taken.is_some());
        taken
    }

    /// What it lacks is known before anything is rendered.
    fn able(&self, shot: &Shot) -> Result<(), String> {
        let lacking = missing(shot, &self.plan.info);
        if lacking.is_empty() { Ok(()) } else { Err(CoreError::Unsupported(lacking).to_string()) }
    }

    fn scene(&self, shot: &Shot) -> Result<Arc<SceneDescription>, String> {
        shot.load(self.plan.scenes).map_err(|error| error.to_string())
    }

    /// The image of a figure.
    fn file(&self, name: &str) -> String {
        let ending = if renders_codes_alone(&self.plan.info) { "png" } else { "exr" };
        format!("{name}.{ending}")
    }

    fn command(&self, shot: &Shot, name: &str) -> String {
        let core = self.plan.core.as_str();
        let file = format!("{FIGURES}/{}", self.file(name));
        let words = ["furnace", "render"].into_iter().map(str::to_owned);
        let more = ["--core", core, "-o", &file].map(str::to_owned);
        shell_words::join(words.chain(shot.words()).chain(more))
    }

    fn figure(
        &mut self,
        name: &str,
        shot: &Shot,
        scene: &SceneDescription,
    ) -> Result<Figure, String> {
        let camera = shot.camera(scene)?;
        let settings = shot.settings(&camera, 0);
        let passes = shot.passes(self.plan.core.program().is_some());
        let request = Request { shot, scene, camera: &camera, settings: &settings, passes };
        let (figures, begun) = ([self.done - 1, self.all], Instant::now());
        let tell = |samples: u32| {
            let rays = rays(shot) * f64::from(samples) / f64::from(shot.spp);
            let left = self.pace.left(rays, begun.elapsed().as_secs_f64());
            (self.tell)(Told { name, figures, samples: Some([samples, shot.spp]), left });
        };
        let made = with_core(self.plan, |core| request.put_to(core, tell))?;
        self.pace.took(shot, made.seconds);
        let file = self.file(name);
        let path = self.store.path(&file);
        let output: Output = path.to_string_lossy().parse()?;
        output.write(&made.shown, Vec::new()).map_err(|error| error.to_string())?;
        Ok(Figure { file, measured: Measured::of(&made) })
    }
}

/// A core of its own for each figure: whatever becomes of it, the next begins anew.
fn with_core<T>(
    plan: &Plan<'_>,
    ask: impl FnOnce(&mut dyn Core) -> Result<T, CoreError>,
) -> Result<T, String> {
    let hosted = plan.hosting.host(plan.core);
    let mut hosted = hosted.map_err(|error| format!("the core fails to start: {error}"))?;
    ask(hosted.core_mut()).map_err(|error| error.to_string())
}
