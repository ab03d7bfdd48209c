//! Runs trials, several at a time; each result is written as soon as it is there.

use super::attempt::{Ended, run_transplanted, run_with, untried};
use super::bench::Bench;
use super::event::Event;
use super::outcome::{Outcome, Status};
use super::plan::{Plan, Trial};
use super::record::{self, PictureFile, RecordError, TrialRecord};
use super::schedule::{Next, Schedule, Transplant};
use crate::checks::Picture;
use crate::image::exr::{self, Exr, Storage};
use crate::scene::reference::ERROR_PREFIX;
use std::convert::Infallible;
use std::path::Path;
use std::sync::mpsc;
use std::time::Instant;

/// What the threads of a run tell the one that listens.
pub(crate) enum Message {
    Started(Trial),
    /// A trial ended, or was blocked.
    Ended(Box<Ended>),
}

/// Runs the trials of a schedule, several at a time, and hands each to `sink` as soon as it has ended. `sink` is called
/// from this thread alone. Fails with the first of `sink`: the run stops there.
pub(crate) fn run_trials<E>(
    plan: &Plan,
    bench: &Bench,
    schedule: &Schedule<'_>,
    sink: &mut dyn FnMut(Message) -> Result<(), E>,
) -> Result<(), E> {
    let (sender, messages) = mpsc::channel();
    let end = plan.time.map(|time| Instant::now() + time);
    std::thread::scope(|threads| {
        for _ in 0..plan.jobs().min(plan.trials.len()) {
            let sender = sender.clone();
            threads.spawn(move || work(bench, plan, schedule, end, &sender));
        }
        drop(sender);
        let heard = messages.iter().try_for_each(sink);
        // After a failed write nobody starts another trial.
        schedule.stop();
        heard
    })
}

/// One thread of a run: takes trials until none is left or nobody listens.
fn work(
    bench: &Bench,
    plan: &Plan,
    schedule: &Schedule<'_>,
    end: Option<Instant>,
    sender: &mpsc::Sender<Message>,
) {
    while let Some(next) = schedule.next() {
        if end.is_some_and(|end| Instant::now() >= end) {
            schedule.stop();
            return;
        }
        let (number, transplant) = match next {
            Next::Try(number) => (number, None),
            Next::Transplanted(number, transplant) => (number, Some(transplant)),
            Next::Blocked(number, by) => {
                let ended = untried(bench, &plan.trials[number], by);
                schedule.ended(number, &ended.record.outcome);
                if sender.send(Message::Ended(Box::new(ended))).is_err() {
                    return;
                }
                continue;
            }
        };
        let trial = &plan.trials[number];
        if sender.send(Message::Started(trial.clone())).is_err() {
            return;
        }
        let ended = match transplant {
            None => run_with(bench, trial, plan.with),
            Some(transplant) => {
                let with = transplant.with | plan.with;
                run_transplanted(bench, trial, Transplant { with, ..transplant })
            }
        };
        if ended.record.outcome.status() == Status::Blocked {
            schedule.was_in_vain(number, ended.record.timing.seconds);
        }
        schedule.ended(number, &ended.record.outcome);
        if plan.request.fail_fast && ended.record.fails_the_core() {
            schedule.stop();
        }
        if sender.send(Message::Ended(Box::new(ended))).is_err() {
            return;
        }
    }
}

/// Runs the trials of `plan` whose numbers are in `todo`, and writes each sidecar as soon as its trial has ended.
/// Answers them all. Fails if a file cannot be written: the run stops there, and what was written stays.
pub(crate) fn run_into(
    plan: &Plan,
    bench: &Bench,
    todo: &[usize],
    earlier: &[(usize, Outcome)],
    folder: &Path,
    events: &mut dyn FnMut(Event<'_>),
) -> Result<Vec<TrialRecord>, RecordError> {
    let schedule = Schedule::new(plan, bench, todo, earlier);
    let mut records = Vec::new();
    run_trials(plan, bench, &schedule, &mut |message| match message {
        Message::Started(trial) => {
            events(Event::Started { core: trial.core.as_str(), case: &trial.case.id });
            Ok(())
        }
        Message::Ended(ended) => {
            let trial = write_trial(folder, *ended)?;
            events(Event::Ended { trial: &trial });
            records.push(trial);
            Ok(())
        }
    })?;
    Ok(records)
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
    plan.sort(&mut records);
    records
}

/// Pictures first, then the sidecar: where there is a sidecar, everything is there.
fn write_trial(folder: &Path, ended: Ended) -> Result<TrialRecord, RecordError> {
    let Ended { mut record, pictures } = ended;
    let sidecar = record::sidecar_path(folder, &record.core, &record.case);
    for (number, picture) in pictures.into_iter().enumerate() {
        let path = sidecar.with_extension(format!("{number}.exr"));
        exr::write(&path, &file_of(&picture)).map_err(|error| RecordError::Malformed {
            path: path.clone(),
            error: error.to_string(),
        })?;
        record.pictures.push(PictureFile {
            role: picture.role,
            caption: picture.caption,
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            rejected: picture.rejected,
        });
    }
    record::write_json(&sidecar, &record)?;
    Ok(record)
}

/// The colours of a picture, their standard errors where they are known, and its layers.
fn file_of(picture: &Picture) -> Exr {
    let file = Exr::from_image(&picture.image);
    let file = match &picture.standard_error {
        Some(errors) => file.with_colours(ERROR_PREFIX, errors, Storage::Half),
        None => file,
    };
    picture.layers.iter().fold(file, |file, layer| {
        file.with_colours(&format!("{}.", layer.name), &layer.image, Storage::Half)
    })
}
