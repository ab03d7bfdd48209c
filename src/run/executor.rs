//! Runs trials: each core call behind validation, each result written as soon as it is there.

use super::event::Event;
use super::outcome::Outcome;
use super::plan::{Plan, Trial};
use super::record::{self, PictureFile, RecordError, SceneStamp, TrialRecord, TrialTiming};
use crate::case::Case;
use crate::checks::{CheckError, Context, Finding, Picture};
use crate::contract::validate::Validated;
use crate::contract::{Capabilities, Core, CoreError};
use crate::image::exr;
use crate::math::rng::Seed;
use crate::scene::hash::content_hash;
use crate::scene::{Library, SceneDescription};
use crate::stats::Budget;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Instant;

/// What every trial of a run shares.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The scenes.
    pub scenes: Arc<Library>,
    /// The folder of references.
    pub references: PathBuf,
    /// How much may be spent.
    pub budget: Budget,
    /// The seed of the run.
    pub seed: Seed,
}

/// A trial that has ended, before anything is written.
pub struct Ended {
    /// What its sidecar will say; `pictures` is still empty.
    pub record: TrialRecord,
    /// What the check wants people to see.
    pub pictures: Vec<Picture>,
}

/// What the threads tell the one that writes.
enum Message {
    Started(Trial),
    Ended(Box<Ended>),
}

/// Runs one trial. Nothing is written.
pub fn run_trial(bench: &Bench, trial: &Trial) -> Ended {
    let started = Instant::now();
    let case = &trial.case;
    let attempt = attempt(bench, case, trial.core.make().as_mut());
    let record = TrialRecord {
        version: record::VERSION,
        case: case.id.clone(),
        core: trial.core.to_string(),
        title: case.title.clone(),
        teaches: case.teaches.clone(),
        source: case.source.clone(),
        check: case.check.name.to_owned(),
        case_hash: case.hash.clone(),
        scene: attempt.scene,
        budget: bench.budget,
        seed: bench.seed_of(case).0,
        outcome: attempt.outcome,
        pictures: Vec::new(),
        rerun: rerun_command(bench, trial),
        timing: TrialTiming { seconds: started.elapsed().as_secs_f64() },
    };
    Ended { record, pictures: attempt.pictures }
}

/// What came of putting one case to one core.
#[derive(Debug)]
pub struct Attempt {
    /// How it ended.
    pub outcome: Outcome,
    /// The scene it was tried in.
    pub scene: Option<SceneStamp>,
    /// What the check wants people to see.
    pub pictures: Vec<Picture>,
}

/// Puts one case to one core, whoever made it.
pub fn attempt(bench: &Bench, case: &Case, core: &mut dyn Core) -> Attempt {
    let mut pictures = Vec::new();
    let mut scene = None;
    let result = load_scene(bench, case).and_then(|loaded| {
        scene = loaded.as_deref().map(stamp);
        judge(bench, case, core, loaded, &mut pictures)
    });
    Attempt { outcome: Outcome::of(result), scene, pictures }
}

impl Bench {
    /// The seed of a case: the same for every core.
    fn seed_of(&self, case: &Case) -> Seed {
        self.seed.child(&case.id)
    }
}

fn load_scene(bench: &Bench, case: &Case) -> Result<Option<Arc<SceneDescription>>, CheckError> {
    let Some(scene) = &case.scene else { return Ok(None) };
    let loaded = bench.scenes.load(&scene.name, &scene.parameters);
    loaded.map(Some).map_err(|error| CheckError::Broken(error.to_string()))
}

fn stamp(scene: &SceneDescription) -> SceneStamp {
    SceneStamp { name: scene.name.clone(), hash: content_hash(scene) }
}

/// Asks whether the core can, and lets the check run.
fn judge(
    bench: &Bench,
    case: &Case,
    core: &mut dyn Core,
    scene: Option<Arc<SceneDescription>>,
    pictures: &mut Vec<Picture>,
) -> Result<Finding, CheckError> {
    let mut core = Validated::new(core);
    let info = core.info();
    let missing = case.prepared.needs() - info.capabilities;
    if missing != Capabilities::empty() {
        return Err(CoreError::Unsupported(missing).into());
    }
    let mut context = Context {
        core: &mut core,
        info,
        scene,
        scenes: &bench.scenes,
        references: &bench.references,
        seed: bench.seed_of(case),
        budget: bench.budget,
        pictures: Vec::new(),
    };
    let run = AssertUnwindSafe(|| case.prepared.run(&mut context));
    let result = catch_unwind(run).unwrap_or_else(|_| {
        // The core's own panics were stopped by the validation: this one is ours.
        Err(CheckError::Broken("furnace itself panicked; please report this case".to_owned()))
    });
    *pictures = context.pictures;
    result
}

fn rerun_command(bench: &Bench, trial: &Trial) -> String {
    let mut command = format!("cargo furnace run {} --core {}", trial.case.id, trial.core);
    if bench.budget != Budget::default() {
        command += &format!(" --budget {}", bench.budget);
    }
    if bench.seed != Seed::SUITE {
        command += &format!(" --seed {}", bench.seed.0);
    }
    command
}

/// Runs the trials of `plan` whose numbers are in `todo`, and writes each sidecar as soon as its trial has ended.
///
/// # Errors
/// If a file cannot be written: the run stops there, and what was written stays.
pub fn run_trials(
    plan: &Plan,
    todo: &[usize],
    folder: &Path,
    events: &mut dyn FnMut(Event<'_>),
) -> Result<(), RecordError> {
    let bench = plan.bench();
    let next = AtomicUsize::new(0);
    let (sender, messages) = mpsc::channel();
    std::thread::scope(|threads| {
        for _ in 0..plan.jobs().min(todo.len()) {
            let sender = sender.clone();
            let (bench, next) = (&bench, &next);
            threads.spawn(move || work(bench, plan, todo, next, &sender));
        }
        drop(sender);
        let written = messages.iter().try_for_each(|message| match message {
            Message::Started(trial) => {
                events(Event::Started { core: trial.core.as_str(), case: &trial.case.id });
                Ok(())
            }
            Message::Ended(ended) => {
                let trial = write_trial(folder, *ended)?;
                events(Event::Ended { trial: &trial });
                Ok(())
            }
        });
        // After a failed write nobody starts another trial.
        next.store(todo.len(), Ordering::Relaxed);
        written
    })
}

/// One thread of a run: takes trials until none is left or nobody listens.
fn work(
    bench: &Bench,
    plan: &Plan,
    todo: &[usize],
    next: &AtomicUsize,
    sender: &mpsc::Sender<Message>,
) {
    while let Some(number) = todo.get(next.fetch_add(1, Ordering::Relaxed)) {
        let trial = &plan.trials[*number];
        let told = sender
            .send(Message::Started(trial.clone()))
            .and_then(|()| sender.send(Message::Ended(Box::new(run_trial(bench, trial)))));
        if told.is_err() {
            return;
        }
    }
}

/// Pictures first, then the sidecar: where there is a sidecar, everything is there.
fn write_trial(folder: &Path, ended: Ended) -> Result<TrialRecord, RecordError> {
    let Ended { mut record, pictures } = ended;
    let sidecar = record::sidecar_path(folder, &record.core, &record.case);
    if let Some(parent) = sidecar.parent() {
        std::fs::create_dir_all(parent)
            .map_err(|error| RecordError::Io { path: parent.to_owned(), error })?;
    }
    for (number, picture) in pictures.into_iter().enumerate() {
        let path = sidecar.with_extension(format!("{number}.exr"));
        exr::write_image(&path, &picture.image).map_err(|error| RecordError::Malformed {
            path: path.clone(),
            error: error.to_string(),
        })?;
        record.pictures.push(PictureFile {
            role: picture.role,
            caption: picture.caption,
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        });
    }
    record::write_json(&sidecar, &record)?;
    Ok(record)
}
