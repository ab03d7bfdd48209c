//! A second look at what failed, one broken component at a time: with every other one that was found broken taken from
//! the bench, what is left of a failure is that component's own, and so is its cause.
//!
//! What the first look could not tell apart, two mistakes in one number, stands here apart, unless both are made in one
//! component.

use super::attempt::run_taking;
use super::bench::Bench;
use super::outcome::Status;
use super::plan::Plan;
use super::purse::{LEAST, Purse, price};
use super::record::{CoreRecord, Transplants, TrialRecord};
use super::search::{is_gross, without_patience};
use crate::case::asked_about;
use crate::contract::Components;
use crate::stats::{Allowance, Budget};

/// How much the second look may ask one core, as a share of what its trials did.
const SHARE: f64 = 0.75;
/// Seconds of the textbook core that each broken component may always be asked. With 7.5 two of the three views of
/// `textbook:depth-off-by-one+box-missed-from-inside+light-halved` left 5 of 21 and 5 of 27 cases.
const LEAST_FOR_EACH: u64 = 10;

/// What is seen of a core with one of its broken components.
pub(crate) struct SecondLook {
    /// The component that is its own.
    pub(crate) own: Components,
    /// Cases that were tried again; of all others the first look holds.
    pub(crate) again: Vec<TrialRecord>,
    /// Those of them that ask about it or are mended by it.
    pub(crate) of_own: Vec<String>,
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
    let least = LEAST.max(LEAST_FOR_EACH * broken.iter().count() as u64);
    let purse = Purse::of_share(SHARE, least, of_core());
    let bench = without_patience(bench);
    let allowance = Allowance { budget: Budget::Quick, ..bench.allowance };
    let quick = Bench { allowance, ..bench.clone() };
    // Its own cases come first, and the cheapest of them: should there be too little for all, the others go without.
    let telling = |own: Components| -> Vec<_> {
        let is_of_own = |record: &TrialRecord| is_of(plan, record, own, transplants);
        let tells = |record: &&TrialRecord| is_of_own(record) || is_seen_by_rules(record);
        let mut told: Vec<_> =
            of_core().filter(|record| has_no_answer(record)).filter(tells).collect();
        told.sort_by_key(|record| (!is_of_own(record), price(record)));
        told
    };
    let view = |((own, told), others): ((Components, Vec<&TrialRecord>), usize)| {
        purse.keep_for(others);
        let of_own = told.iter().filter(|record| is_of(plan, record, own, transplants));
        let of_own = of_own.map(|record| record.case.clone()).collect();
        let again = purse.pay_each(plan.jobs(), told.len(), &|number| {
            let record = told[number];
            let with = match transplants.place_of(&record.case) {
                // What it is not known what mends may fail for more than was found.
                None if is_of(plan, record, own, transplants) => {
                    beside(own, true, core.components, record.with)
                }
                mending => beside(own, mending == Some(own), broken, record.with),
            };
            again(plan, [&quick, &bench], record, with)
        });
        SecondLook { own, again: again.into_iter().flatten().collect(), of_own }
    };
    // Each has its share, and what those with few cases leave of theirs is for the others.
    let mut told: Vec<_> = broken.iter().map(|own| (own, telling(own))).collect();
    told.sort_by_key(|(_, told)| told.len());
    let others = (0..told.len()).rev();
    let mut views: Vec<_> = told.into_iter().zip(others).map(view).collect();
    views.sort_by_key(|view| view.own.bits());
    views
}

/// What of the `others` is the bench's where `own` is the core's. Of a case that is `about` it those that are made of it stay
/// the core's: with the bench's it is not asked. It was asked beside those that the case took in the run.
fn beside(own: Components, about: bool, others: Components, taken: Components) -> Components {
    let hides = |one: &Components| about && one.is_made_of(own);
    let hiding: Components = others.iter().filter(hides).collect();
    (taken | (others - hiding)) - own
}

/// Whether a case asks about `own` or is mended by it.
fn is_of(plan: &Plan, record: &TrialRecord, own: Components, transplants: &Transplants) -> bool {
    let trial = plan.trial_of(record);
    let asks = trial.is_some_and(|trial| asked_about(&trial.case).intersects(own));
    asks || transplants.place_of(&record.case) == Some(own)
}

/// Whether rules look at a failing case, whatever it asks about.
fn is_seen_by_rules(record: &TrialRecord) -> bool {
    record.role.is_some() && record.outcome.status() != Status::Blocked
}

/// Whether a case failed, or was not asked because another one did.
fn has_no_answer(record: &TrialRecord) -> bool {
    let status = record.outcome.status();
    status.is_failure() || status == Status::Blocked
}

/// The trial with these components of the bench, and its price. What would be the same is not tried again. Of what fails
/// grossly a quick look is enough, unless it passes: it may have failed for what is taken.
fn again(
    plan: &Plan,
    [quick, closely]: [&Bench; 2],
    record: &TrialRecord,
    with: Components,
) -> (Option<TrialRecord>, u64) {
    if with == record.with && record.outcome.status() != Status::Blocked {
        return (Some(record.clone()), 0);
    }
    let Some(trial) = plan.trial_of(record) else { return (None, 0) };
    let coarser = quick.allowance.coarseness() / closely.allowance.coarseness();
    let is_gross = record.outcome.finding().is_some_and(|finding| is_gross(finding, coarser));
    let look = |bench: &Bench| {
        let (ended, own) = run_taking(bench, trial, with);
        (ended.record, own)
    };
    let (mut seen, mut own) = look(if is_gross { quick } else { closely });
    let mut price_of_all = price(&seen);
    if is_gross && coarser > 1.0 && !seen.outcome.status().is_failure() {
        (seen, own) = look(closely);
        price_of_all += price(&seen);
    }
    // A trial has less time here: what it did not come to, the first look holds. So it does where it may have failed for what
    // the core did not take after all.
    let tells = seen.outcome.status() != Status::TimedOut && own.is_empty();
    (tells.then_some(seen), price_of_all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_hides_a_component_is_the_cores_unless_the_run_had_taken_it() {
        let (own, bsdf) = (Components::DIRECTION_SAMPLING, Components::BSDF);
        let broken = own | bsdf | Components::BOX_TEST;
        let nothing = Components::empty();
        assert_eq!(beside(own, false, broken, nothing), bsdf | Components::BOX_TEST);
        assert_eq!(beside(own, true, broken, nothing), Components::BOX_TEST);
        assert_eq!(beside(own, true, broken, bsdf), bsdf | Components::BOX_TEST);
        assert_eq!(beside(bsdf, true, broken, bsdf), own | Components::BOX_TEST);
        let of_all = beside(own, true, Components::all(), nothing);
        assert!(of_all.contains(Components::BOX_TEST) && !of_all.intersects(own | bsdf));
    }
}
