//! Which components of the bench make the failures of a run go away: a cause by experiment.
//!
//! Each failing case is tried again with one component of the bench after another in place of the core's own, the
//! lowest first; the components that mend the most are kept until no failure is left, or none is mended. Only for
//! what no single one mends are all taken together, and then given back one by one.
//!
//! Not here: what is broken inside a component, which is what the cases of that component tell (`diagnosis`).

use super::attempt::run_with;
use super::bench::Bench;
use super::event::Event;
use super::outcome::Status;
use super::plan::{Plan, Trial};
use super::record::{CoreRecord, TrialRecord};
use crate::contract::Components;
use crate::stats::{Allowance, Budget};
use serde::{Deserialize, Serialize};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// How long the search may take for one core: about as long as the run before it, so that who waits for a wrong core
/// waits at most twice.
const LONGEST: Duration = Duration::from_secs(60);

/// What taking components from the bench has shown of a core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Transplants {
    /// How many failing cases were tried again.
    pub(crate) failures: usize,
    /// The smallest set of components found, the one that mends the most first.
    pub(crate) components: Vec<Transplanted>,
    /// Failing cases that pass with all of them.
    pub(crate) mended: usize,
    /// Failing cases that pass with none.
    pub(crate) unmended: Vec<String>,
    /// Whether the time was over before everything was tried.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) unfinished: bool,
}

/// One component that mends failures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Transplanted {
    /// It.
    pub(crate) component: Components,
    /// Failing cases that pass with it alone.
    pub(crate) alone: usize,
    /// Of those that pass with the whole set, how many need it.
    pub(crate) together: usize,
    /// Cases above that were judged with it in the run.
    pub(crate) judged: usize,
}

/// Tries the failing cases of a core again. None where nothing failed, or the core takes nothing.
pub(crate) fn search(
    plan: &Plan,
    bench: &Bench,
    core: &CoreRecord,
    records: &[TrialRecord],
    events: &mut dyn FnMut(Event<'_>),
) -> Option<Transplants> {
    let of_core = records.iter().filter(|record| record.core == core.spec);
    let ended: Vec<_> =
        of_core.filter_map(|record| Some((trial_of(plan, record)?, record))).collect();
    let failing: Vec<_> = ended.iter().filter(|(_, record)| is_failure(record)).collect();
    if failing.is_empty() || core.components.is_empty() {
        return None;
    }
    let allowance = Allowance { budget: Budget::Quick, stops_at_failure: true };
    let bench = Bench { allowance, ..bench.clone() };
    let deadline = Instant::now() + LONGEST;
    let passes = |(trial, record): &(&Trial, &TrialRecord), with: Components| {
        let record = run_with(&bench, trial, record.with | with).record;
        record.outcome.status() == Status::Pass
    };
    let mut mends = |with: Components, cases: &[usize]| {
        if cases.is_empty() {
            return Vec::new();
        }
        events(Event::Transplanting { core: &core.spec, with });
        let one = |number: usize| Instant::now() < deadline && passes(failing[number], with);
        in_parallel(plan.jobs(), cases, &one)
    };
    let found = smallest(core.components, failing.len(), &mut mends);
    let case = |number: &usize| failing[*number].1.case.clone();
    Some(Transplants {
        failures: failing.len(),
        mended: failing.len() - found.unmended.len(),
        unmended: found.unmended.iter().map(case).collect(),
        unfinished: Instant::now() >= deadline,
        components: found
            .set
            .into_iter()
            .map(|mut transplanted| {
                let with_it = |(_, record): &&(&Trial, &TrialRecord)| {
                    record.with.contains(transplanted.component)
                };
                transplanted.judged = ended.iter().filter(with_it).count();
                transplanted
            })
            .collect(),
    })
}

fn trial_of<'a>(plan: &'a Plan, record: &TrialRecord) -> Option<&'a Trial> {
    let is_it = |trial: &&Trial| trial.core.as_str() == record.core && trial.case.id == record.case;
    plan.trials.iter().find(is_it)
}

fn is_failure(record: &TrialRecord) -> bool {
    record.outcome.status().is_failure()
}

/// Those of `cases` that `passes` says yes to.
fn in_parallel(
    jobs: usize,
    cases: &[usize],
    passes: &(dyn Fn(usize) -> bool + Sync),
) -> Vec<usize> {
    let (next, passing) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            if passes(*case) {
                passing.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(*case);
            }
        }
    };
    std::thread::scope(|threads| {
        for _ in 0..jobs.min(cases.len()) {
            threads.spawn(work);
        }
    });
    let mut passing = passing.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    passing.sort_unstable();
    passing
}

/// What the search for the smallest set comes to; failing cases by their numbers.
#[derive(Debug, PartialEq)]
struct Found {
    set: Vec<Transplanted>,
    unmended: Vec<usize>,
}

/// Answers which of these failing cases pass with these components.
type Mends<'a> = &'a mut dyn FnMut(Components, &[usize]) -> Vec<usize>;

fn smallest(takes: Components, failures: usize, mends: Mends<'_>) -> Found {
    let all: Vec<_> = (0..failures).collect();
    let alone: Vec<_> = takes.iter().map(|one| (one, mends(one, &all))).collect();
    let (mut set, left) = cover(&alone, all.clone());
    let by_many = mends(takes, &left);
    if !by_many.is_empty() {
        set |= thinned(takes - set, set, &by_many, mends);
    }
    let mended = mends(set, &all);
    let needs = |one: Components, mends: Mends<'_>| match set == one {
        true => mended.len(),
        false => mended.len() - mends(set - one, &mended).len(),
    };
    let of =
        |one: Components| alone.iter().find(|(other, _)| *other == one).map_or(0, |(_, m)| m.len());
    let mut set: Vec<_> = set
        .iter()
        .map(|one| Transplanted {
            component: one,
            alone: of(one),
            together: needs(one, mends),
            judged: 0,
        })
        .collect();
    set.sort_by_key(|transplanted| std::cmp::Reverse(transplanted.together));
    let unmended = all.into_iter().filter(|case| !mended.contains(case)).collect();
    Found { set, unmended }
}

/// The one that mends the most of what is left, again and again; of equals the lowest. Also what none mends.
fn cover(alone: &[(Components, Vec<usize>)], mut left: Vec<usize>) -> (Components, Vec<usize>) {
    let mut set = Components::empty();
    loop {
        let mended = |of: &[usize]| left.iter().filter(|case| of.contains(case)).count();
        let best = alone.iter().rev().max_by_key(|(_, of)| mended(of));
        match best {
            Some((one, of)) if mended(of) > 0 => {
                set |= *one;
                left.retain(|case| !of.contains(case));
            }
            _ => return (set, left),
        }
    }
}

/// `more` without those that are not needed beside `set`: each is given back, the highest first.
fn thinned(mut more: Components, set: Components, cases: &[usize], mends: Mends<'_>) -> Components {
    let highest_first: Vec<_> = more.iter().collect();
    for one in highest_first.into_iter().rev() {
        if mends(set | (more - one), cases).len() == cases.len() {
            more -= one;
        }
    }
    more
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Components = Components::BOX_TEST;
    const BSDF: Components = Components::BSDF;
    const PATH: Components = Components::PATH;

    /// A core each of whose failing cases passes with all of these.
    fn found(needs: &[Components]) -> Found {
        let mut mends = |with: Components, cases: &[usize]| {
            cases.iter().copied().filter(|case| with.contains(needs[*case])).collect()
        };
        smallest(Components::all(), needs.len(), &mut mends)
    }

    fn set(found: &Found) -> Vec<(Components, usize, usize)> {
        found.set.iter().map(|one| (one.component, one.alone, one.together)).collect()
    }

    #[test]
    fn one_component_that_mends_everything_is_all_there_is() {
        assert_eq!(set(&found(&[BOX, BOX, BOX])), [(BOX, 3, 3)]);
    }

    #[test]
    fn each_mistake_has_its_component_and_the_largest_comes_first() {
        let found = found(&[BOX, BSDF, BSDF, PATH, BSDF]);
        assert_eq!(set(&found), [(BSDF, 3, 3), (BOX, 1, 1), (PATH, 1, 1)]);
        assert_eq!(found.unmended, [] as [usize; 0]);
    }

    #[test]
    fn what_needs_two_is_mended_by_the_two_alone() {
        let found = found(&[BOX | PATH, BOX | PATH]);
        assert_eq!(set(&found), [(BOX, 0, 2), (PATH, 0, 2)]);
    }

    #[test]
    fn what_nothing_mends_is_said() {
        let mut mends = |with: Components, cases: &[usize]| {
            cases.iter().copied().filter(|case| *case == 1 && with.contains(BOX)).collect()
        };
        let found = smallest(Components::all(), 3, &mut mends);
        assert_eq!((set(&found), found.unmended), (vec![(BOX, 1, 1)], vec![0, 2]));
    }
}
