//! A second look at what failed, one broken component at a time: with every other one that was found broken taken from
//! the bench, what is left of a failure is that component's own, and so is its cause.
//!
//! What the first look could not tell apart, two mistakes in one number, stands here apart, unless both are made in one
//! component.

use super::attempt::run_with;
use super::bench::Bench;
use super::outcome::Status;
use super::plan::Plan;
use super::record::{CoreRecord, Transplants, TrialRecord};
use super::search::{Purse, each_in_parallel, taken, trial_of, without_patience};
use crate::case::asked_about;
use crate::contract::Components;
/// How long the second look may take for one core, as a share of what its trials took.
const SHARE: f64 = 0.5;

/// What is seen of a core with one of its broken components.
pub(crate) struct SecondLook {
    /// The component that is its own.
    pub(crate) own: Components,
    /// Cases that were tried again; of all others the first look holds.
    pub(crate) again: Vec<TrialRecord>,
}

/// A view for each component found broken, the lowest first.
pub(crate) fn look_again(
    plan: &Plan,
    bench: &Bench,
    core: &CoreRecord,
    records: &[TrialRecord],
    transplants: &Transplants,
) -> Vec<SecondLook> {
    let broken: Components = transplants.components.iter().map(|one| one.component).collect();
    let of_core = || records.iter().filter(|record| record.core == core.spec);
    let purse = Purse::of_share(SHARE, taken(of_core()));
    let bench = without_patience(bench);
    let view = |own: Components| {
        let tells = |record: &&TrialRecord| tells_of(plan, record, own, transplants);
        let told: Vec<_> = of_core().filter(tells).collect();
        let again = each_in_parallel(plan.jobs(), told.len(), &|number| {
            purse.pay(|| again(plan, &bench, told[number], broken, own))?
        });
        SecondLook { own, again }
    };
    broken.iter().map(view).collect()
}

/// Whether a case that did not pass may tell of `own`: it asks about it, is mended by it, or is one that rules look at.
fn tells_of(plan: &Plan, record: &TrialRecord, own: Components, transplants: &Transplants) -> bool {
    let asks = || {
        let trial = trial_of(plan, record);
        trial.is_some_and(|trial| asked_about(&trial.case).intersects(own))
    };
    match record.outcome.status() {
        Status::Blocked => asks(),
        Status::Fail | Status::Crashed | Status::TimedOut => {
            record.role.is_some() || transplants.place_of(&record.case) == Some(own) || asks()
        }
        _ => false,
    }
}

/// The trial with all that is broken taken from the bench but `own`. What would be the same is not tried again.
fn again(
    plan: &Plan,
    bench: &Bench,
    record: &TrialRecord,
    broken: Components,
    own: Components,
) -> Option<TrialRecord> {
    let with = (record.with | broken) - own;
    if with == record.with && record.outcome.status() != Status::Blocked {
        return Some(record.clone());
    }
    let seen = run_with(bench, trial_of(plan, record)?, with).record;
    // A trial has less time here: what it did not come to, the first look holds.
    (seen.outcome.status() != Status::TimedOut).then_some(seen)
}
