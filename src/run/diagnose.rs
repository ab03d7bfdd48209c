//! From the records of a run to the causes of what failed in it.

use super::record::CoreRecord;
use super::{Outcome, Status, TrialRecord};
use crate::case::Foundation;
use crate::contract::Components;
use crate::diagnosis::{self, Diagnosis, Ending, Evidence, Observation, Standing};

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
        rests_on: of_the_core(&trial.rests_on, trial.with),
        proves: &trial.proves,
        standing,
        ending: ending(&trial.outcome),
        finding: trial.outcome.finding(),
        rerun: &trial.rerun,
        seconds: trial.timing.seconds,
    }
}

/// Of what a case rests on, what was the core's own: by what it took from the bench it cannot fail.
fn of_the_core(rests_on: &[Foundation], with: Components) -> Vec<Foundation> {
    let is_own = |foundation: &Foundation| !with.contains(foundation.components());
    rests_on.iter().copied().filter(is_own).collect()
}

fn ending(outcome: &Outcome) -> Option<Ending<'_>> {
    match outcome {
        Outcome::Crashed { how, during } => Some(Ending::Crashed { how, during }),
        Outcome::TimedOut { during, .. } => Some(Ending::TimedOut { during }),
        _ => None,
    }
}

fn unknown(trial: &TrialRecord) -> Standing {
    match &trial.outcome {
        Outcome::Blocked { by } => Standing::Blocked(by.clone()),
        _ => Standing::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_follows_from_what_was_taken_from_the_bench() {
        let (hits, seeds) = (Foundation::Hits, Foundation::Seeds);
        assert_eq!(of_the_core(&[seeds, hits], Components::empty()), [seeds, hits]);
        assert_eq!(of_the_core(&[seeds, hits], hits.components()), [seeds]);
    }
}
