//! What is remembered from one cycle to the next: how every trial has ended, and so what is tried
//! next and what is worth a word.

use crate::report::measure::{MeasureWords, worst_first};
use crate::report::text::clean;
use crate::run::{Trial, TrialRecord};
use crate::text::number::{count, duration};
use std::collections::{BTreeMap, BTreeSet};

/// Ends of a trial that are shown, the last on the right.
const SHOWN_ENDS: usize = 3;
/// Trials that are named in one line.
const NAMED_TRIALS: usize = 3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    All,
    /// What failed last.
    Failures,
}

#[derive(Debug, Default)]
pub(crate) struct Memory {
    trials: BTreeMap<Name, History>,
}

type Name = (String, String);

#[derive(Debug, Default)]
struct History {
    /// `FAIL -9.5 %`, `pass`: equal ones in a row stand for one.
    ends: Vec<String>,
    fails: bool,
}

impl Memory {
    /// Leaves in `trials` what failed last, if any of that is still there. What is not is forgotten.
    pub(crate) fn restrict(&mut self, trials: &mut Vec<Trial>) -> Scope {
        let name = |trial: &Trial| (trial.case.id.clone(), trial.core.to_string());
        let names: BTreeSet<Name> = trials.iter().map(name).collect();
        self.trials.retain(|name, _| names.contains(name));
        let fails =
            |trial: &Trial| self.trials.get(&name(trial)).is_some_and(|history| history.fails);
        if !trials.iter().any(fails) {
            return Scope::All;
        }
        trials.retain(fails);
        Scope::Failures
    }

    pub(crate) fn is_clean(&self) -> bool {
        !self.trials.values().any(|history| history.fails)
    }

    /// Remembers how trials have ended, and says in one line what is new.
    pub(crate) fn take(&mut self, time: &str, ended: &[TrialRecord], seconds: f64) -> String {
        let mut told = Vec::new();
        for trial in ended {
            let history = self.trials.entry((trial.case.clone(), trial.core.clone())).or_default();
            if history.take(trial) {
                told.push(format!("{}  {}", name(trial), history.words()));
            }
        }
        let failing = ended.iter().filter(|trial| trial.fails_the_core()).count();
        let more = told.len().saturating_sub(NAMED_TRIALS);
        told.truncate(NAMED_TRIALS);
        if more > 0 {
            told.push(format!("and {more} more"));
        }
        let result = match failing {
            0 => format!("{}, none fails", count(ended.len(), "trial")),
            1 => format!("1 of {} fails", count(ended.len(), "trial")),
            some => format!("{some} of {} fail", count(ended.len(), "trial")),
        };
        let words = [vec![time.to_owned(), result], told, vec![duration(seconds)]].concat();
        clean(&words.join("   ")).replace('\n', " ")
    }
}

impl History {
    /// Remembers an end; whether that is worth a word: it fails, or did until now.
    fn take(&mut self, trial: &TrialRecord) -> bool {
        let (failed, fails) = (self.fails, trial.fails_the_core());
        self.fails = fails;
        let end = end(trial);
        if self.ends.last() != Some(&end) {
            self.ends.push(end);
        }
        failed || fails
    }

    fn words(&self) -> String {
        self.ends[self.ends.len().saturating_sub(SHOWN_ENDS)..].join(" -> ")
    }
}

/// `FAIL -9.5 %`, `CRASHED`, `pass`.
fn end(trial: &TrialRecord) -> String {
    let word = trial.outcome.status().word();
    if !trial.fails_the_core() {
        return word.to_owned();
    }
    let measures = trial.outcome.finding().map_or(&[][..], |finding| &finding.measures);
    let size = worst_first(measures).first().map(|worst| MeasureWords::of(worst).off_by);
    format!("{} {}", word.to_uppercase(), size.unwrap_or_default()).trim_end().to_owned()
}

fn name(trial: &TrialRecord) -> String {
    format!("{} ({})", trial.case, trial.core)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::checks::{Finding, Measure};
    use crate::report::example::trial;
    use crate::run::Outcome;
    use std::sync::Arc;

    /// A trial that measured so much where 1 is right.
    fn measured(case: &str, value: f64) -> TrialRecord {
        let measure = Measure::exact("mean", value, 1.0, 0.01);
        let finding = Finding::of("so it is", "", vec![measure]);
        TrialRecord { outcome: Outcome::Judged { finding }, ..trial("builtin", case) }
    }

    #[test]
    fn a_case_tells_how_it_got_right() {
        let mut memory = Memory::default();
        let line = memory.take("23:14:07Z", &[measured("bvh/a", 0.905)], 2.0);
        assert_eq!(line, "23:14:07Z   1 of 1 trial fails   bvh/a (builtin)  FAIL -9.5 %   2.0 s");
        memory.take("23:14:17Z", &[measured("bvh/a", 0.959)], 2.0);
        let line = memory.take("23:14:27Z", &[measured("bvh/a", 1.0)], 2.0);
        let expected = "23:14:27Z   1 trial, none fails   bvh/a (builtin)  FAIL -9.5 % -> FAIL -4.1 % \
                        -> pass   2.0 s";
        assert_eq!(line, expected);
        let line = memory.take("23:14:37Z", &[measured("bvh/a", 1.0)], 2.0);
        assert_eq!(line, "23:14:37Z   1 trial, none fails   2.0 s");
    }

    #[test]
    fn of_many_failures_some_are_named() {
        let mut memory = Memory::default();
        let trials: Vec<_> = (0..9).map(|i| measured(&format!("bvh/{i}"), 2.0)).collect();
        let line = memory.take("t", &trials, 2.0);
        assert!(line.contains("bvh/2") && !line.contains("bvh/3"), "{line}");
        assert!(line.contains("and 6 more"), "{line}");
    }

    #[test]
    fn what_failed_is_tried_alone_until_it_passes_and_then_everything() {
        let project = crate::project::Project::at(env!("CARGO_MANIFEST_DIR"));
        let cases = crate::case::load_all(&project.cases()).unwrap();
        let trial =
            |case: &Arc<Case>| Trial { case: Arc::clone(case), core: "builtin".parse().unwrap() };
        let all: Vec<_> = cases[..4].iter().map(trial).collect();
        let tried = |memory: &mut Memory| {
            let mut trials = all.clone();
            (memory.restrict(&mut trials), trials.len())
        };
        let mut memory = Memory::default();
        assert_eq!(tried(&mut memory), (Scope::All, 4));
        let ended = |first: f64| {
            let value = |i: usize| if i == 0 { first } else { 1.0 };
            let trials = all.iter().enumerate();
            trials.map(|(i, trial)| measured(&trial.case.id, value(i))).collect::<Vec<_>>()
        };
        memory.take("t", &ended(2.0), 1.0);
        assert_eq!(tried(&mut memory), (Scope::Failures, 1));
        memory.take("t", &ended(1.5)[..1], 1.0);
        assert_eq!(tried(&mut memory), (Scope::Failures, 1));
        memory.take("t", &ended(1.0)[..1], 1.0);
        assert!(memory.is_clean());
        assert_eq!(tried(&mut memory), (Scope::All, 4));
    }

    #[test]
    fn a_failure_whose_case_is_gone_does_not_hold_up_the_rest() {
        let mut memory = Memory::default();
        memory.take("t", &[measured("bvh/gone", 2.0)], 1.0);
        let project = crate::project::Project::at(env!("CARGO_MANIFEST_DIR"));
        let cases = crate::case::load_all(&project.cases()).unwrap();
        let case = Arc::clone(&cases[0]);
        let mut trials = vec![Trial { case, core: "builtin".parse().unwrap() }];
        assert_eq!(memory.restrict(&mut trials), Scope::All);
        assert_eq!(trials.len(), 1);
        assert!(memory.is_clean());
    }
}
