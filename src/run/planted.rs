//! The textbook core with mistakes planted in it, asked what the core of the run was asked.

use super::attempt::run_with;
use super::bench::Bench;
use super::plan::{Plan, Trial};
use super::purse::{Purse, price};
use super::record::TrialRecord;
use super::search::is_gross;
use crate::case::Subject;
use crate::checks::Finding;
use crate::contract::Components;
use crate::cores::textbook::fault;
use crate::diagnosis::{Mistake, Planted, Question};
use crate::stats::{Allowance, Budget};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// How much planted mistakes may be asked for one core, as a share of what its trials did.
const SHARE: f64 = 0.25;
/// Seconds of the textbook core that they may always be asked: about what that share comes to in a run of all cases at the
/// default budget. With less, several mistakes in one core stay without names at the quick one.
const LEAST: u64 = 30;
/// The same where images alone fail: every mistake is put to one of them.
const LEAST_BY_IMAGES: u64 = 150;

/// What was asked: the core, the case, what was the bench's own, and whether a first look is enough.
type Asked = (String, String, Components, bool);

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
    /// Cases that failed so little that a quick run would not see it: they are asked as the core was.
    subtle: BTreeSet<String>,
    /// Cases that failed so much that a first look sees it.
    glaring: BTreeSet<String>,
    as_the_core: Looks,
    /// As a quick run asks.
    quickly: Looks,
    mistakes: Vec<Mistake>,
    purse: Purse,
    known: Mutex<BTreeMap<Asked, Option<Finding>>>,
}

/// The bench for a first look, and for the one that counts.
struct Looks {
    roughly: Bench,
    closely: Bench,
}

impl Looks {
    fn of(bench: &Bench, allowance: Allowance) -> Self {
        let with = |allowance| Bench { allowance, ..bench.clone() };
        let roughly = with(Allowance { looks_roughly: true, ..allowance });
        Self { roughly, closely: with(allowance) }
    }
}

impl<'a> PlantedFaults<'a> {
    /// For a core with these trials.
    pub(super) fn new<'r>(
        plan: &'a Plan,
        bench: &Bench,
        records: impl Iterator<Item = &'r TrialRecord> + Clone,
    ) -> Self {
        let mistake = |fault: &'static fault::Fault| Mistake {
            name: fault.name,
            cause: fault.cause,
            components: fault.components(),
            caught_by: fault.caught_by,
        };
        let (mistakes, known) = (fault::all().map(mistake).collect(), Mutex::default());
        let allowance = Allowance { judges_alone: true, ..bench.allowance };
        let quick = Allowance { budget: Budget::Quick, ..allowance };
        let quickly = Looks::of(bench, quick);
        let coarser = |look: &Bench| look.allowance.coarseness() / allowance.coarseness();
        let failing = |is_so: &dyn Fn(&Finding) -> bool| {
            let so = records.clone().filter(|record| record.outcome.finding().is_some_and(is_so));
            so.map(|record| record.case.clone()).collect()
        };
        let is_subtle =
            |seen: &Finding| seen.failed() && !is_gross(seen, coarser(&quickly.closely));
        Self {
            plan,
            subtle: failing(&is_subtle),
            glaring: failing(&|seen| is_gross(seen, coarser(&quickly.roughly))),
            as_the_core: Looks::of(bench, allowance),
            quickly,
            mistakes,
            purse: Purse::of_share(SHARE, least(records.clone()), records),
            known,
        }
    }

    /// Tries what was asked. Mistakes that exclude each other, and cases that were not selected, have no answer.
    fn try_out(&self, (core, case, with, roughly): &Asked) -> (Option<Finding>, u64) {
        let case = self.plan.trials.iter().find(|trial| trial.case.id == *case);
        let (Some(case), Ok(core)) = (case, core.parse()) else { return (None, 0) };
        let trial = Trial { case: Arc::clone(&case.case), core };
        let is_subtle = self.subtle.contains(&trial.case.id);
        let looks = if is_subtle { &self.as_the_core } else { &self.quickly };
        let bench = if *roughly { &looks.roughly } else { &looks.closely };
        let ended = run_with(bench, &trial, *with).record;
        (ended.outcome.finding().cloned(), price(&ended))
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<Asked, Option<Finding>>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Seconds of the textbook core that planted mistakes may always be asked for a core with these trials.
fn least<'r>(records: impl Iterator<Item = &'r TrialRecord>) -> u64 {
    let is_image = |record: &TrialRecord| Subject::of_case(&record.case) == Some(Subject::Image);
    let failing = records.filter(|record| record.outcome.status().is_failure());
    // Where there is no picture, none can be compared.
    let answered = |record: &&TrialRecord| record.outcome.finding().is_some();
    let failing: Vec<_> = failing.collect();
    if failing.iter().all(|record| is_image(record)) && failing.iter().any(answered) {
        LEAST_BY_IMAGES
    } else {
        LEAST
    }
}

fn asked(question: &Question<'_>) -> Asked {
    let names: Vec<_> = question.mistakes.iter().map(|mistake| mistake.name).collect();
    let core = format!("textbook:{}", names.join("+"));
    (core, question.case.to_owned(), question.with, question.roughly)
}

impl Planted for PlantedFaults<'_> {
    fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    fn is_seen_roughly(&self, case: &str) -> bool {
        self.glaring.contains(case)
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let all: Vec<_> = questions.iter().map(asked).collect();
        let mut new: Vec<_> =
            all.iter().filter(|asked| !self.known().contains_key(asked)).collect();
        let mut seen = BTreeSet::new();
        new.retain(|asked| seen.insert(*asked));
        let answers =
            self.purse.pay_each(self.plan.jobs(), new.len(), &|place| self.try_out(new[place]));
        self.known().extend(new.into_iter().cloned().zip(answers));
        let known = self.known();
        all.iter().map(|asked| known.get(asked).cloned().flatten()).collect()
    }
}
