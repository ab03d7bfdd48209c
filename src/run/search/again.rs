//! The failing cases of a core, tried again with components of the bench: at a glance where that is enough, and never twice.

use super::Tried;
use crate::checks::{Finding, Measure};
use crate::contract::Components;
use crate::run::attempt::run_with;
use crate::run::bench::Bench;
use crate::run::outcome::Status;
use crate::run::plan::Trial;
use crate::run::purse::{LONGEST_TRIAL, Purse, price};
use crate::run::record::TrialRecord;
use crate::stats::{Allowance, Budget};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What was asked: which case, with what of the bench, and whether closely.
type Asked = (usize, Components, bool);
/// Whether a case passes; none where it could not be asked. And its price.
type Answer = (Option<bool>, u64);

/// What failed, and what came of trying it again.
pub(super) struct Again<'a> {
    /// The cheapest first: should there be too little for all, it is for the longest.
    pub(super) failing: Vec<(&'a Trial, &'a TrialRecord)>,
    pub(super) purse: Purse,
    jobs: usize,
    closely: Bench,
    glancing: Bench,
    /// Whether the run was a quick one, as this is.
    is_as_sharp: bool,
    known: Mutex<BTreeMap<Asked, Option<bool>>>,
}

impl<'a> Again<'a> {
    pub(super) fn new(
        mut failing: Vec<(&'a Trial, &'a TrialRecord)>,
        purse: Purse,
        jobs: usize,
        bench: &Bench,
    ) -> Self {
        failing.sort_by_key(|(_, record)| price(record));
        let allowance = Allowance { stops_at_failure: true, ..Budget::Quick.into() };
        let closely = Bench { allowance, ..without_patience(bench) };
        let allowance = Allowance { looks_roughly: true, ..allowance };
        let glancing = Bench { allowance, ..closely.clone() };
        let is_as_sharp = bench.allowance.budget == Budget::Quick;
        let known = Mutex::default();
        Self { failing, purse, jobs, closely, glancing, is_as_sharp, known }
    }

    /// Those that fail here as they did in the run. A small error that only a larger budget sees would pass here whatever is
    /// taken, and prove nothing.
    pub(super) fn failing_still(&self, cases: Vec<usize>) -> Vec<usize> {
        if self.is_as_sharp {
            return cases;
        }
        let asked: Vec<_> = cases.iter().map(|case| (*case, Components::empty(), true)).collect();
        let failing = |case: &usize| {
            self.known().get(&(*case, Components::empty(), true)) == Some(&Some(false))
        };
        self.ask(&asked);
        cases.into_iter().filter(failing).collect()
    }

    /// Tries cases with these components; closely those that are among `closely`, or whose failure is too small to be seen
    /// at a glance.
    pub(super) fn tried(
        &self,
        with: Components,
        cases: &[usize],
        closely: &BTreeSet<usize>,
    ) -> Tried {
        let asked = |case: &usize| (*case, with, closely.contains(case) || !self.is_gross(*case));
        let asked: Vec<_> = cases.iter().map(asked).collect();
        self.ask(&asked);
        let known = self.known();
        let of = |wanted: bool| {
            let told = asked.iter().filter(|asked| known.get(asked) == Some(&Some(wanted)));
            told.map(|(case, ..)| *case).collect()
        };
        Tried { passing: of(true), failing: of(false) }
    }

    /// What a case may take when it is tried again.
    pub(super) fn price(&self, number: usize) -> u64 {
        let price = price(self.failing[number].1);
        match self.is_gross(number) {
            true => (price as f64 / self.times_coarser().powi(2)) as u64,
            false => price,
        }
    }

    /// Asks what is not known, for as much as can be paid.
    fn ask(&self, all: &[Asked]) {
        let new: Vec<_> = all.iter().filter(|asked| !self.known().contains_key(asked)).collect();
        let answers = self.purse.pay_each(self.jobs, new.len(), &|place| self.answer(*new[place]));
        self.known().extend(new.into_iter().copied().zip(answers));
    }

    fn answer(&self, (number, with, closely): Asked) -> Answer {
        let (trial, record) = self.failing[number];
        if !with.is_empty() && record.with.contains(with) {
            // So it was tried in the run.
            return (Some(false), 0);
        }
        let bench = if closely { &self.closely } else { &self.glancing };
        let ended = run_with(bench, trial, record.with | with).record;
        // Of silence it cannot be told what would have come of waiting longer, where there was none before.
        let was_silent = record.outcome.status() == Status::TimedOut;
        let passes = match ended.outcome.status() {
            Status::TimedOut if !was_silent => None,
            // With these it cannot be asked.
            Status::Skipped | Status::Blocked | Status::Broken => None,
            ended => Some(ended == Status::Pass),
        };
        (passes, price(&ended))
    }

    fn is_gross(&self, number: usize) -> bool {
        let finding = self.failing[number].1.outcome.finding();
        finding.is_some_and(|finding| is_gross(finding, self.times_coarser()))
    }

    fn times_coarser(&self) -> f64 {
        self.glancing.allowance.coarseness() / self.closely.allowance.coarseness()
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<Asked, Option<bool>>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Whether something is so wrong that it would still fail were its error and its noise that many times as large as what is
/// seen of them.
fn is_gross(finding: &Finding, coarser: f64) -> bool {
    finding.failed_measures().any(|Measure { measured, expected, allowed, interval, .. }| {
        let noise = interval.map(|[low, high]| 0.5 * (high - low));
        noise.is_some_and(|noise| (measured - expected).abs() > coarser * (allowed + noise))
    })
}

/// The bench for trials with transplants: it knows nothing of the silences of a core without them.
pub(in crate::run) fn without_patience(bench: &Bench) -> Bench {
    let mut hosting = bench.hosting.clone().patient();
    hosting.limits.seconds =
        hosting.limits.seconds.map(|seconds| seconds.min(LONGEST_TRIAL as f64));
    Bench { hosting, ..bench.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_far_beyond_its_noise_and_what_is_allowed_is_seen_at_a_glance() {
        let of = |measured: f64, noise: f64| {
            let mean = Measure::exact("mean", measured, 1.0, 0.05);
            let interval = Some([measured - noise, measured + noise]);
            Finding::of("", "", vec![Measure { interval, ..mean }])
        };
        assert!(is_gross(&of(1.5, 0.1), 2.5));
        assert!(!is_gross(&of(1.5, 0.2), 2.5));
        assert!(!is_gross(&of(1.1, 0.0), 2.5));
        assert!(!is_gross(&of(f64::NAN, 0.1), 2.5));
        let exact = vec![Measure::exact("hits", 9.0, 1.0, 0.05)];
        assert!(
            !is_gross(&Finding::of("", "", exact), 2.5),
            "no fewer samples where there are none"
        );
    }
}
