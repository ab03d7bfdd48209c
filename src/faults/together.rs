//! Several faults in one core, as real renderers have them: which of them are told, what is told that is not there, and
//! how much is judged in spite of them.

use super::{Fault, Matrix};
use crate::case::Case;
use crate::cause::{Cause, camera, image};
use crate::checks::Measure;
use crate::contract::Components;
use crate::cores::CoreSpec;
use crate::cores::textbook::fault;
use crate::diagnosis::{Degree, Headline};
use crate::run::record::CoreRecord;
use crate::run::{Outcome, Plan, Request, Status, TrialRecord, investigate, run_with};
use std::time::Instant;

/// A mistake of a camera's rays, and the one of the film that shows the same picture.
const SAME_PICTURE: [&Cause; 2] = [&camera::FILM_Y_DOWN, &image::UPSIDE_DOWN];

/// What came of a core with several faults.
#[derive(Clone, Debug)]
pub struct Together {
    /// Each fault by name, and how sure the diagnosis is of its cause; empty where it does not tell it.
    pub faults: Vec<(String, String)>,
    /// Every cause that is told.
    pub told: Vec<Told>,
    /// Cases that the core can answer, and those of them that were not blocked.
    pub askable: usize,
    /// See `askable`.
    pub judged: usize,
    /// Wall time.
    pub seconds: f64,
}

/// A cause that the diagnosis tells.
#[derive(Clone, Debug)]
pub struct Told {
    /// Its name in the glossary.
    pub cause: String,
    /// `named` or `looks like`.
    pub degree: String,
    /// Whether one of the faults is it.
    pub is_there: bool,
    /// The failures that it explains.
    pub explains: Vec<String>,
}

impl Matrix {
    /// Whether these can be on together, and each can be seen: with the bench's own in every component but those that the
    /// fault is made in, the case named for it answers otherwise than without the fault.
    pub fn are_in_sight(&self, faults: &[&Fault]) -> bool {
        self.joined(faults).is_some() && faults.iter().all(|fault| self.is_in_sight(fault, faults))
    }

    fn is_in_sight(&self, fault: &Fault, faults: &[&Fault]) -> bool {
        let others: Vec<_> = faults.iter().copied().filter(|o| o.name != fault.name).collect();
        if !others.iter().any(|other| other.components().intersects(fault.components())) {
            return true;
        }
        let outcome = |faults: &[&Fault]| self.outcome_with(faults, fault);
        match (outcome(faults), outcome(&others)) {
            (Some(with), Some(without)) => differ(&with, &without),
            _ => false,
        }
    }

    /// What the case named for `fault` says of a core with `faults`, all other components being the bench's.
    fn outcome_with(&self, faults: &[&Fault], fault: &Fault) -> Option<Outcome> {
        let with = Components::all() - fault.components();
        let alone = self.with_cases(|case| case.id == fault.caught_by);
        let plan = alone.plan(self.joined(faults)?)?;
        Some(run_with(&plan.bench(), plan.trials.first()?, with).record.outcome)
    }

    /// Puts a core with `faults` to the cases, and searches for what mends it, as a run does. None where they cannot be on
    /// together, or there are no cases.
    pub fn try_together(&self, faults: &[&Fault]) -> Option<Together> {
        let clock = Instant::now();
        let core = self.joined(faults)?;
        let info = core.make().ok()?.info();
        let mut record = CoreRecord::new(core.as_str(), &info);
        let plan = self.plan(core)?;
        let trials = investigate(&plan, &mut record);
        let headlines = record.diagnosis.unwrap_or_default().headlines;
        Some(Together {
            faults: faults
                .iter()
                .map(|f| (f.name.to_owned(), self.degree(f, &headlines)))
                .collect(),
            told: headlines.iter().filter_map(|told| self.told(told, faults)).collect(),
            askable: ended(&trials, |status| status != Status::Skipped),
            judged: ended(&trials, |s| s != Status::Skipped && s != Status::Blocked),
            seconds: clock.elapsed().as_secs_f64(),
        })
    }

    /// The same with those cases alone that some fault has to fail, or that rules of the diagnosis look at.
    pub fn of_telling_cases(&self) -> Self {
        let is_named = |case: &Case| fault::all().any(|fault| fault.caught_by == case.id);
        self.with_cases(|case| case.role.is_some() || is_named(case))
    }

    /// The core with these faults; the right one where there are none. None where two of them exclude each other.
    fn joined(&self, faults: &[&Fault]) -> Option<CoreSpec> {
        let names: Vec<_> = self.chooses.into_iter().chain(faults.iter().map(|f| f.name)).collect();
        let spec = match names.is_empty() {
            true => "textbook".to_owned(),
            false => format!("textbook:{}", names.join("+")),
        };
        spec.parse().ok()
    }

    fn degree(&self, fault: &Fault, headlines: &[Headline]) -> String {
        let of_fault = headlines.iter().filter(|told| self.is_fault(told, fault));
        let degree = of_fault.map(|told| told.degree).max();
        degree.map_or_else(String::new, |degree| degree.word().to_owned())
    }

    fn told(&self, headline: &Headline, faults: &[&Fault]) -> Option<Told> {
        (headline.degree > Degree::DiffersHere).then(|| Told {
            cause: headline.cause.clone(),
            degree: headline.degree.word().to_owned(),
            is_there: faults.iter().any(|fault| self.is_fault(headline, fault)),
            explains: headline.explains.clone(),
        })
    }

    /// Whether a headline tells of this fault, as far as what was asked can tell it from others.
    fn is_fault(&self, headline: &Headline, fault: &Fault) -> bool {
        let is_told = |cause: &Cause| cause.name == headline.cause;
        let is_same = SAME_PICTURE.contains(&fault.cause) && SAME_PICTURE.into_iter().any(is_told);
        let sees_rays = self.chooses.is_none();
        is_told(fault.cause) || !sees_rays && is_same
    }

    fn plan(&self, core: CoreSpec) -> Option<Plan> {
        let (cores, budget, jobs) = (vec![core], self.budget, self.jobs);
        let request = Request { cores, budget, jobs, ..Request::default() };
        Plan::new(self.project.clone(), request, &self.cases).ok()
    }
}

fn ended(trials: &[TrialRecord], wanted: impl Fn(Status) -> bool) -> usize {
    trials.iter().filter(|trial| wanted(trial.outcome.status())).count()
}

/// Whether two outcomes of one case are of different cores: some measure ends otherwise, or lies elsewhere.
fn differ(one: &Outcome, other: &Outcome) -> bool {
    match (one.finding(), other.finding()) {
        (Some(a), Some(b)) => {
            let apart = |(a, b): (&Measure, &Measure)| a.verdict != b.verdict || lie_apart(a, b);
            let pairs = a.measures.iter().zip(&b.measures);
            a.measures.len() != b.measures.len() || pairs.into_iter().any(apart)
        }
        _ => one.status() != other.status(),
    }
}

/// Beyond both intervals, and rounding.
fn lie_apart(one: &Measure, other: &Measure) -> bool {
    let rounding = 1e-9 * one.measured.abs().max(other.measured.abs());
    !one.meets(other, rounding)
}
