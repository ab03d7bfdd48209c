//! Which trial is next: the first, in the order of the plan, whose foundations have been tried. A trial whose
//! foundation was found broken is not tried at all: it is blocked.

use super::bench::Bench;
use super::outcome::Status;
use super::plan::{Plan, Trial};
use crate::case::{Case, Foundation, foundations};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    Try(usize),
    Blocked(usize, String),
}

/// Hands out the trials of a plan to threads.
pub(crate) struct Schedule<'a> {
    plan: &'a Plan,
    /// For each trial the numbers of those that prove what it rests on.
    rests_on: Vec<Vec<usize>>,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    fates: Vec<Fate>,
    stopped: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Fate {
    /// Not to be tried: nobody asked.
    Left,
    Waiting,
    Running,
    /// It ended; the case that others which rest on it are blocked by.
    Ended(Option<String>),
}

impl<'a> Schedule<'a> {
    /// All trials whose numbers are in `todo`. `earlier` is what a run that was cut off already knows.
    pub(crate) fn new(
        plan: &'a Plan,
        bench: &Bench,
        todo: &[usize],
        earlier: &[(usize, Status)],
    ) -> Self {
        let mut fates = vec![Fate::Left; plan.trials.len()];
        for number in todo {
            fates[*number] = Fate::Waiting;
        }
        for (number, status) in earlier {
            fates[*number] = Fate::Ended(blocker(&plan.trials[*number], *status));
        }
        Self {
            plan,
            rests_on: provers(plan, bench),
            state: Mutex::new(State { fates, stopped: false }),
            changed: Condvar::new(),
        }
    }

    /// The next trial; waits where all that is left rests on what is being tried. None when nothing is left.
    pub(crate) fn next(&self) -> Option<Next> {
        let mut state = self.lock();
        loop {
            if state.stopped {
                return None;
            }
            let waiting = || (0..state.fates.len()).filter(|n| state.fates[*n] == Fate::Waiting);
            if let Some(number) = waiting().find(|number| self.is_ready(&state, *number)) {
                let blocked = self.rests_on[number].iter().find_map(|n| match &state.fates[*n] {
                    Fate::Ended(by) => by.clone(),
                    _ => None,
                });
                state.fates[number] = match &blocked {
                    Some(by) => Fate::Ended(Some(by.clone())),
                    None => Fate::Running,
                };
                return Some(blocked.map_or(Next::Try(number), |by| Next::Blocked(number, by)));
            }
            waiting().next()?;
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    pub(crate) fn ended(&self, number: usize, status: Status) {
        self.lock().fates[number] = Fate::Ended(blocker(&self.plan.trials[number], status));
        self.changed.notify_all();
    }

    pub(crate) fn stop(&self) {
        self.lock().stopped = true;
        self.changed.notify_all();
    }

    /// Whether nothing it rests on is still to be tried.
    fn is_ready(&self, state: &State, number: usize) -> bool {
        let open = |n: &usize| matches!(state.fates[*n], Fate::Waiting | Fate::Running);
        !self.rests_on[number].iter().any(open)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What others are blocked by if this trial ended so.
fn blocker(trial: &Trial, status: Status) -> Option<String> {
    status.is_failure().then(|| trial.case.id.clone())
}

/// For each trial the numbers of the trials of the same core that prove what it rests on.
fn provers(plan: &Plan, bench: &Bench) -> Vec<Vec<usize>> {
    let mut proving: BTreeMap<(&str, Foundation), Vec<usize>> = BTreeMap::new();
    for (number, trial) in plan.trials.iter().enumerate() {
        for foundation in &trial.case.proves {
            proving.entry((trial.core.as_str(), *foundation)).or_default().push(number);
        }
    }
    let mut known: BTreeMap<&str, BTreeSet<Foundation>> = BTreeMap::new();
    let numbers = |trial: &'_ Trial, found: &BTreeSet<Foundation>| {
        let of = |f: &Foundation| proving.get(&(trial.core.as_str(), *f)).cloned();
        found.iter().filter_map(of).flatten().collect()
    };
    plan.trials
        .iter()
        .map(|trial| {
            let case: &Case = &trial.case;
            let found = known.entry(&case.id).or_insert_with(|| of_case(bench, case));
            numbers(trial, found)
        })
        .collect()
}

/// A scene that cannot be read rests on nothing: its trial is broken by itself.
fn of_case(bench: &Bench, case: &Case) -> BTreeSet<Foundation> {
    let load = |choice: &crate::case::SceneChoice| choice.load(&bench.scenes).ok();
    foundations(case, case.scene.as_ref().and_then(load).as_deref())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case;
    use crate::project::Project;
    use crate::run::Request;
    use crate::stats::Budget;

    const TRIANGLE: &str = "shape/ray-triangle-hits-are-right";
    const SPHERE: &str = "shape/ray-sphere-hit-is-the-nearest-root-ahead";
    const FURNACE: &str = "integrator/furnace-matches-geometric-series";

    fn plan(filters: &[&str]) -> Plan {
        let project = Project::at(std::path::Path::new(env!("CARGO_MANIFEST_DIR")));
        let cases = case::load_all(&project.cases()).unwrap();
        let request = Request {
            cores: vec!["textbook".parse().unwrap()],
            filters: filters.iter().map(|&word| word.to_owned()).collect(),
            budget: Budget::Quick,
            jobs: 2,
            ..Request::default()
        };
        Plan::new(project, request, &cases).unwrap()
    }

    fn schedule(plan: &Plan) -> Schedule<'_> {
        let todo: Vec<_> = (0..plan.trials.len()).collect();
        Schedule::new(plan, &plan.bench(), &todo, &[])
    }

    fn id<'a>(plan: &'a Plan, next: &Next) -> &'a str {
        let (Next::Try(number) | Next::Blocked(number, _)) = next;
        &plan.trials[*number].case.id
    }

    #[test]
    fn what_rests_on_a_failure_is_blocked_by_it() {
        let plan = plan(&[TRIANGLE, SPHERE, FURNACE]);
        let schedule = schedule(&plan);
        let mut blocked = Vec::new();
        while let Some(next) = schedule.next() {
            match next {
                Next::Try(number) => {
                    let fails = plan.trials[number].case.id == SPHERE;
                    schedule.ended(number, if fails { Status::Fail } else { Status::Pass });
                }
                Next::Blocked(number, by) => {
                    blocked.push((plan.trials[number].case.id.clone(), by))
                }
            }
        }
        assert_eq!(blocked, [(FURNACE.to_owned(), SPHERE.to_owned())]);
    }

    #[test]
    fn a_failure_that_it_does_not_rest_on_blocks_nothing() {
        let plan = plan(&[TRIANGLE, SPHERE, FURNACE]);
        let schedule = schedule(&plan);
        let mut tried = Vec::new();
        while let Some(next) = schedule.next() {
            let Next::Try(number) = next else { panic!("nothing is blocked") };
            let fails = plan.trials[number].case.id == TRIANGLE;
            tried.push(id(&plan, &next).to_owned());
            schedule.ended(number, if fails { Status::Fail } else { Status::Pass });
        }
        assert_eq!(tried.len(), 3);
    }

    #[test]
    fn who_rests_on_what_is_being_tried_waits_for_it() {
        let plan = plan(&[SPHERE, FURNACE]);
        let schedule = schedule(&plan);
        let first = schedule.next().unwrap();
        assert_eq!(id(&plan, &first), SPHERE);
        std::thread::scope(|threads| {
            let second = threads.spawn(|| schedule.next());
            let Next::Try(number) = first else { panic!("nothing has failed") };
            schedule.ended(number, Status::Pass);
            assert_eq!(id(&plan, &second.join().unwrap().unwrap()), FURNACE);
        });
    }

    #[test]
    fn a_stopped_schedule_hands_out_nothing() {
        let plan = plan(&[TRIANGLE, FURNACE]);
        let schedule = schedule(&plan);
        schedule.stop();
        assert_eq!(schedule.next(), None);
    }
}
