//! From a request to a folder of results: the one path that the command line, the tests and CI share.
//!
//! Only here cores and checks meet. Not here: what is printed, and what a failure means for an exit code.

mod attempt;
mod bench;
mod diagnose;
pub(crate) mod event;
pub(crate) mod executor;
pub(crate) mod outcome;
pub(crate) mod plan;
mod planted;
mod purse;
pub mod record;
mod schedule;
mod search;
mod second_look;
mod tally;

pub use attempt::attempt;
pub(crate) use attempt::run_with;
pub use attempt::{Attempt, Ended, run_trial};
pub use bench::Bench;
pub(crate) use diagnose::diagnose;
pub(crate) use event::Event;
pub use executor::run_in_memory;
pub use outcome::{Outcome, Status};
pub use plan::{Plan, Request, Trial};
pub(crate) use planted::{Excluded, excluded};
pub use record::{RecordError, RunRecord, TrialRecord};
pub(crate) use record::{Transplanted, Transplants};
#[cfg(feature = "harness")]
pub(crate) use schedule::of_case as rests_on;
use second_look::look_again;
pub(crate) use tally::{Counts, Tally};

use crate::contract::CoreError;
use crate::cores::HostError;
use crate::worker::StartError;
use record::{CoreRecord, Machine, RunTiming, Score};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Why a run did not come to its end, or did not begin.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A file of the run could not be written or read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A core is there, but is none that can be asked.
    #[error("`{spec}` fails to start: {error}")]
    NoCore {
        /// The core, as the user named it.
        spec: String,
        /// Why.
        error: HostError,
    },
}

/// Runs `plan` into a new folder below `runs`, and answers that folder.
///
/// # Errors
/// If a core cannot be asked, or a file cannot be written.
pub fn run(
    plan: &Plan,
    runs: &Path,
    events: &mut dyn FnMut(Event<'_>),
) -> Result<PathBuf, RunError> {
    let started = SystemTime::now();
    let mut bench = plan.bench();
    let cores = discover(plan, &mut bench)?;
    let folder = new_folder(runs, started)?;
    let record = describe(plan, cores, started);
    record::write_json(&folder.join("run.json"), &record)?;
    carry_out(plan, &bench, record, &folder, events)?;
    Ok(folder)
}

/// Goes on with a run that was cut off: what has a sidecar of the same case is kept. Fails if the folder is not a run,
/// or a file cannot be written.
pub(crate) fn resume(
    plan: &Plan,
    folder: &Path,
    events: &mut dyn FnMut(Event<'_>),
) -> Result<(), RunError> {
    let path = folder.join("run.json");
    let mut record: RunRecord = record::read_json(&path)?;
    // It holds of the trials of then.
    record.counts = None;
    record.cores.iter_mut().for_each(|core| (core.diagnosis, core.score) = (None, None));
    record::write_json(&path, &record)?;
    carry_out(plan, &plan.bench(), record, folder, events)
}

fn carry_out(
    plan: &Plan,
    bench: &Bench,
    mut record: RunRecord,
    folder: &Path,
    events: &mut dyn FnMut(Event<'_>),
) -> Result<(), RunError> {
    let clock = Instant::now();
    let earlier: Vec<_> = plan.trials.iter().map(|trial| result_of(trial, folder)).collect();
    let todo: Vec<_> = (0..earlier.len()).filter(|number| earlier[*number].is_none()).collect();
    let mut records: Vec<_> = earlier.iter().flatten().cloned().collect();
    events(Event::Planned { run: &record, folder, earlier: &records });
    let outcomes = earlier.into_iter().map(|record| Some(record?.outcome));
    let done: Vec<_> =
        outcomes.enumerate().filter_map(|(n, outcome)| Some((n, outcome?))).collect();
    records.extend(executor::run_into(plan, bench, &todo, &done, folder, events)?);
    // Whatever was tried first, and in which process.
    plan.sort(&mut records);
    for core in &mut record.cores {
        conclude(plan, bench, core, &records, events);
        core.score = Some(Score::of(records.iter().filter(|trial| trial.core == core.spec)));
    }
    record.counts = Some(Counts::of(record.trials, &records));
    let before = record.timing.seconds.unwrap_or(0.0);
    record.timing.seconds = Some(before + clock.elapsed().as_secs_f64());
    record::write_json(&folder.join("run.json"), &record)?;
    Ok(())
}

/// What is wrong with a core whose trials have ended.
fn conclude(
    plan: &Plan,
    bench: &Bench,
    core: &mut CoreRecord,
    records: &[TrialRecord],
    events: &mut dyn FnMut(Event<'_>),
) {
    if !plan.searches || plan.request.fail_fast {
        core.diagnosis = Some(diagnose(core, records));
        return;
    }
    if plan.with.is_empty() {
        core.transplants = search::search(plan, bench, core, records, events);
    }
    let of_core = records.iter().filter(|record| record.core == core.spec);
    let broken = core.transplants.as_ref().map_or(0, |found| found.components.len());
    let planted = planted::PlantedFaults::new(plan, bench, of_core, broken);
    core.diagnosis = Some(match &core.transplants {
        None => diagnose::diagnose_proven(core, records, &planted),
        Some(transplants) => {
            let views = look_again(plan, bench, core, records, transplants);
            diagnose::diagnose_apart(core, records, transplants, &views, &planted)
        }
    });
}

/// Runs the trials of `core` in memory, and concludes what is wrong with it as a run in a folder does.
pub(crate) fn investigate(plan: &Plan, core: &mut CoreRecord) -> Vec<TrialRecord> {
    let records = run_in_memory(plan);
    conclude(plan, &plan.bench(), core, &records, &mut |_| {});
    records
}

/// The result of this very trial, if the folder holds it.
fn result_of(trial: &Trial, folder: &Path) -> Option<TrialRecord> {
    let path = record::sidecar_path(folder, trial.core.as_str(), &trial.case.id);
    let done = record::read_json::<TrialRecord>(&path).ok()?;
    (done.case_hash == trial.case.hash).then_some(done)
}

/// Asks every core who it is. One that dies of that is known to `bench`, and the run goes on.
fn discover(plan: &Plan, bench: &mut Bench) -> Result<Vec<CoreRecord>, RunError> {
    let mut records = Vec::new();
    for spec in &plan.request.cores {
        let record = match bench.hosting.host(spec) {
            Ok(mut hosted) => {
                let mut record = CoreRecord::new(spec.as_str(), &hosted.core_mut().info());
                record.confinement = hosted.confinement().cloned();
                record
            }
            Err(HostError::Start(StartError::Core {
                error: error @ (CoreError::Crashed { .. } | CoreError::TimedOut { .. }),
                printed,
            })) => {
                let record = CoreRecord::unknown(spec.as_str(), error.to_string());
                bench.unfit.insert(spec.to_string(), (error, printed));
                record
            }
            Err(error) => return Err(RunError::NoCore { spec: spec.to_string(), error }),
        };
        records.push(record);
    }
    Ok(records)
}

fn describe(plan: &Plan, cores: Vec<CoreRecord>, started: SystemTime) -> RunRecord {
    RunRecord {
        version: record::VERSION,
        furnace: env!("CARGO_PKG_VERSION").to_owned(),
        cores,
        filters: plan.request.filters.clone(),
        suite: plan.suite.clone(),
        budget: plan.request.budget,
        seed: plan.request.seed.0,
        trials: plan.trials.len(),
        counts: None,
        fail_fast: plan.request.fail_fast,
        with: plan.with,
        machine: Machine::this(),
        timing: RunTiming {
            started: started.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            seconds: None,
        },
    }
}

/// A folder named by the time, which nobody else has.
fn new_folder(runs: &Path, started: SystemTime) -> Result<PathBuf, RecordError> {
    let failed = |path: &Path, error| RecordError::Io { path: path.to_owned(), error };
    std::fs::create_dir_all(runs).map_err(|error| failed(runs, error))?;
    let stamp = humantime::format_rfc3339_seconds(started).to_string();
    let stamp = stamp.trim_end_matches('Z').replace(':', "-").replace('T', "_");
    for number in 1.. {
        let name = if number == 1 { stamp.clone() } else { format!("{stamp}_{number}") };
        let folder = runs.join(name);
        match std::fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(failed(&folder, error)),
        }
    }
    unreachable!("some number is free")
}
