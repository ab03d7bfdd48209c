//! Which trial is next: the first, in the order of the plan, whose foundations have been tried. A trial whose
//! foundation was found broken is tried with the components of the bench that stand for it, or else as it is, or else
//! blocked. What a core has not answered yet it is asked in one trial at a time, as far as there are others: if it never
//! answers, one waits for it, and the rest goes on.

use super::bench::Bench;
use super::outcome::{Outcome, Status};
use super::plan::{Plan, Trial};
use crate::case::{Case, Foundation, asked_about, foundations};
use crate::checks::Measure;
use crate::contract::{Capabilities, Components};
use crate::stats::TestKind;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    Try(usize),
    /// Try it with components of the bench in place of what is broken; if the core cannot, it is blocked.
    Transplanted(usize, Transplant),
    Blocked(usize, String),
}

/// What a trial takes from the bench.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Transplant {
    /// In place of the core's own.
    pub(crate) with: Components,
    /// A case that failed without them.
    pub(crate) by: String,
    /// Whether it may be tried as it is if the core cannot take them.
    pub(crate) or_as_it_is: bool,
}

/// Trials that were tried on what is broken, and did not pass, may take so much of a core's time: what is so broken that
/// nothing stands on it has to be waited for no longer, seconds.
const IN_VAIN: f64 = 60.0;

/// Hands out the trials of a plan to threads.
pub(crate) struct Schedule<'a> {
    plan: &'a Plan,
    /// For each trial what it rests on, each with the number of a trial that proves it.
    rests_on: Vec<Vec<(Foundation, usize)>>,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    fates: Vec<Fate>,
    stopped: bool,
    /// Of each core, what trials have taken that were tried on what is broken and did not pass, seconds.
    in_vain: BTreeMap<String, f64>,
    /// Of each core, what trials needed that came to an end.
    answered: BTreeMap<String, Capabilities>,
}

impl State {
    fn ended(&mut self, number: usize, trial: &Trial, outcome: &Outcome) {
        self.fates[number] = Fate::Ended(blocker(trial, outcome));
        let is_silent =
            matches!(outcome.status(), Status::Crashed | Status::TimedOut | Status::Blocked);
        if !is_silent {
            *self.answered.entry(trial.core.to_string()).or_default() |=
                trial.case.prepared.needs();
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Fate {
    /// Not to be tried: nobody asked.
    Left,
    Waiting,
    Running,
    /// It ended; what others which rest on it are blocked by.
    Ended(Option<Blocker>),
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Blocker {
    /// The case that failed.
    by: String,
    /// Whether what rests on it may be tried all the same. What crashes or never answers would do it again, and where
    /// seeds repeat no error of a mean is known.
    bears: bool,
}

impl<'a> Schedule<'a> {
    /// All trials whose numbers are in `todo`. `earlier` is what a run that was cut off already knows.
    pub(crate) fn new(
        plan: &'a Plan,
        bench: &Bench,
        todo: &[usize],
        earlier: &[(usize, Outcome)],
    ) -> Self {
        let fates = vec![Fate::Left; plan.trials.len()];
        let (in_vain, answered) = Default::default();
        let mut state = State { fates, stopped: false, in_vain, answered };
        for number in todo {
            state.fates[*number] = Fate::Waiting;
        }
        for (number, outcome) in earlier {
            state.ended(*number, &plan.trials[*number], outcome);
        }
        let (state, changed) = (Mutex::new(state), Condvar::new());
        Self { plan, rests_on: provers(plan, bench), state, changed }
    }

    /// The next trial; waits where all that is left rests on what is being tried. None when nothing is left.
    pub(crate) fn next(&self) -> Option<Next> {
        let mut state = self.lock();
        loop {
            if state.stopped {
                return None;
            }
            let waiting = || (0..state.fates.len()).filter(|n| state.fates[*n] == Fate::Waiting);
            let ready = || waiting().filter(|number| self.is_ready(&state, *number));
            let next = ready().find(|number| !self.may_hang(&state, *number));
            if let Some(number) = next.or_else(|| ready().next()) {
                state.fates[number] = Fate::Running;
                return Some(self.next_of(&state, number));
            }
            waiting().next()?;
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    pub(crate) fn ended(&self, number: usize, outcome: &Outcome) {
        self.lock().ended(number, &self.plan.trials[number], outcome);
        self.changed.notify_all();
    }

    /// A trial that was tried on what is broken did not pass, and took so many seconds.
    pub(crate) fn was_in_vain(&self, number: usize, seconds: f64) {
        let core = self.plan.trials[number].core.to_string();
        *self.lock().in_vain.entry(core).or_default() += seconds;
    }

    pub(crate) fn stop(&self) {
        self.lock().stopped = true;
        self.changed.notify_all();
    }

    /// What is to be done with a trial, now that all it rests on has been tried.
    fn next_of(&self, state: &State, number: usize) -> Next {
        let broken = self.rests_on[number].iter().filter_map(|(foundation, prover)| {
            match &state.fates[*prover] {
                Fate::Ended(Some(blocker)) => Some((*foundation, blocker)),
                _ => None,
            }
        });
        let broken: Vec<_> = broken.collect();
        let Some((_, Blocker { by, .. })) = broken.first() else { return Next::Try(number) };
        let (with, by) = (broken.iter().map(|(f, _)| f.components()).collect(), by.clone());
        let trial = &self.plan.trials[number];
        if asked_about(&trial.case).intersects(with) {
            return Next::Blocked(number, by);
        }
        let in_vain = state.in_vain.get(trial.core.as_str()).copied().unwrap_or_default();
        let or_as_it_is = broken.iter().all(|(_, blocker)| blocker.bears) && in_vain < IN_VAIN;
        Next::Transplanted(number, Transplant { with, by, or_as_it_is })
    }

    /// Whether nothing it rests on is still to be tried.
    fn is_ready(&self, state: &State, number: usize) -> bool {
        let open = |(_, n): &(_, usize)| matches!(state.fates[*n], Fate::Waiting | Fate::Running);
        !self.rests_on[number].iter().any(open)
    }

    /// Whether it needs what its core is being asked, and has not answered yet.
    fn may_hang(&self, state: &State, number: usize) -> bool {
        let trial = &self.plan.trials[number];
        let of_all = self.plan.trials.iter().zip(&state.fates);
        let asked =
            of_all.filter(|(other, fate)| **fate == Fate::Running && other.core == trial.core);
        let asked: Capabilities = asked.map(|(other, _)| other.case.prepared.needs()).collect();
        let answered = state.answered.get(trial.core.as_str()).copied().unwrap_or_default();
        (asked - answered).intersects(trial.case.prepared.needs())
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What others are blocked by if this trial ended so.
fn blocker(trial: &Trial, outcome: &Outcome) -> Option<Blocker> {
    let bears = match outcome.status() {
        Status::Crashed | Status::TimedOut => false,
        _ => !trial.case.proves.contains(&Foundation::Seeds) || only_pixels_are_alike(outcome),
    };
    match outcome {
        Outcome::Blocked { by } => Some(Blocker { by: by.clone(), bears }),
        _ => {
            let breaks = outcome.breaks(&trial.case.proves);
            breaks.then(|| Blocker { by: trial.case.id.clone(), bears })
        }
    }
}

/// Whether nothing of random numbers is wrong but that pixels are alike: runs of other seeds are independent then.
fn only_pixels_are_alike(outcome: &Outcome) -> bool {
    let is_of_pixels = |measure: &Measure| {
        measure.hypothesis.is_some_and(|hypothesis| hypothesis.kind == TestKind::Correlation)
    };
    outcome.finding().is_some_and(|finding| finding.failed_measures().all(is_of_pixels))
}

/// For each trial what it rests on, with the numbers of the trials of the same core that prove it.
fn provers(plan: &Plan, bench: &Bench) -> Vec<Vec<(Foundation, usize)>> {
    let mut proving: BTreeMap<(&str, Foundation), Vec<usize>> = BTreeMap::new();
    for (number, trial) in plan.trials.iter().enumerate() {
        for foundation in &trial.case.proves {
            proving.entry((trial.core.as_str(), *foundation)).or_default().push(number);
        }
    }
    let mut known: BTreeMap<&str, BTreeSet<Foundation>> = BTreeMap::new();
    let numbers = |trial: &'_ Trial, found: &BTreeSet<Foundation>| {
        if plan.as_they_are.contains(&trial.case.id) {
            return Vec::new();
        }
        let of = |f: &Foundation| {
            let proving = proving.get(&(trial.core.as_str(), *f)).into_iter().flatten();
            proving.map(|number| (*f, *number)).collect::<Vec<_>>()
        };
        found.iter().flat_map(of).collect()
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

/// What a case rests on. A scene that cannot be read rests on nothing: its trial is broken by itself.
pub(crate) fn of_case(bench: &Bench, case: &Case) -> BTreeSet<Foundation> {
    let load = |choice: &crate::case::SceneChoice| choice.load(&bench.scenes).ok();
    foundations(case, case.scene.as_ref().and_then(load).as_deref())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case;
    use crate::checks::Finding;
    use crate::project::Project;
    use crate::run::Request;
    use crate::stats::{Budget, judge_uncorrelated};

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
        let (Next::Try(number) | Next::Transplanted(number, _) | Next::Blocked(number, _)) = next;
        &plan.trials[*number].case.id
    }

    /// What a trial ends with: a failure, or nothing to speak of.
    fn outcome(fails: bool) -> Outcome {
        match fails {
            true => Outcome::Crashed { how: String::new(), during: String::new() },
            false => Outcome::Skipped { missing: Vec::new() },
        }
    }

    #[test]
    fn what_rests_on_a_failure_is_tried_with_the_benchs_own() {
        let plan = plan(&[TRIANGLE, SPHERE, FURNACE]);
        let schedule = schedule(&plan);
        let mut transplanted = Vec::new();
        while let Some(next) = schedule.next() {
            match next {
                Next::Try(number) => {
                    schedule.ended(number, &outcome(plan.trials[number].case.id == SPHERE));
                }
                Next::Transplanted(number, transplant) => {
                    transplanted.push((plan.trials[number].case.id.clone(), transplant));
                    schedule.ended(number, &outcome(false));
                }
                Next::Blocked(..) => panic!("the furnace does not ask about spheres"),
            }
        }
        let transplant =
            Transplant { with: Components::SPHERE_TEST, by: SPHERE.to_owned(), or_as_it_is: false };
        assert_eq!(transplanted, [(FURNACE.to_owned(), transplant)]);
    }

    #[test]
    fn what_has_answered_wrongly_may_be_built_on_for_a_while() {
        let plan = plan(&[SPHERE, FURNACE]);
        let wrong = || Outcome::Judged { finding: Finding::failure("t is wrong") };
        let may_be_tried = |sphere: &Outcome, in_vain: f64| {
            let schedule = schedule(&plan);
            let Some(Next::Try(number)) = schedule.next() else { panic!("nothing has failed") };
            schedule.ended(number, sphere);
            schedule.was_in_vain(number, in_vain);
            let Some(Next::Transplanted(_, transplant)) = schedule.next() else { panic!("sound") };
            transplant.or_as_it_is
        };
        assert!(may_be_tried(&wrong(), 0.5 * IN_VAIN));
        assert!(!may_be_tried(&wrong(), IN_VAIN));
        assert!(!may_be_tried(&outcome(true), 0.0), "a crash");
    }

    #[test]
    fn on_pixels_that_are_alike_means_can_be_judged_and_on_seeds_that_repeat_they_cannot() {
        const SEEDS: &str = "integrator/seeds-and-pixels-have-different-noise";
        let plan = plan(&[SEEDS, FURNACE]);
        let may_be_tried = |measures: Vec<Measure>| {
            let schedule = schedule(&plan);
            let Some(Next::Try(number)) = schedule.next() else { panic!("nothing has failed") };
            assert_eq!(plan.trials[number].case.id, SEEDS);
            let finding = Finding::of("not independent", "", measures);
            schedule.ended(number, &Outcome::Judged { finding });
            let Some(Next::Transplanted(_, transplant)) = schedule.next() else { panic!("sound") };
            transplant.or_as_it_is
        };
        let repeated = |count| Measure::none("pictures that an earlier seed has given", count);
        let alike = || {
            Measure::of("correlation", &judge_uncorrelated(&[[1.0, 1.0], [2.0, 2.0]].repeat(99)))
        };
        assert!(may_be_tried(vec![repeated(0), alike()]));
        assert!(!may_be_tried(vec![repeated(3), alike()]));
        assert!(!may_be_tried(vec![repeated(3)]));
    }

    #[test]
    fn a_case_that_asks_about_the_whole_takes_nothing_whatever_failed() {
        let mut plan = plan(&[SPHERE, FURNACE]);
        plan.as_they_are.insert(FURNACE.to_owned());
        let schedule = schedule(&plan);
        let mut tried = Vec::new();
        while let Some(next) = schedule.next() {
            let Next::Try(number) = next else { panic!("{next:?}") };
            tried.push(id(&plan, &next).to_owned());
            schedule.ended(number, &outcome(true));
        }
        assert_eq!(tried, [SPHERE, FURNACE]);
    }

    #[test]
    fn numbers_block_where_they_were_measured_not_where_something_failed_on_the_way() {
        const SEEDS: &str = "integrator/seeds-and-pixels-have-different-noise";
        let plan = plan(&[SEEDS, FURNACE]);
        let nothing = outcome(false);
        let tried_after = |seeds: &Outcome| {
            let schedule = schedule(&plan);
            let mut tried = 0;
            while let Some(Next::Try(number)) = schedule.next() {
                let is_proof = plan.trials[number].case.id == SEEDS;
                schedule.ended(number, if is_proof { seeds } else { &nothing });
                tried += 1;
            }
            tried
        };
        let negative = Finding::failure("a pixel is negative");
        let repeated = Measure::none("pictures that an earlier seed has given", 31);
        let of_seeds = Finding::of("the noise is not independent", "", vec![repeated]);
        assert_eq!(tried_after(&outcome(true)), 2);
        assert_eq!(tried_after(&Outcome::Judged { finding: negative }), 2);
        assert_eq!(tried_after(&Outcome::Judged { finding: of_seeds }), 1);
    }

    #[test]
    fn a_case_is_not_tried_with_what_it_asks_about() {
        const HITS: &str = "bvh/closed-mesh-hits-match-brute-force";
        const FASTER: &str = "bvh/bvh-is-faster-than-brute-force";
        let plan = plan(&["bvh"]);
        let schedule = schedule(&plan);
        let mut blocked = BTreeSet::new();
        while let Some(next) = schedule.next() {
            match next {
                Next::Try(number) | Next::Transplanted(number, _) => {
                    let proves = &plan.trials[number].case.proves;
                    schedule.ended(number, &outcome(proves.contains(&Foundation::Hits)));
                }
                Next::Blocked(number, by) => {
                    blocked.insert(plan.trials[number].case.id.clone());
                    schedule.ended(number, &Outcome::Blocked { by });
                }
            }
        }
        assert!(blocked.contains(FASTER) && !blocked.contains(HITS));
    }

    #[test]
    fn a_failure_that_it_does_not_rest_on_blocks_nothing() {
        let plan = plan(&[TRIANGLE, SPHERE, FURNACE]);
        let schedule = schedule(&plan);
        let mut tried = Vec::new();
        while let Some(next) = schedule.next() {
            let Next::Try(number) = next else { panic!("nothing is blocked") };
            tried.push(id(&plan, &next).to_owned());
            schedule.ended(number, &outcome(plan.trials[number].case.id == TRIANGLE));
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
            schedule.ended(number, &outcome(false));
            assert_eq!(id(&plan, &second.join().unwrap().unwrap()), FURNACE);
        });
    }

    #[test]
    fn what_has_never_been_answered_is_asked_in_one_trial_at_a_time() {
        const WHITE: &str = "camera/constant-radiance-gives-a-constant-image";
        const UPRIGHT: &str = "camera/image-is-upright-and-not-mirrored";
        const RECTANGLE: &str = "camera/rectangle-covers-its-share-of-the-image";
        const STREAMS: &str = "adaptive/known-streams-stop-where-the-rule-says";
        let plan = plan(&[WHITE, UPRIGHT, RECTANGLE, STREAMS]);
        let next = |schedule: &Schedule<'_>, count: usize| -> Vec<_> {
            (0..count).map(|_| id(&plan, &schedule.next().unwrap())).collect()
        };
        let all = [WHITE, STREAMS, UPRIGHT, RECTANGLE];
        assert_eq!(next(&schedule(&plan), 4), all, "where nothing else is left, all the same");
        let after_the_first = |crashes: bool| {
            let schedule = schedule(&plan);
            let Some(Next::Try(first)) = schedule.next() else { panic!("nothing has failed") };
            schedule.ended(first, &outcome(crashes));
            next(&schedule, 3)
        };
        assert_eq!(after_the_first(false), [UPRIGHT, RECTANGLE, STREAMS]);
        assert_eq!(after_the_first(true), [UPRIGHT, STREAMS, RECTANGLE], "a crash is no answer");
    }

    #[test]
    fn a_stopped_schedule_hands_out_nothing() {
        let plan = plan(&[TRIANGLE, FURNACE]);
        let schedule = schedule(&plan);
        schedule.stop();
        assert_eq!(schedule.next(), None);
    }
}
