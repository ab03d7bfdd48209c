//! Runs trials: each core call behind validation, each result written as soon as it is there.

use super::event::Event;
use super::outcome::{Outcome, Status};
use super::plan::{Plan, Trial};
use super::record::{self, PictureFile, RecordError, SceneStamp, TrialRecord, TrialTiming};
use super::schedule::{Next, Schedule};
use crate::case::Case;
use crate::checks::{CheckError, Context, Finding, Picture};
use crate::contract::validate::Validated;
use crate::contract::{Capabilities, Core, CoreError};
use crate::cores::{HostError, Hosting};
use crate::image::exr;
use crate::math::rng::Seed;
use crate::scene::hash::content_hash;
use crate::scene::{Library, SceneDescription};
use crate::stats::{Allowance, Budget};
use crate::worker::StartError;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
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
    pub allowance: Allowance,
    /// The seed of the run.
    pub seed: Seed,
    /// Where cores live.
    pub hosting: Hosting,
    /// Cores that died before they said who they are: how, and what they printed. Nothing else is
    /// asked of them.
    pub unfit: BTreeMap<String, (CoreError, String)>,
}

/// A trial that has ended, before anything is written.
pub struct Ended {
    /// What its sidecar will say; `pictures` is still empty.
    pub record: TrialRecord,
    /// What the check wants people to see.
    pub pictures: Vec<Picture>,
}

/// What the threads of a run tell the one that listens.
pub enum Message {
    /// A trial began.
    Started(Trial),
    /// A trial ended, or was blocked.
    Ended(Box<Ended>),
}

/// Runs one trial, whatever it rests on. Nothing is written.
pub fn run_trial(bench: &Bench, trial: &Trial) -> Ended {
    let started = Instant::now();
    let (attempt, printed) = attempt_hosted(bench, trial);
    let mut record = record_of(bench, trial, attempt.outcome);
    record.scene = attempt.scene;
    record.keep_printed(&printed);
    record.timing.seconds = started.elapsed().as_secs_f64();
    Ended { record, pictures: attempt.pictures }
}

/// Brings up the core of a trial, and puts the case to it. Also answers what the core printed.
fn attempt_hosted(bench: &Bench, trial: &Trial) -> (Attempt, String) {
    let unfit = bench.unfit.get(trial.core.as_str());
    let hosted = match unfit {
        Some((error, printed)) => {
            let (error, printed) = (error.clone(), printed.clone());
            Err(HostError::Start(StartError::Core { error, printed }))
        }
        None => bench.hosting.host(&trial.core),
    };
    match hosted {
        Ok(mut hosted) => {
            let attempt = attempt(bench, &trial.case, hosted.core_mut());
            (attempt, hosted.printed())
        }
        Err(HostError::Start(StartError::Core { error, printed })) => {
            (Attempt::without_core(CheckError::Core(error)), printed)
        }
        Err(error) => (Attempt::without_core(CheckError::Broken(error.to_string())), String::new()),
    }
}

/// A trial that was not tried, since `by` failed.
fn blocked(bench: &Bench, trial: &Trial, by: String) -> Ended {
    Ended { record: record_of(bench, trial, Outcome::Blocked { by }), pictures: Vec::new() }
}

fn record_of(bench: &Bench, trial: &Trial, outcome: Outcome) -> TrialRecord {
    let case = &trial.case;
    TrialRecord {
        version: record::VERSION,
        case: case.id.clone(),
        core: trial.core.to_string(),
        title: case.title.clone(),
        teaches: case.teaches.clone(),
        source: case.source.clone(),
        check: case.check.name.to_owned(),
        tier: case.tier,
        case_hash: case.hash.clone(),
        scene: None,
        budget: bench.allowance.budget,
        seed: bench.seed_of(case).0,
        outcome,
        pictures: Vec::new(),
        printed: String::new(),
        rerun: rerun_command(bench, trial),
        timing: TrialTiming { seconds: 0.0 },
    }
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

impl Attempt {
    /// Of a core that did not come up.
    fn without_core(error: CheckError) -> Self {
        Self { outcome: Outcome::of(Err(error)), scene: None, pictures: Vec::new() }
    }
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
    let missing = case.prepared.missing(info.capabilities);
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
        budget: bench.allowance,
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

/// The command that tries this again, at full length: bets that decide early say that something is
/// wrong, the ladder says by how much.
fn rerun_command(bench: &Bench, trial: &Trial) -> String {
    let core = shell_words::quote(trial.core.as_str());
    let mut command = format!("cargo furnace run {} --core {core}", trial.case.id);
    let budget = bench.allowance.budget;
    if budget != Budget::default() {
        command += &format!(" --budget {budget}");
    }
    if bench.seed != Seed::SUITE {
        command += &format!(" --seed {}", bench.seed.0);
    }
    command
}

/// Runs the trials of a schedule, several at a time, and hands each to `sink` as soon as it has ended. `sink` is
/// called from this thread alone.
///
/// # Errors
/// The first of `sink`: the run stops there.
pub fn run_trials<E>(
    plan: &Plan,
    bench: &Bench,
    schedule: &Schedule<'_>,
    sink: &mut dyn FnMut(Message) -> Result<(), E>,
) -> Result<(), E> {
    let (sender, messages) = mpsc::channel();
    std::thread::scope(|threads| {
        for _ in 0..plan.jobs().min(plan.trials.len()) {
            let sender = sender.clone();
            threads.spawn(move || work(bench, plan, schedule, &sender));
        }
        drop(sender);
        let heard = messages.iter().try_for_each(sink);
        // After a failed write nobody starts another trial.
        schedule.stop();
        heard
    })
}

/// One thread of a run: takes trials until none is left or nobody listens.
fn work(bench: &Bench, plan: &Plan, schedule: &Schedule<'_>, sender: &mpsc::Sender<Message>) {
    while let Some(next) = schedule.next() {
        let ended = match next {
            Next::Try(number) => {
                let trial = &plan.trials[number];
                if sender.send(Message::Started(trial.clone())).is_err() {
                    return;
                }
                let ended = run_trial(bench, trial);
                schedule.ended(number, ended.record.outcome.status());
                if plan.request.fail_fast && ended.record.fails_the_core() {
                    schedule.stop();
                }
                ended
            }
            Next::Blocked(number, by) => blocked(bench, &plan.trials[number], by),
        };
        if sender.send(Message::Ended(Box::new(ended))).is_err() {
            return;
        }
    }
}

/// Runs the trials of `plan` whose numbers are in `todo`, and writes each sidecar as soon as its trial has ended.
///
/// # Errors
/// If a file cannot be written: the run stops there, and what was written stays.
pub fn run_into(
    plan: &Plan,
    bench: &Bench,
    todo: &[usize],
    earlier: &[(usize, Status)],
    folder: &Path,
    events: &mut dyn FnMut(Event<'_>),
) -> Result<(), RecordError> {
    let schedule = Schedule::new(plan, bench, todo, earlier);
    run_trials(plan, bench, &schedule, &mut |message| match message {
        Message::Started(trial) => {
            events(Event::Started { core: trial.core.as_str(), case: &trial.case.id });
            Ok(())
        }
        Message::Ended(ended) => {
            let trial = write_trial(folder, *ended)?;
            events(Event::Ended { trial: &trial });
            Ok(())
        }
    })
}

/// Runs all of `plan` and keeps the records in memory, in the order of the plan. Nothing is written.
pub fn run_in_memory(plan: &Plan) -> Vec<TrialRecord> {
    let bench = plan.bench();
    let todo: Vec<_> = (0..plan.trials.len()).collect();
    let schedule = Schedule::new(plan, &bench, &todo, &[]);
    let mut records = Vec::new();
    let heard = run_trials::<Infallible>(plan, &bench, &schedule, &mut |message| {
        if let Message::Ended(ended) = message {
            records.push(ended.record);
        }
        Ok(())
    });
    let Ok(()) = heard;
    let position = |record: &TrialRecord| {
        let is_it =
            |trial: &Trial| trial.case.id == record.case && trial.core.as_str() == record.core;
        plan.trials.iter().position(is_it)
    };
    records.sort_by_cached_key(position);
    records
}

/// Pictures first, then the sidecar: where there is a sidecar, everything is there.
fn write_trial(folder: &Path, ended: Ended) -> Result<TrialRecord, RecordError> {
    let Ended { mut record, pictures } = ended;
    let sidecar = record::sidecar_path(folder, &record.core, &record.case);
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
