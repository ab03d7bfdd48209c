//! The textbook core with mistakes planted in it, asked what the core of the run was asked.

use super::attempt::run_with;
use super::bench::Bench;
use super::outcome::Status;
use super::plan::{Plan, Trial};
use super::purse::{Purse, price};
use super::record::TrialRecord;
use super::search::{is_gross, without_patience};
use crate::case::{Role, Subject};
use crate::checks::Finding;
use crate::contract::Components;
use crate::cores::textbook::variant::{self, AND};
use crate::cores::textbook::{different, fault};
use crate::diagnosis::{Isolation, Mistake, Planted, Question, isolation};
use crate::stats::{Allowance, Budget};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

/// The core that mistakes are planted in.
const TEXTBOOK: &str = "textbook";
/// How much planted mistakes may be asked for one core, as a share of what its trials did.
const SHARE: f64 = 0.25;
/// Seconds of the textbook core that they may always be asked: about what that share comes to in a run of all cases at the
/// default budget. With less, several mistakes in one core stay without names at the quick one.
const LEAST: u64 = 30;
/// The same for each component that is broken, so that each can be searched: one with many failures took 30 s and more
/// (docs/decisions/0014).
const LEAST_FOR_EACH: u64 = 20;
/// The same where images alone fail: every mistake is put to one of them.
const LEAST_BY_IMAGES: u64 = 150;

/// What was asked.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Asked {
    core: String,
    case: String,
    /// What was the bench's own.
    with: Components,
    /// Whether a first look is enough.
    roughly: bool,
    /// Whether a pixel has to have as many samples as the core's.
    counts_samples: bool,
}

impl Asked {
    fn of(question: &Question<'_>) -> Self {
        let is_image = Subject::of_case(question.case) == Some(Subject::Image);
        let is_of_pixels = |mistake: &Mistake| mistake.components.intersects(Components::PIXEL);
        Self {
            core: format!("{TEXTBOOK}:{}", joined(&question.mistakes)),
            case: question.case.to_owned(),
            with: question.with,
            roughly: question.roughly,
            counts_samples: is_image && question.mistakes.iter().any(is_of_pixels),
        }
    }

    /// The same of the right core.
    fn without_mistakes(&self) -> Self {
        Self { core: TEXTBOOK.to_owned(), ..self.clone() }
    }
}

/// What came of it.
#[derive(Clone, Debug)]
struct Answer {
    /// Nothing where mistakes exclude each other or take too long.
    finding: Option<Finding>,
    /// What it took, in the work of a purse.
    price: u64,
}

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
    let mut all: Vec<_> = fault::all().map(of).collect();
    all.sort_by_key(|mistake| mistake.part);
    all
}

/// A fault of which bounces count, beside a choice of how isolated ones are come by.
struct BesideSums {
    /// `textbook:NAME` makes it.
    name: String,
    fault: &'static fault::Fault,
    isolation: Isolation,
}

static BESIDE_SUMS: LazyLock<Vec<BesideSums>> = LazyLock::new(|| {
    let choices =
        [(Isolation::ByDifference, different::BY_DIFFERENCE), (Isolation::Apart, different::APART)];
    let beside = |(isolation, choice)| {
        let of_ranges = fault::all().filter(|fault| fault.is_of_ranges());
        let name = move |fault: &fault::Fault| format!("{}{AND}{choice}", fault.name);
        of_ranges.map(move |fault| BesideSums { name: name(fault), fault, isolation })
    };
    choices.into_iter().flat_map(beside).collect()
});

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
    /// The same with as many samples a pixel as the core had.
    counting_samples: Looks,
    mistakes: Vec<Mistake>,
    purse: Purse,
    known: Mutex<BTreeMap<Asked, Answer>>,
    /// Mistakes that make the core so slow that it was not waited for. Whoever answers is not that slow.
    silent: Mutex<BTreeSet<String>>,
    /// First pictures, as words.
    glances: Mutex<BTreeMap<Asked, Option<String>>>,
}

/// The bench for a glance at a picture, for a first look, and for the one that counts.
struct Looks {
    glancing: Bench,
    roughly: Bench,
    closely: Bench,
}

impl Looks {
    fn of(bench: &Bench, allowance: Allowance) -> Self {
        let with = |allowance| Bench { allowance, ..bench.clone() };
        let roughly = with(Allowance { looks_roughly: true, ..allowance });
        let glancing = with(Allowance { only_glances: true, ..allowance });
        Self { glancing, roughly, closely: with(allowance) }
    }
}

impl<'a> PlantedFaults<'a> {
    /// For a core with these trials, of which so many components are known to be broken.
    pub(super) fn new<'r>(
        plan: &'a Plan,
        bench: &Bench,
        records: impl Iterator<Item = &'r TrialRecord> + Clone,
        broken: usize,
    ) -> Self {
        let mistake = |name: &'static str, fault: &'static fault::Fault| Mistake {
            name,
            cause: fault.cause,
            components: fault.components(),
            caught_by: fault.caught_by,
        };
        let alone = fault::all().map(|fault| mistake(fault.name, fault));
        let isolation = isolation_of(plan, records.clone());
        let beside_sums = BESIDE_SUMS.iter().filter(|beside| Some(beside.isolation) == isolation);
        let beside_sums = beside_sums.map(|beside| mistake(&beside.name, beside.fault));
        let mistakes = alone.chain(beside_sums).collect();
        let allowance = Allowance { judges_alone: true, ..bench.allowance };
        let quick = Allowance { budget: Budget::Quick, ..allowance };
        // Asked as a strict run asks, a right core may need longer than a search waits.
        let quickly = Looks::of(&without_patience(bench), quick);
        let counting = Allowance { of_a_pixel: Some(bench.allowance.budget), ..quick };
        let counting_samples = Looks::of(&without_patience(bench), counting);
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
            counting_samples,
            mistakes,
            purse: Purse::of_share(SHARE, least(records.clone(), broken), records),
            known: Mutex::default(),
            silent: Mutex::default(),
            glances: Mutex::default(),
        }
    }

    /// Tries what was asked, and says what it took.
    fn try_out(&self, asked: &Asked) -> (Option<Finding>, u64) {
        if !asked.roughly {
            return self.run(asked, |looks| &looks.closely);
        }
        let (is_changed, glanced) = match Subject::of_case(&asked.case) {
            Some(Subject::Image) => self.changes_the_picture(asked),
            _ => (true, 0),
        };
        match is_changed {
            true => {
                let (answer, price) = self.run(asked, |looks| &looks.roughly);
                (answer, glanced + price)
            }
            false => (self.of_the_right_core(asked), glanced),
        }
    }

    /// Whether another picture comes of the mistakes, in one run: those that leave it the same to the last bit are not what
    /// fails it. The right one is free: how often it is asked at once is chance.
    fn changes_the_picture(&self, asked: &Asked) -> (bool, u64) {
        let [(with, price), (without, _)] =
            [asked, &asked.without_mistakes()].map(|asked| self.glance(asked));
        (with != without, price)
    }

    /// The first picture, as a word; nothing where there is none.
    fn glance(&self, asked: &Asked) -> (Option<String>, u64) {
        if let Some(known) = self.glances().get(asked) {
            return (known.clone(), 0);
        }
        let (finding, price) = self.run(asked, |looks| &looks.glancing);
        let word = finding.map(|finding| finding.statement);
        self.glances().insert(asked.clone(), word.clone());
        (word, price)
    }

    /// What comes of a first look without mistakes.
    fn of_the_right_core(&self, asked: &Asked) -> Option<Finding> {
        let asked = asked.without_mistakes();
        if let Some(known) = self.known().get(&asked) {
            return known.finding.clone();
        }
        let (finding, price) = self.run(&asked, |looks| &looks.roughly);
        self.known().insert(asked, Answer { finding: finding.clone(), price });
        finding
    }

    /// Mistakes that exclude each other, those that take too long, and cases that were not selected, have no answer.
    fn run(&self, asked: &Asked, look: fn(&Looks) -> &Bench) -> (Option<Finding>, u64) {
        let Asked { core, case, with, counts_samples, .. } = asked;
        if self.silent().contains(core) {
            return (None, 0);
        }
        let case = self.plan.trials.iter().find(|trial| trial.case.id == *case);
        let (Some(case), Ok(spec)) = (case, core.parse()) else { return (None, 0) };
        let trial = Trial { case: Arc::clone(&case.case), core: spec };
        let looks = match self.subtle.contains(&trial.case.id) {
            true => &self.as_the_core,
            false if *counts_samples => &self.counting_samples,
            false => &self.quickly,
        };
        let bench = look(looks);
        let ended = run_with(bench, &trial, *with).record;
        if ended.outcome.status() == Status::TimedOut {
            self.silent().insert(core.clone());
        }
        (ended.outcome.finding().cloned(), price(&ended))
    }

    /// What is to be tried for an answer: what was looked at closely needs no first look.
    fn asked(&self, question: &Question<'_>) -> Asked {
        let asked = Asked::of(question);
        let closely = Asked { roughly: false, ..asked.clone() };
        let is_known = self.known().get(&closely).is_some_and(|answer| answer.finding.is_some());
        if is_known { closely } else { asked }
    }

    fn silent(&self) -> MutexGuard<'_, BTreeSet<String>> {
        self.silent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn glances(&self) -> MutexGuard<'_, BTreeMap<Asked, Option<String>>> {
        self.glances.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<Asked, Answer>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// How the core comes by isolated bounces, if its furnace tells.
fn isolation_of<'r>(
    plan: &Plan,
    mut records: impl Iterator<Item = &'r TrialRecord>,
) -> Option<Isolation> {
    let furnace = plan.trials.iter().find(|trial| trial.case.role == Some(Role::Furnace))?;
    let of_furnace = records.find(|record| record.case == furnace.case.id)?;
    isolation(of_furnace.outcome.finding().filter(|finding| finding.failed())?)
}

/// Seconds of the textbook core that planted mistakes may always be asked for a core with these trials.
fn least<'r>(records: impl Iterator<Item = &'r TrialRecord> + Clone, broken: usize) -> u64 {
    let is_image = |record: &TrialRecord| Subject::of_case(&record.case) == Some(Subject::Image);
    // Where there is no picture, none can be compared.
    let answered = |record: &TrialRecord| record.outcome.finding().is_some();
    let mut failing = records.filter(|record| record.outcome.status().is_failure());
    match failing.clone().all(is_image) && failing.any(answered) {
        true => LEAST_BY_IMAGES,
        false => LEAST.max(LEAST_FOR_EACH * broken as u64),
    }
}

/// The textbook's variant with all of these; several may be made beside one choice.
fn joined(mistakes: &[Mistake]) -> String {
    let words = mistakes.iter().flat_map(|mistake| mistake.name.split(AND));
    let mut seen = BTreeSet::new();
    let names: Vec<_> = words.filter(|word| seen.insert(*word)).collect();
    names.join(&AND.to_string())
}

impl Planted for PlantedFaults<'_> {
    fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    fn is_seen_roughly(&self, case: &str) -> bool {
        self.glaring.contains(case)
    }

    fn may_be_together(&self, mistakes: &[Mistake]) -> bool {
        variant::core(&joined(mistakes)).is_ok()
    }

    fn price(&self, question: &Question<'_>) -> u64 {
        let asked = self.asked(question);
        self.known().get(&asked).map_or(0, |answer| answer.price)
    }

    fn keep_for(&self, others: usize) {
        self.purse.keep_for(others);
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let all: Vec<_> = questions.iter().map(|question| self.asked(question)).collect();
        let mut new: Vec<_> =
            all.iter().filter(|asked| !self.known().contains_key(asked)).collect();
        let mut seen = BTreeSet::new();
        new.retain(|asked| seen.insert(*asked));
        let answers = self.purse.pay_each(self.plan.jobs(), new.len(), &|place| {
            let (finding, price) = self.try_out(new[place]);
            (Answer { finding, price }, price)
        });
        self.known().extend(new.into_iter().cloned().zip(answers));
        let known = self.known();
        all.iter().map(|asked| known.get(asked)?.finding.clone()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case;
    use crate::project::Project;
    use crate::run::Request;
    use crate::run::purse::{A_SECOND, LONGEST_TRIAL};

    const PICTURE: &str = "image/point-light-plane-matches-mitsuba";

    /// The right core and one case, quickly.
    fn plan_of(case: &str) -> Plan {
        let project = Project::at(std::path::Path::new(env!("CARGO_MANIFEST_DIR")));
        let cases = case::load_all(&project.cases()).unwrap();
        let (cores, filters) = (vec!["textbook".parse().unwrap()], vec![case.to_owned()]);
        let request = Request { cores, filters, budget: Budget::Quick, ..Request::default() };
        Plan::new(project, request, &cases).unwrap()
    }

    fn asked_of(core: &str, case: &str) -> Asked {
        let [core, case] = [core, case].map(str::to_owned);
        Asked { core, case, with: Components::empty(), roughly: false, counts_samples: false }
    }

    #[test]
    fn there_is_a_core_for_every_mistake_beside_sums() {
        for BesideSums { name, .. } in BESIDE_SUMS.iter() {
            assert!(variant::core(name).is_ok(), "{name}");
        }
    }

    #[test]
    fn a_mistake_that_took_too_long_is_not_asked_again() {
        const CASE: &str = "bvh/triangle-soup-hits-match-brute-force";
        let plan = plan_of(CASE);
        let mut bench = plan.bench();
        bench.hosting.limits.seconds = Some(1e-9);
        let planted = PlantedFaults::new(&plan, &bench, [].iter(), 0);
        let asked = asked_of("textbook:leaf-tests-everything", CASE);
        let (answer, price) = planted.try_out(&asked);
        assert!(answer.is_none() && price >= LONGEST_TRIAL * A_SECOND);
        assert_eq!(planted.try_out(&asked), (None, 0));
    }

    #[test]
    fn a_mistake_that_leaves_a_picture_as_it_is_is_answered_by_the_right_core() {
        let plan = plan_of(PICTURE);
        let planted = PlantedFaults::new(&plan, &plan.bench(), [].iter(), 0);
        let asked = |core: &str| Asked { roughly: true, ..asked_of(core, PICTURE) };
        let statement = |finding: Option<Finding>| finding.unwrap().statement;
        let answer = |core: &str| {
            let asked = asked(core);
            let of_right = statement(planted.of_the_right_core(&asked));
            let (is_changed, _) = planted.changes_the_picture(&asked);
            (is_changed, statement(planted.try_out(&asked).0) == of_right)
        };
        // There is no glass in it.
        assert_eq!(answer("textbook:glass-indices-swapped"), (false, true));
        assert_eq!(answer("textbook:fov-not-halved"), (true, false));
    }

    #[test]
    fn a_sum_that_is_not_divided_is_as_bright_at_a_first_look_as_in_the_core() {
        let plan = plan_of(PICTURE);
        let planted = PlantedFaults::new(&plan, &plan.bench(), [].iter(), 0);
        let named = |one: &&Mistake| one.name == "samples-not-divided";
        let mistake = *planted.mistakes().iter().find(named).unwrap();
        let (with, mistakes) = (Components::empty(), vec![mistake]);
        let asked = Question { mistakes, case: PICTURE, with, roughly: true };
        let answers = planted.ask(&[asked]);
        assert!(answers[0].as_ref().unwrap().failed());
    }

    #[test]
    fn what_was_looked_at_closely_takes_no_first_look() {
        const CASE: &str = "bsdf/sampling-agrees-with-evaluation";
        let plan = plan_of(CASE);
        let planted = PlantedFaults::new(&plan, &plan.bench(), [].iter(), 0);
        let named = |one: &&Mistake| one.name == "brdf-without-pi";
        let mistakes = vec![*planted.mistakes().iter().find(named).unwrap()];
        let question = |roughly| Question {
            mistakes: mistakes.clone(),
            case: CASE,
            with: Components::empty(),
            roughly,
        };
        let closely = planted.ask(&[question(false)]);
        let left = planted.purse.left();
        assert_eq!(planted.ask(&[question(true)]), closely);
        assert_eq!(planted.purse.left(), left);
        assert!(closely[0].is_some() && planted.price(&question(true)) > 0);
    }
}
