//! The textbook core with mistakes planted in it, asked what the core of the run was asked.

use super::attempt::run_with;
use super::bench::Bench;
use super::plan::{Plan, Trial};
use super::search::{Purse, each_in_parallel};
use crate::checks::Finding;
use crate::contract::Components;
use crate::cores::textbook::fault;
use crate::diagnosis::{Mistake, Planted, Question};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// How long planted mistakes may be asked for one core, as a share of what its trials took.
const SHARE: f64 = 0.25;

/// What was asked: the core, the case, what was the bench's own.
type Asked = (String, String, Components);

/// A mistake that some case is known to catch: planted, it fails that case (`tests/faults.rs`).
pub(crate) struct Excluded {
    /// `textbook:NAME` makes it.
    pub(crate) name: &'static str,
    pub(crate) part: u32,
    /// What the student wrote.
    pub(crate) wrote: &'static str,
    pub(crate) caught_by: &'static str,
    /// Its cause as one sentence.
    pub(crate) told: &'static str,
}

/// What cases exclude when they pass, part by part.
pub(crate) fn excluded() -> Vec<Excluded> {
    let of = |fault: &'static fault::Fault| Excluded {
        name: fault.name,
        part: fault.part,
        wrote: fault.summary,
        caught_by: fault.caught_by,
        told: fault.cause.headline,
    };
    let mut all: Vec<_> =
        fault::all().filter(|fault| fault.name != fault::integrator::UNCAUGHT).map(of).collect();
    all.sort_by_key(|mistake| mistake.part);
    all
}

/// Every fault of the textbook, and what was asked of them before.
pub(super) struct PlantedFaults<'a> {
    plan: &'a Plan,
    bench: &'a Bench,
    mistakes: Vec<Mistake>,
    purse: Purse,
    known: Mutex<BTreeMap<Asked, Finding>>,
}

impl<'a> PlantedFaults<'a> {
    /// For a core whose trials took so many seconds.
    pub(super) fn new(plan: &'a Plan, bench: &'a Bench, taken: f64) -> Self {
        let mistake = |fault: &'static fault::Fault| Mistake {
            name: fault.name,
            cause: fault.cause,
            components: fault.components(),
            caught_by: fault.caught_by,
        };
        let (mistakes, known) = (fault::all().map(mistake).collect(), Mutex::default());
        Self { plan, bench, mistakes, purse: Purse::of_share(SHARE, taken), known }
    }

    fn answer(&self, question: &Question<'_>) -> Option<Finding> {
        let names: Vec<_> = question.mistakes.iter().map(|mistake| mistake.name).collect();
        let core = format!("textbook:{}", names.join("+"));
        let asked = (core, question.case.to_owned(), question.with);
        if let Some(known) = self.known().get(&asked) {
            return Some(known.clone());
        }
        let finding = self.try_out(&asked.0, question)?;
        self.known().insert(asked, finding.clone());
        Some(finding)
    }

    fn try_out(&self, core: &str, question: &Question<'_>) -> Option<Finding> {
        let core = core.parse().ok()?;
        let case = &self.plan.trials.iter().find(|trial| trial.case.id == question.case)?.case;
        let trial = Trial { case: Arc::clone(case), core };
        let ended = self.purse.pay(|| run_with(self.bench, &trial, question.with))?;
        ended.record.outcome.finding().cloned()
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<Asked, Finding>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Planted for PlantedFaults<'_> {
    fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let answer = |number: usize| Some(self.answer(&questions[number]));
        each_in_parallel(self.plan.jobs(), questions.len(), &answer)
    }
}
