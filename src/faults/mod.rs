//! The matrix: every planted fault has to fail the case that is named for it and to be told by its cause; cores that
//! are right but different have to fail nothing.
//!
//! Pictures against references are left out: a mistake that only a picture shows is one that nobody is told of. What they
//! tell alone is asked by themselves ([`Matrix::on_images_alone`]).

mod together;

pub use crate::cores::textbook::fault::Fault;
pub use together::{Together, Told};

use crate::case::{Case, NothingSelected, Part, Subject};
use crate::cores::CoreSpec;
use crate::cores::textbook::different::{DIFFERENT, Different};
use crate::cores::textbook::fault;
use crate::diagnosis::Diagnosis;
use crate::project::Project;
use crate::run::record::CoreRecord;
use crate::run::{Outcome, Plan, Request, TrialRecord, diagnose, run_in_memory};
use crate::stats::Budget;
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;

/// What changed cores are put to.
#[derive(Clone, Debug)]
pub struct Matrix {
    project: Project,
    /// The cases, pictures against references left out.
    cases: Vec<Arc<Case>>,
    budget: Budget,
    /// Trials at the same time; 0 means one a hardware thread.
    jobs: usize,
    /// What every core chooses.
    chooses: Option<&'static str>,
}

/// What came of a fault.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    /// The fault.
    pub name: &'static str,
    /// Of the course.
    pub part: u32,
    /// Whether the case that is named for it failed.
    pub caught: bool,
    /// Whether its cause is what the diagnosis says first.
    pub named: bool,
    /// The cases that failed, the one named for it in front.
    pub by: Vec<String>,
    /// What the diagnosis says first.
    pub told: Option<&'static str>,
    /// Wall time.
    pub seconds: f64,
}

/// What came of a core that is right.
#[derive(Clone, Debug, Serialize)]
pub struct Spared {
    /// The choice.
    pub name: &'static str,
    /// The cases that failed it, or could not decide.
    pub by: Vec<String>,
    /// The same with what they say.
    pub statements: Vec<String>,
    /// Wall time.
    pub seconds: f64,
}

impl Tried {
    /// Whether nothing is left to wish for.
    pub(crate) fn is_good(&self) -> bool {
        self.caught && self.named
    }
}

impl Spared {
    /// Whether no case has anything against it.
    pub fn is_good(&self) -> bool {
        self.by.is_empty()
    }
}

/// The faults, and the cores that are right but different, whose names contain one of the words, or the faults whose
/// part is one of them; all without words.
///
/// # Errors
/// If a word selects nothing.
pub fn select(
    words: &[String],
) -> Result<(Vec<&'static Fault>, Vec<&'static Different>), NothingSelected> {
    let faults: Vec<_> = fault::all().collect();
    let is_fault = |word: &String, fault: &Fault| match word.parse::<u32>() {
        Ok(number) => fault.part == number,
        Err(_) => fault.name.contains(word.as_str()),
    };
    let is_different = |word: &String, core: &Different| core.name.contains(word.as_str());
    let is_known = |word: &&String| {
        faults.iter().any(|fault| is_fault(word, fault))
            || DIFFERENT.iter().any(|core| is_different(word, core))
    };
    if let Some(unknown) = words.iter().find(|word| !is_known(word)) {
        if let Ok(number) = unknown.parse() {
            return Err(NothingSelected::part(number));
        }
        let names = faults.iter().map(|fault| fault.name);
        let names = names.chain(DIFFERENT.iter().map(|core| core.name));
        return Err(NothingSelected::by(unknown, names));
    }
    let any = |meant: &dyn Fn(&String) -> bool| words.is_empty() || words.iter().any(meant);
    Ok((
        faults.into_iter().filter(|fault| any(&|word| is_fault(word, fault))).collect(),
        DIFFERENT.iter().filter(|core| any(&|word| is_different(word, core))).collect(),
    ))
}

impl Matrix {
    /// Puts changed cores to `cases`.
    pub fn new(project: Project, cases: &[Arc<Case>], budget: Budget, jobs: usize) -> Self {
        let is_picture = |case: &Arc<Case>| case.part().is_some_and(is_of_pictures);
        let cases = cases.iter().filter(|case| !is_picture(case)).cloned().collect();
        Self { project, cases, budget, jobs, chooses: None }
    }

    /// Puts changed cores of which images are all that can be had, as of a program, to those of `cases`.
    pub fn on_images_alone(
        project: Project,
        cases: &[Arc<Case>],
        budget: Budget,
        jobs: usize,
    ) -> Self {
        let is_picture = |case: &Arc<Case>| case.part().is_some_and(is_of_pictures);
        let cases = cases.iter().filter(|case| is_picture(case)).cloned().collect();
        Self { project, cases, budget, jobs, chooses: Some("images-alone") }
    }

    pub(crate) fn with_cases(&self, wanted: impl Fn(&Case) -> bool) -> Self {
        let cases = self.cases.iter().filter(|case| wanted(case)).cloned().collect();
        Self { cases, ..self.clone() }
    }

    /// The cases of the parts of the course whose answers a core changes.
    pub(crate) fn touched_by(&self, core: &Different) -> Self {
        self.with_cases(|case| case.part().is_some_and(|part| core.parts.contains(&part.number)))
    }

    /// Every fourth of those: four cores in a row have them all.
    pub fn quarter_touched_by(&self, core: &Different, number: usize) -> Self {
        let touched = self.touched_by(core);
        let cases = touched.cases.iter().skip(number % 4).step_by(4).cloned().collect();
        Self { cases, ..touched }
    }

    /// Puts a fault to the case named for it, and as long as its cause is not told to more of those beside it: those of the
    /// same check, those that rules of the diagnosis look at, the whole folder.
    ///
    /// # Errors
    /// If the case named for it is not there.
    pub fn try_fault_briefly(&self, fault: &Fault) -> Result<Tried, NothingSelected> {
        let clock = Instant::now();
        let mut records = self.with_cases(|case| case.id == fault.caught_by).records(fault.name)?;
        for wider in self.folder_of(fault).widening(fault) {
            let tried = self.tried(fault, &records, clock);
            if tried.is_good() || !tried.caught {
                return Ok(tried);
            }
            records = wider.records_beside(fault, records);
        }
        Ok(self.tried(fault, &records, clock))
    }

    /// Ever more of the cases: see [`Self::try_fault_briefly`].
    fn widening(&self, fault: &Fault) -> [Self; 3] {
        let named = self.cases.iter().find(|case| case.id == fault.caught_by);
        let check = named.map(|case| case.check.name);
        let is_alike = |case: &Case| Some(case.check.name) == check;
        [
            self.with_cases(is_alike),
            self.with_cases(|case| is_alike(case) || case.role.is_some()),
            self.clone(),
        ]
    }

    /// What all cases say of a fault, in their order, of which some have been asked.
    fn records_beside(&self, fault: &Fault, mut asked: Vec<TrialRecord>) -> Vec<TrialRecord> {
        let is_asked = |case: &Case| asked.iter().any(|record| record.case == case.id);
        // None are left where all of them have been asked.
        let others = self.with_cases(|case| !is_asked(case)).records(fault.name);
        asked.extend(others.unwrap_or_default());
        let place =
            |record: &TrialRecord| self.cases.iter().position(|case| case.id == record.case);
        asked.sort_by_key(place);
        asked
    }

    /// Whether the case named for a fault catches it.
    ///
    /// # Errors
    /// If that is not there.
    pub fn is_caught(&self, fault: &Fault) -> Result<bool, NothingSelected> {
        Ok(self.with_cases(|case| case.id == fault.caught_by).try_fault(fault)?.caught)
    }

    fn folder_of(&self, fault: &Fault) -> Self {
        let subject = Subject::of_case(fault.caught_by);
        self.with_cases(|case| Subject::of_case(&case.id) == subject)
    }

    /// Puts a fault to the cases. Fails if there are none.
    pub(crate) fn try_fault(&self, fault: &Fault) -> Result<Tried, NothingSelected> {
        let clock = Instant::now();
        let records = self.records(fault.name)?;
        Ok(self.tried(fault, &records, clock))
    }

    fn tried(&self, fault: &Fault, records: &[TrialRecord], clock: Instant) -> Tried {
        let mut by: Vec<_> = failures(records).map(|record| record.case.clone()).collect();
        by.sort_by_key(|case| case != fault.caught_by);
        let told = self.diagnosis(fault.name, records).first();
        Tried {
            name: fault.name,
            part: fault.part,
            caught: by.iter().any(|case| case == fault.caught_by),
            named: told == Some(fault.cause),
            by,
            told: told.map(|cause| cause.name),
            seconds: clock.elapsed().as_secs_f64(),
        }
    }

    /// Puts a core that is right to the cases.
    ///
    /// # Errors
    /// If there are none.
    pub fn try_different(&self, core: &Different) -> Result<Spared, NothingSelected> {
        let clock = Instant::now();
        let records = self.records(core.name)?;
        let graded = || records.iter().filter(|record| record.tier.is_graded());
        let against = || graded().filter(|record| !is_content(&record.outcome, core));
        let statement = |r: &TrialRecord| format!("{}: {}", r.case, r.outcome.statement());
        Ok(Spared {
            name: core.name,
            by: against().map(|record| record.case.clone()).collect(),
            statements: against().map(statement).collect(),
            seconds: clock.elapsed().as_secs_f64(),
        })
    }

    fn records(&self, change: &str) -> Result<Vec<TrialRecord>, NothingSelected> {
        let (cores, budget, jobs) = (vec![core(change)], self.budget, self.jobs);
        let request = Request { cores, budget, jobs, ..Request::default() };
        Plan::new(self.project.clone(), request, &self.cases).map(|plan| run_in_memory(&plan))
    }

    fn diagnosis(&self, change: &str, records: &[TrialRecord]) -> Diagnosis {
        let spec = core(change);
        let info = spec.make().expect("every change is a core of our own").info();
        diagnose(&CoreRecord::new(spec.as_str(), &info), records)
    }
}

fn is_of_pictures(part: &'static Part) -> bool {
    part.subjects.contains(&Subject::Image)
}

/// # Panics
/// Never: every change is a core.
fn core(change: &str) -> CoreSpec {
    format!("textbook:{change}").parse().expect("every change is a core")
}

fn failures(records: &[TrialRecord]) -> impl Iterator<Item = &TrialRecord> {
    records.iter().filter(|record| record.outcome.status().is_failure())
}

/// Passed, or not asked for what the core does not do. Whoever leaves a promise out may be noisier than what cases spend
/// allows for.
fn is_content(outcome: &Outcome, core: &Different) -> bool {
    use crate::run::Status;
    match outcome.status() {
        Status::Pass | Status::Skipped => true,
        Status::Inconclusive => !core.promises_everything(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(words: &[&str]) -> Result<Vec<&'static str>, String> {
        let words: Vec<_> = words.iter().map(ToString::to_string).collect();
        let (faults, different) = select(&words).map_err(|error| error.to_string())?;
        let names = faults.iter().map(|fault| fault.name);
        Ok(names.chain(different.iter().map(|core| core.name)).collect())
    }

    #[test]
    fn faults_are_selected_by_part_of_their_name_and_by_part_of_the_course() {
        assert_eq!(names(&["brdf-without-pi"]), Ok(vec!["brdf-without-pi"]));
        let second = names(&["2"]).unwrap();
        assert!(second.contains(&"second-child-skipped") && !second.contains(&"brdf-without-pi"));
        assert!(names(&[]).unwrap().len() > 75);
        assert_eq!(names(&["falloff"]).unwrap().len(), 1);
    }

    #[test]
    fn a_word_that_selects_no_fault_is_an_error_whatever_the_others_select() {
        let message = names(&["falloff", "brdf-without-pie"]).unwrap_err();
        assert!(message.contains("did you mean `brdf-without-pi`?"), "{message}");
    }

    #[test]
    fn a_core_that_no_case_was_tried_on_is_not_spared() {
        let project = Project::at(std::path::Path::new(env!("CARGO_MANIFEST_DIR")));
        let matrix = Matrix::new(project, &[], Budget::Quick, 1);
        assert!(matrix.try_different(&DIFFERENT[0]).is_err());
        assert!(matrix.try_fault_briefly(fault::all().next().unwrap()).is_err());
    }
}
