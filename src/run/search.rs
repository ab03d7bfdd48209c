//! Which components of the bench make the failures of a run go away: a cause by experiment.
//!
//! Components stand in an order, each after those that it is made of. Of each failing case the search finds the lowest
//! one without which it still fails, however much below it is taken, by halving; then whether that one is enough alone,
//! and if not, which of those below it are needed too.
//!
//! Not here: what is broken inside a component, which is what the cases of that component tell (`diagnosis`).

use super::attempt::run_with;
use super::bench::Bench;
use super::event::Event;
use super::outcome::Status;
use super::plan::{Plan, Trial};
use super::record::{CoreRecord, Transplanted, Transplants, TrialRecord};
use crate::contract::{Capabilities, Components};
use crate::stats::{Allowance, Budget};
use std::cmp::Reverse;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long the search may take for one core: about as long as the run before it, so that who waits for a wrong core
/// waits at most twice.
const LONGEST: Duration = Duration::from_secs(60);

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
    let mut failing: Vec<_> = ended.iter().filter(|(_, record)| is_failure(record)).collect();
    if failing.is_empty() || core.components.is_empty() {
        return None;
    }
    // Should the time be too short, it is for the fewest.
    failing.sort_by(|a, b| a.1.timing.seconds.total_cmp(&b.1.timing.seconds));
    let allowance = Allowance { budget: Budget::Quick, stops_at_failure: true };
    let bench = Bench { allowance, ..bench.clone() };
    let deadline = Instant::now() + LONGEST;
    let passes = |number: usize, with: Components| {
        let (trial, record) = failing[number];
        let is_in_time = Instant::now() < deadline;
        is_in_time.then(|| {
            run_with(&bench, trial, record.with | with).record.outcome.status() == Status::Pass
        })
    };
    let mut tried = |with: Components, cases: &[usize]| {
        in_parallel(plan.jobs(), cases, &|number| passes(number, with))
    };
    events(Event::Transplanting { core: &core.spec });
    let found = smallest(core.components, failing.len(), &mut tried);
    let judged =
        |one: Components| ended.iter().filter(|(_, record)| record.with.contains(one)).count();
    let of = |(component, alone, together)| Transplanted {
        component,
        alone,
        together,
        judged: judged(component),
    };
    // Where the bench traverses, the core counts nothing.
    let can_be_mended = |number: &&usize| {
        let (trial, _) = failing[**number];
        !trial.case.prepared.needs().contains(Capabilities::TRAVERSAL_STATS)
    };
    let unmended = found.unmended.iter().filter(can_be_mended);
    Some(Transplants {
        failures: failing.len(),
        components: found.set.into_iter().map(of).collect(),
        mended: found.mended,
        unmended: unmended.map(|number| failing[*number].1.case.clone()).collect(),
        untried: failing.len() - found.mended - found.unmended.len(),
    })
}

fn trial_of<'a>(plan: &'a Plan, record: &TrialRecord) -> Option<&'a Trial> {
    let is_it = |trial: &&Trial| trial.core.as_str() == record.core && trial.case.id == record.case;
    plan.trials.iter().find(is_it)
}

fn is_failure(record: &TrialRecord) -> bool {
    record.outcome.status().is_failure()
}

/// What came of trying some cases; those that there was no time for are in neither.
#[derive(Debug, Default)]
struct Tried {
    passing: Vec<usize>,
    failing: Vec<usize>,
}

/// Tries cases with these components.
type Try<'a> = &'a mut dyn FnMut(Components, &[usize]) -> Tried;

/// Tries `cases`, several at a time.
fn in_parallel(
    jobs: usize,
    cases: &[usize],
    passes: &(dyn Fn(usize) -> Option<bool> + Sync),
) -> Tried {
    let (next, tried) = (AtomicUsize::new(0), Mutex::new(Tried::default()));
    let work = || {
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            let passes = passes(*case);
            let mut tried = tried.lock().unwrap_or_else(PoisonError::into_inner);
            match passes {
                Some(true) => tried.passing.push(*case),
                Some(false) => tried.failing.push(*case),
                None => {}
            }
        }
    };
    std::thread::scope(|threads| {
        for _ in 0..jobs.min(cases.len()) {
            threads.spawn(work);
        }
    });
    tried.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// What the search comes to; failing cases by their numbers.
#[derive(Debug, PartialEq)]
struct Found {
    /// Each component, how many cases it mends alone, and how many with the others.
    set: Vec<(Components, usize, usize)>,
    mended: usize,
    unmended: Vec<usize>,
}

fn smallest(takes: Components, failures: usize, try_cases: Try<'_>) -> Found {
    let order: Vec<_> = takes.iter().collect();
    let Tried { passing, failing: unmended } = try_cases(takes, &Vec::from_iter(0..failures));
    let mut lowest = Vec::new();
    halve(&order, 0..order.len(), passing, try_cases, &mut lowest);
    let (mut set, mut found) = (Components::empty(), Vec::new());
    for (place, cases) in &lowest {
        let one = order[*place];
        let Tried { passing: alone, failing: not_alone } = try_cases(one, cases);
        let below = order[..*place].iter().copied().collect();
        set |= one | needed(below, one, &not_alone, try_cases);
        found.push((one, alone, cases));
    }
    let all: Vec<_> = lowest.iter().flat_map(|(_, cases)| cases.iter().copied()).collect();
    // Where there is no time left for all together, what was seen alone stands.
    let Tried { passing: mut mended, failing: spoiled } = try_cases(set, &all);
    let seen = found.iter().flat_map(|(_, alone, _)| alone.iter().copied());
    mended.extend(seen.filter(|case| !spoiled.contains(case)));
    mended.sort_unstable();
    mended.dedup();
    let of = |one: Components| {
        let known = found.iter().find(|(other, ..)| *other == one);
        known.map_or((one, 0, 0), |(_, alone, cases)| {
            (one, alone.len(), cases.iter().filter(|case| mended.contains(case)).count())
        })
    };
    let mut set: Vec<_> = set.iter().map(of).collect();
    set.sort_by_key(|(_, _, together)| Reverse(*together));
    Found { set, mended: mended.len(), unmended }
}

/// The place of the lowest component that each of `cases` needs, with everything below it taken. It lies in `range`:
/// they pass with all up to its end, and fail with all up to its start.
fn halve(
    order: &[Components],
    range: Range<usize>,
    cases: Vec<usize>,
    try_cases: Try<'_>,
    found: &mut Vec<(usize, Vec<usize>)>,
) {
    match (cases.len(), range.len()) {
        (0, _) => {}
        (_, 1) => found.push((range.start, cases)),
        _ => {
            let middle = range.start + range.len() / 2;
            let lower = order[..middle].iter().copied().collect();
            let Tried { passing, failing } = try_cases(lower, &cases);
            halve(order, range.start..middle, passing, try_cases, found);
            halve(order, middle..range.end, failing, try_cases, found);
        }
    }
}

/// Which of `below` these cases need beside `one`: each is given back, the highest first.
fn needed(
    mut below: Components,
    one: Components,
    cases: &[usize],
    try_cases: Try<'_>,
) -> Components {
    if cases.is_empty() {
        return Components::empty();
    }
    for other in Vec::from_iter(below.iter()).into_iter().rev() {
        if try_cases(one | (below - other), cases).passing.len() == cases.len() {
            below -= other;
        }
    }
    below
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Components = Components::BOX_TEST;
    const BSDF: Components = Components::BSDF;
    const PATH: Components = Components::PATH;

    /// A core each of whose failing cases passes with all of these; with nothing where there are none.
    fn found(needs: &[Option<Components>]) -> Found {
        let mut try_cases = |with: Components, cases: &[usize]| {
            let passes = |case: &usize| needs[*case].is_some_and(|needs| with.contains(needs));
            let (passing, failing) = cases.iter().partition(|case| passes(case));
            Tried { passing, failing }
        };
        smallest(Components::all(), needs.len(), &mut try_cases)
    }

    #[test]
    fn one_component_that_mends_everything_is_all_there_is() {
        assert_eq!(found(&[Some(BOX); 3]).set, [(BOX, 3, 3)]);
    }

    #[test]
    fn each_mistake_has_its_component_and_the_largest_comes_first() {
        let found = found(&[BOX, BSDF, BSDF, PATH, BSDF].map(Some));
        assert_eq!(found.set, [(BSDF, 3, 3), (BOX, 1, 1), (PATH, 1, 1)]);
        assert_eq!((found.mended, found.unmended.len()), (5, 0));
    }

    #[test]
    fn what_needs_two_is_mended_by_the_two_alone() {
        let found = found(&[Some(BOX | PATH); 2]);
        assert_eq!(found.set, [(PATH, 0, 2), (BOX, 0, 0)]);
    }

    #[test]
    fn what_nothing_mends_is_said() {
        let found = found(&[None, Some(BOX), None]);
        assert_eq!((found.set, found.unmended), (vec![(BOX, 1, 1)], vec![0, 2]));
    }

    #[test]
    fn what_there_was_no_time_for_is_neither() {
        let mut tries = 0;
        let mut try_cases = |_: Components, cases: &[usize]| {
            tries += 1;
            let passing = if tries == 1 { cases.to_vec() } else { Vec::new() };
            Tried { passing, failing: Vec::new() }
        };
        let found = smallest(Components::all(), 4, &mut try_cases);
        assert_eq!(found, Found { set: Vec::new(), mended: 0, unmended: Vec::new() });
    }
}
