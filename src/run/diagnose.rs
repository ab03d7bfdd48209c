//! From the records of a run to the causes of what failed in it.

use super::record::CoreRecord;
use super::{Outcome, Status, TrialRecord};
use crate::diagnosis::{self, Diagnosis, Evidence, Observation, Standing};

/// The causes of what failed on `core` among `trials`; those of other cores are left aside.
pub(crate) fn diagnose<'a>(
    core: &CoreRecord,
    trials: impl IntoIterator<Item = &'a TrialRecord>,
) -> Diagnosis {
    let of_core = trials.into_iter().filter(|trial| trial.core == core.spec);
    let observations = of_core.map(observation).collect();
    diagnosis::diagnose(&Evidence::new(observations, core.conventions))
}

fn observation(trial: &TrialRecord) -> Observation<'_> {
    let standing = match trial.outcome.status() {
        Status::Pass => Standing::Passed,
        Status::Fail | Status::Crashed | Status::TimedOut => Standing::Failed,
        Status::Blocked | Status::Inconclusive | Status::Skipped | Status::Broken => unknown(trial),
    };
    Observation {
        case: &trial.case,
        tier: trial.tier,
        role: trial.role,
        is_specular: trial.scene.as_ref().is_some_and(|scene| scene.is_specular),
        standing,
        finding: trial.outcome.finding(),
        rerun: &trial.rerun,
        seconds: trial.timing.seconds,
    }
}

fn unknown(trial: &TrialRecord) -> Standing {
    match &trial.outcome {
        Outcome::Blocked { by } => Standing::Blocked(by.clone()),
        _ => Standing::Unknown,
    }
}
