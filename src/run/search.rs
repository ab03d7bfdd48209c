//! Which components of the bench make the failures of a run go away: a cause by experiment.
//!
//! Components stand in an order, each after those that it is made of. Of each failing case the search finds the lowest
//! one without which it still fails, however much below it is taken: first it tries the one that the case asks about,
//! which takes two trials; of what is left it goes on by halving, then whether that one is enough alone, and if not,
//! which of those below it are needed too.
//!
//! Not here: what is broken inside a component, which is what the cases of that component tell (`diagnosis`).

use super::attempt::run_with;
use super::bench::Bench;
use super::event::Event;
use super::outcome::Status;
use super::plan::Plan;
use super::purse::{LONGEST_TRIAL, Purse, price};
use super::record::{CoreRecord, Transplanted, Transplants, TrialRecord};
use crate::case::asked_about;
use crate::contract::{Capabilities, Components};
use crate::stats::{Allowance, Budget};
use std::cmp::Reverse;
use std::ops::Range;

/// How much the search may ask one core, as a share of what its trials did: who waits for a wrong core waits little
/// longer.
const SHARE: f64 = 0.5;
/// What the search takes for one failing case, in times of its trial in the run: twelve components are halved four
/// times, and each is looked at alone and with the others; each trial is shorter, but on components that cross a
/// boundary.
const COST: u64 = 6;

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
        of_core.filter_map(|record| Some((plan.trial_of(record)?, record))).collect();
    // What is only informational stays the core's own affair.
    let mut failing: Vec<_> = ended.iter().filter(|(_, record)| record.fails_the_core()).collect();
    if failing.is_empty() || core.components.is_empty() {
        return None;
    }
    // Should there be too little for all, it is for the longest.
    failing.sort_by_key(|(_, record)| price(record));
    let purse = Purse::of_share(SHARE, ended.iter().map(|(_, record)| *record));
    let affordable = |cases: &[usize]| {
        affordable(cases.iter().map(|number| price(failing[*number].1)), purse.left())
    };
    let is_as_sharp = bench.allowance.budget == Budget::Quick;
    let allowance = Allowance { stops_at_failure: true, ..Budget::Quick.into() };
    let bench = Bench { allowance, ..without_patience(bench) };
    let try_again = |number: usize, with: Components| {
        let (trial, record) = failing[number];
        let ended = run_with(&bench, trial, record.with | with).record;
        // Of silence it cannot be told what would have come of waiting longer, where there was none before.
        let was_silent = record.outcome.status() == Status::TimedOut;
        let passes = match ended.outcome.status() {
            Status::TimedOut if !was_silent => None,
            // With these it cannot be asked.
            Status::Skipped | Status::Blocked | Status::Broken => None,
            ended => Some(ended == Status::Pass),
        };
        (passes, price(&ended))
    };
    let passes = |number: usize, with: Components| match failing[number].1.with.contains(with) {
        // So it was tried in the run.
        true => (Some(false), 0),
        false => try_again(number, with),
    };
    type Answer = (Option<bool>, u64);
    let each = |cases: &[usize], answer: &(dyn Fn(usize) -> Answer + Sync)| {
        sorted(purse.pay_each(plan.jobs(), cases.len(), &|place| {
            let (passes, price) = answer(cases[place]);
            ((cases[place], passes), price)
        }))
    };
    let mut tried = |with: Components, cases: &[usize]| each(cases, &|number| passes(number, with));
    events(Event::Transplanting { core: &core.spec });
    // What died or hung may hang again, for longer than others take: it comes last.
    let is_judged = |number: &usize| failing[*number].1.outcome.finding().is_some();
    let (mut judged_first, ended_last): (Vec<_>, Vec<_>) = (0..failing.len()).partition(is_judged);
    // A small error that only a larger budget sees would pass here whatever is taken, and prove nothing.
    if !is_as_sharp {
        judged_first =
            each(&judged_first, &|number| try_again(number, Components::empty())).failing;
    }
    let failures = Failures {
        turns: [judged_first, ended_last],
        asks: &|number| asked_about(&failing[number].0.case),
        affordable: &affordable,
    };
    let found = smallest(core.components, &failures, &mut tried);
    let judged =
        |one: Components| ended.iter().filter(|(_, record)| record.with.contains(one)).count();
    let name = |number: &usize| failing[*number].1.case.clone();
    let of = |part: Mending| Transplanted {
        component: part.component,
        alone: part.alone,
        together: part.together.len(),
        judged: judged(part.component),
        cases: part.together.iter().map(name).collect(),
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
        unmended: unmended.map(name).collect(),
        untried: failing.len() - found.mended - found.unmended.len(),
    })
}

/// The bench for trials with transplants: it knows nothing of the silences of a core without them.
pub(super) fn without_patience(bench: &Bench) -> Bench {
    let mut hosting = bench.hosting.clone().patient();
    hosting.limits.seconds =
        hosting.limits.seconds.map(|seconds| seconds.min(LONGEST_TRIAL as f64));
    Bench { hosting, ..bench.clone() }
}

/// How many cases of such prices, the cheapest first, can be searched with what is left: one at least.
fn affordable(prices: impl Iterator<Item = u64>, left: u64) -> usize {
    let costs = prices.scan(0, |sum, price| {
        *sum += COST * price;
        Some(*sum)
    });
    costs.take_while(|cost| *cost <= left).count().max(1)
}

/// What came of trying some cases; those that could not be paid are in neither.
#[derive(Debug, Default)]
struct Tried {
    passing: Vec<usize>,
    failing: Vec<usize>,
}

/// Tries cases with these components.
type Try<'a> = &'a mut dyn FnMut(Components, &[usize]) -> Tried;

/// What passes of `cases`, and what fails, as told by their numbers.
fn sorted(tried: Vec<(usize, Option<bool>)>) -> Tried {
    let of = |wanted: bool| {
        let tried = tried.iter().filter(|(_, passes)| *passes == Some(wanted));
        tried.map(|(case, _)| *case).collect()
    };
    Tried { passing: of(true), failing: of(false) }
}

/// What the search comes to; failing cases by their numbers.
#[derive(Debug, PartialEq)]
struct Found {
    set: Vec<Mending>,
    mended: usize,
    unmended: Vec<usize>,
}

/// A component of the set.
#[derive(Debug, PartialEq)]
struct Mending {
    component: Components,
    /// How many cases it mends alone.
    alone: usize,
    /// Those it mends with the others.
    together: Vec<usize>,
}

impl Found {
    /// Cases that there was no time to halve, tried with what was found for others: each belongs to the highest component
    /// that it needs.
    fn try_on(&mut self, mut cases: Vec<usize>, try_cases: Try<'_>) {
        self.set.sort_by_key(|part| part.component.bits());
        let mut with = Components::empty();
        for part in &mut self.set {
            with |= part.component;
            let Tried { passing, failing } = try_cases(with, &cases);
            part.alone += if with == part.component { passing.len() } else { 0 };
            self.mended += passing.len();
            part.together.extend(passing);
            cases = failing;
        }
    }
}

/// What failed, by numbers, and what is known of it.
struct Failures<'a> {
    /// What comes first, and what waits until that has been tried.
    turns: [Vec<usize>; 2],
    /// The components that a case asks about.
    asks: &'a dyn Fn(usize) -> Components,
    /// How many of these there is time to halve.
    affordable: &'a dyn Fn(&[usize]) -> usize,
}

/// A component that cases need so that they pass, however much below it is taken.
#[derive(Debug)]
struct Needed {
    component: Components,
    /// Those that it mends alone.
    alone: Vec<usize>,
    /// Those that it mends with others.
    with_others: Vec<usize>,
}

impl Needed {
    fn cases(&self) -> impl Iterator<Item = usize> + '_ {
        self.alone.iter().chain(&self.with_others).copied()
    }
}

fn smallest(takes: Components, failures: &Failures<'_>, try_cases: Try<'_>) -> Found {
    let order: Vec<_> = takes.iter().collect();
    let (mut found, mut rest) = (Vec::new(), Vec::new());
    for turn in &failures.turns {
        rest.extend(of_what_they_ask(&order, turn.clone(), failures.asks, try_cases, &mut found));
    }
    let late = rest.split_off((failures.affordable)(&rest).min(rest.len()));
    let Tried { passing, failing: unmended } = try_cases(takes, &rest);
    let mut lowest = Vec::new();
    halve(&order, 0..order.len(), passing, try_cases, &mut lowest);
    let mut beside = Components::empty();
    for (place, cases) in lowest {
        let component = order[place];
        let Tried { passing: alone, failing: with_others } = try_cases(component, &cases);
        let below = order[..place].iter().copied().collect();
        beside |= needed(below, component, &with_others, try_cases);
        found.push(Needed { component, alone, with_others });
    }
    let found = without_needless(found, try_cases);
    let set = beside | found.iter().map(|of| of.component).collect();
    let mut found = Found { set: together(set, &found, try_cases), mended: 0, unmended };
    found.mended = found.set.iter().map(|part| part.together.len()).sum();
    found.try_on(late, try_cases);
    found.set.sort_by_key(|part| Reverse(part.together.len()));
    found
}

/// Of components that are not made of each other, two may mend a case: it belongs to the one that mends more.
fn without_needless(mut found: Vec<Needed>, try_cases: Try<'_>) -> Vec<Needed> {
    found.sort_by_key(|of| of.alone.len());
    for number in 0..found.len() {
        let [few, more @ ..] = &mut found[number..] else { break };
        for other in more.iter_mut().rev() {
            let mends_more = other.alone.len() > few.alone.len();
            if mends_more && !other.component.is_made_of(few.component) {
                let Tried { passing, .. } = try_cases(other.component, &few.alone);
                few.alone.retain(|case| !passing.contains(case));
                other.alone.extend(passing);
            }
        }
    }
    found.retain(|of| of.cases().next().is_some());
    found.sort_by_key(|of| of.component.bits());
    found
}

/// What mends all that was found at once.
fn together(set: Components, found: &[Needed], try_cases: Try<'_>) -> Vec<Mending> {
    let all: Vec<_> = found.iter().flat_map(Needed::cases).collect();
    let Tried { passing, failing: spoiled } = try_cases(set, &all);
    // Where there is no time left for all together, what was seen alone stands.
    let stands = |of: &Needed, case: usize| {
        passing.contains(&case) || of.alone.contains(&case) && !spoiled.contains(&case)
    };
    let mending = |component: Components| {
        let known = || found.iter().filter(move |of| of.component == component);
        let of_one = |of: &Needed| Vec::from_iter(of.cases().filter(|case| stands(of, *case)));
        let mut together: Vec<_> = known().flat_map(of_one).collect();
        together.sort_unstable();
        Mending { component, alone: known().map(|of| of.alone.len()).sum(), together }
    };
    set.iter().map(mending).collect()
}

/// Finds those of `cases` that a component they ask about mends alone, and everything below it does not. Answers the
/// rest.
fn of_what_they_ask(
    order: &[Components],
    mut cases: Vec<usize>,
    asks: &dyn Fn(usize) -> Components,
    try_cases: Try<'_>,
    found: &mut Vec<Needed>,
) -> Vec<usize> {
    for (place, component) in order.iter().copied().enumerate() {
        let asking: Vec<_> =
            cases.iter().copied().filter(|case| asks(*case).contains(component)).collect();
        let alone = try_cases(component, &asking).passing;
        let below = order[..place].iter().copied().collect();
        let alone = if place == 0 { alone } else { try_cases(below, &alone).failing };
        cases.retain(|case| !alone.contains(case));
        if !alone.is_empty() {
            found.push(Needed { component, alone, with_others: Vec::new() });
        }
    }
    cases
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
        asking(needs, &|_| Components::empty(), needs.len())
    }

    /// The same where cases ask about these components, and so many can be halved.
    fn asking(
        needs: &[Option<Components>],
        asks: &dyn Fn(usize) -> Components,
        affordable: usize,
    ) -> Found {
        let turns = [(0..needs.len()).collect(), Vec::new()];
        let failures = Failures { turns, asks, affordable: &|_| affordable };
        smallest(Components::all(), &failures, &mut trying(needs))
    }

    fn trying(needs: &[Option<Components>]) -> impl FnMut(Components, &[usize]) -> Tried {
        |with, cases| {
            let passes = |case: &usize| needs[*case].is_some_and(|needs| with.contains(needs));
            let (passing, failing) = cases.iter().partition(|case| passes(case));
            Tried { passing, failing }
        }
    }

    /// Each component, how many cases it mends alone, and how many with the others.
    fn counts(found: &Found) -> Vec<(Components, usize, usize)> {
        found.set.iter().map(|part| (part.component, part.alone, part.together.len())).collect()
    }

    #[test]
    fn one_component_that_mends_everything_is_all_there_is() {
        assert_eq!(counts(&found(&[Some(BOX); 3])), [(BOX, 3, 3)]);
    }

    #[test]
    fn each_mistake_has_its_component_and_the_largest_comes_first() {
        let found = found(&[BOX, BSDF, BSDF, PATH, BSDF].map(Some));
        assert_eq!(counts(&found), [(BSDF, 3, 3), (BOX, 1, 1), (PATH, 1, 1)]);
        assert_eq!(found.set[0].together, [1, 2, 4]);
        assert_eq!((found.mended, found.unmended.len()), (5, 0));
    }

    #[test]
    fn what_two_can_mend_belongs_to_the_one_that_mends_more() {
        const LIGHTS: Components = Components::LIGHT_SAMPLING;
        const EMISSION: Components = Components::EMISSION;
        // The first two pass with either; the last is mended by what emission is no part of.
        let mut try_cases = |with: Components, cases: &[usize]| {
            let passes = |case: &usize| match case {
                0 | 1 => with.contains(EMISSION) || with.contains(LIGHTS),
                5 => with.contains(BOX) || with.contains(PATH),
                _ => with.contains(EMISSION),
            };
            let (passing, failing) = cases.iter().partition(|case| passes(case));
            Tried { passing, failing }
        };
        let asks = |case: usize| [LIGHTS, LIGHTS, EMISSION, EMISSION, EMISSION, BOX][case];
        let turns = [(0..6).collect(), Vec::new()];
        let failures = Failures { turns, asks: &asks, affordable: &|_| 6 };
        let found = smallest(Components::all(), &failures, &mut try_cases);
        assert_eq!(counts(&found), [(EMISSION, 5, 5), (BOX, 1, 1)]);
    }

    #[test]
    fn what_needs_two_is_mended_by_the_two_alone() {
        let found = found(&[Some(BOX | PATH); 2]);
        assert_eq!(counts(&found), [(PATH, 0, 2), (BOX, 0, 0)]);
    }

    #[test]
    fn the_cheapest_cases_are_searched_for_as_far_as_the_purse_goes() {
        let affordable = |left| affordable([5, 10, 20, 300].into_iter(), left);
        assert_eq!([5, 95, 200, 215, 3000].map(affordable), [1, 2, 2, 3, 4]);
    }

    #[test]
    fn what_there_is_no_time_to_halve_is_tried_with_what_was_found() {
        let needs = [BOX, PATH, BOX, BOX | PATH, PATH, BSDF].map(Some);
        let found = asking(&needs, &|_| Components::empty(), 2);
        assert_eq!(counts(&found), [(PATH, 1, 3), (BOX, 2, 2)]);
        let of_path = found.set.iter().find(|part| part.component == PATH);
        assert_eq!(
            (found.mended, of_path.map(|part| &part.together[..])),
            (5, Some(&[1, 3, 4][..]))
        );
    }

    #[test]
    fn the_component_that_a_case_asks_about_is_tried_first_and_then_all_below_it() {
        let needs = [Some(PATH), Some(BOX), Some(BOX | PATH)];
        let mut tried = Vec::new();
        let failures = Failures {
            turns: [vec![0, 1], vec![2]],
            asks: &|_| PATH,
            affordable: &|rest| {
                assert_eq!(rest, [1, 2]);
                0
            },
        };
        let mut answer = trying(&needs);
        let mut try_cases = |with: Components, cases: &[usize]| {
            tried.extend(cases.iter().map(|case| (*case, with)));
            answer(with, cases)
        };
        let found = smallest(BOX | PATH, &failures, &mut try_cases);
        // Of the second the box test is to blame, with whose mistake the path was asked.
        assert_eq!(found.set[0].together, [0]);
        let of = |number: usize| tried.iter().filter(|(case, _)| *case == number).count();
        assert_eq!(of(0), 3);
    }

    #[test]
    fn what_nothing_mends_is_said() {
        let found = found(&[None, Some(BOX), None]);
        assert_eq!((counts(&found), found.unmended), (vec![(BOX, 1, 1)], vec![0, 2]));
    }

    #[test]
    fn what_there_was_no_time_for_is_neither() {
        let mut tries = 0;
        let mut try_cases = |_: Components, cases: &[usize]| {
            tries += 1;
            let passing = if tries == 1 { cases.to_vec() } else { Vec::new() };
            Tried { passing, failing: Vec::new() }
        };
        let turns = [(0..4).collect(), Vec::new()];
        let failures = Failures { turns, asks: &|_| Components::empty(), affordable: &|_| 4 };
        let found = smallest(Components::all(), &failures, &mut try_cases);
        assert_eq!(found, Found { set: Vec::new(), mended: 0, unmended: Vec::new() });
    }
}
