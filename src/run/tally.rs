//! How many trials ended how. Whoever says a number of trials has it from here: the announcement of a run, its end, its
//! page and the exit code.

use super::outcome::Status;
use super::record::TrialRecord;
use crate::text::number::count;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How many trials ended with each status.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Tally(BTreeMap<Status, usize>);

impl Tally {
    pub(crate) fn of<'a>(trials: impl IntoIterator<Item = &'a TrialRecord>) -> Self {
        trials.into_iter().map(|trial| trial.outcome.status()).collect()
    }

    pub(crate) fn add(&mut self, status: Status) {
        *self.0.entry(status).or_default() += 1;
    }

    pub(crate) fn count(&self, status: Status) -> usize {
        self.0.get(&status).copied().unwrap_or(0)
    }

    pub(crate) fn total(&self) -> usize {
        self.0.values().sum()
    }

    pub(crate) fn failures(&self) -> usize {
        self.0.iter().filter(|(status, _)| status.is_failure()).map(|(_, count)| count).sum()
    }

    /// What occurs, the good first.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Status, usize)> {
        self.0.iter().map(|(status, count)| (*status, *count))
    }
}

impl FromIterator<Status> for Tally {
    fn from_iter<I: IntoIterator<Item = Status>>(statuses: I) -> Self {
        let mut tally = Self::default();
        statuses.into_iter().for_each(|status| tally.add(status));
        tally
    }
}

/// What became of the trials of a run: of each that is graded how it ended; the others beside them, for they count
/// neither for nor against a core.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Counts {
    /// How many the run was to try.
    pub(crate) planned: usize,
    /// Those that are graded and have ended.
    pub(crate) graded: Tally,
    /// How many of the others have ended.
    pub(crate) ungraded: usize,
}

impl Counts {
    pub(crate) fn of<'a>(
        planned: usize,
        trials: impl IntoIterator<Item = &'a TrialRecord>,
    ) -> Self {
        let mut counts = Self { planned, ..Self::default() };
        trials.into_iter().for_each(|trial| counts.add(trial));
        counts
    }

    pub(crate) fn add(&mut self, trial: &TrialRecord) {
        match trial.tier.is_graded() {
            true => self.graded.add(trial.outcome.status()),
            false => self.ungraded += 1,
        }
    }

    pub(crate) fn ended(&self) -> usize {
        self.graded.total() + self.ungraded
    }

    /// `203 trials`; of a run that has not come to its end `117 of 203 trials`.
    pub(crate) fn trials(&self) -> String {
        match self.ended() == self.planned {
            true => count(self.planned, "trial"),
            false => format!("{} of {}", self.ended(), count(self.planned, "trial")),
        }
    }

    /// The result in a few words, for titles. What is not graded fails nobody, and passes for nobody.
    pub(crate) fn headline(&self) -> String {
        let (total, passes) = (self.graded.total(), self.graded.count(Status::Pass));
        let trial = if self.ungraded > 0 { "graded trial" } else { "trial" };
        let all = count(total, trial);
        match (total, self.graded.failures()) {
            (0, _) => "no graded trial has a result".to_owned(),
            (_, 1) => format!("1 of {all} fails"),
            (_, failures @ 2..) => format!("{failures} of {all} fail"),
            (1, 0) if passes == 1 => format!("{all} passes"),
            (_, 0) if passes == total => format!("all {all} pass"),
            _ => format!("{passes} of {all} pass, none fails"),
        }
    }

    /// `117 pass, 1 fail, 2 skipped, 8 not graded`: together all that have ended.
    pub(crate) fn words(&self) -> String {
        let graded = self.graded.iter().map(|(status, count)| format!("{count} {}", status.word()));
        let others = (self.ungraded > 0).then(|| format!("{} not graded", self.ungraded));
        let words: Vec<_> = graded.chain(others).collect();
        if words.is_empty() { "none".to_owned() } else { words.join(", ") }
    }
}
