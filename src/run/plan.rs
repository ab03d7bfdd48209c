//! What is to be run: cases × cores, in the order in which one part rests on another.

use super::bench::Bench;
use super::record::TrialRecord;
use crate::case::{Case, Filter, NothingSelected};
use crate::contract::Components;
use crate::cores::{CoreSpec, Hosting};
use crate::math::rng::Seed;
use crate::project::Project;
use crate::stats::{Allowance, Budget};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

/// What the user asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// The cores to ask.
    pub cores: Vec<CoreSpec>,
    /// Which cases, as typed.
    pub filters: Vec<String>,
    /// How much may be spent.
    pub budget: Budget,
    /// The seed of everything random.
    pub seed: Seed,
    /// Trials at the same time; 0 means one a hardware thread.
    pub jobs: usize,
    /// Stop at the first graded failure.
    pub fail_fast: bool,
}

/// Every case, one at a time, on cores that are still to be named.
impl Default for Request {
    fn default() -> Self {
        let (cores, filters) = (Vec::new(), Vec::new());
        let (budget, seed) = (Budget::Default, Seed::SUITE);
        Self { cores, filters, budget, seed, jobs: 1, fail_fast: false }
    }
}

/// Trials, and everything they need.
pub struct Plan {
    /// Where cases, scenes and references are.
    pub project: Project,
    /// What was asked for.
    pub request: Request,
    /// In the order in which they are run.
    pub trials: Vec<Trial>,
    /// Where cores live.
    pub hosting: Hosting,
    /// The suite whose cases these are, as the user named it.
    pub(crate) suite: Option<String>,
    /// What every core is to take from the bench, whatever it is found to do wrong.
    pub with: Components,
    /// Cases that are tried with nothing of the bench's in any place, whatever is found broken.
    pub(crate) as_they_are: BTreeSet<String>,
    /// What scenes are moved by besides the seed, for graders who publish no motion.
    pub salt: String,
    /// Whether a run with failures goes on to search for the components of the bench that mend them, and puts causes to
    /// the proof. One that stops at the first failure does not.
    pub searches: bool,
    /// After so long no trial begins any more; none: all are tried.
    pub(crate) time: Option<Duration>,
}

/// One case on one core.
#[derive(Clone)]
pub struct Trial {
    /// The case.
    pub case: Arc<Case>,
    /// The core.
    pub core: CoreSpec,
}

impl Plan {
    /// Selects among `cases` and lines them up.
    ///
    /// # Errors
    /// If that leaves no case, or a word of the filters selects none.
    pub fn new(
        project: Project,
        request: Request,
        cases: &[Arc<Case>],
    ) -> Result<Self, NothingSelected> {
        let selected = Filter::new(&request.filters).select(cases)?;
        let trials = request
            .cores
            .iter()
            .flat_map(|core| {
                selected.iter().map(|case| Trial { case: Arc::clone(case), core: core.clone() })
            })
            .collect();
        Ok(Self {
            project,
            request,
            trials,
            hosting: Hosting::default(),
            suite: None,
            as_they_are: BTreeSet::new(),
            with: Components::empty(),
            salt: String::new(),
            searches: true,
            time: None,
        })
    }

    /// The same with cores hosted so.
    pub fn hosted(mut self, hosting: Hosting) -> Self {
        self.hosting = hosting;
        self
    }

    /// The same with these components of the bench in every core.
    pub fn taking(mut self, with: Components) -> Self {
        self.with = with;
        self
    }

    /// The same with scenes moved by a secret, too.
    pub(crate) fn salted(mut self, salt: String) -> Self {
        self.salt = salt;
        self
    }
}

impl Plan {
    /// The same, as what a suite asks; in these cases nothing is replaced.
    pub(crate) fn of_suite(self, suite: String, as_they_are: BTreeSet<String>) -> Self {
        Self { suite: Some(suite), as_they_are, ..self }
    }

    /// The same, where no trial begins after so long.
    pub(crate) fn within(self, time: Option<Duration>) -> Self {
        Self { time, ..self }
    }

    /// What every trial shares.
    pub fn bench(&self) -> Bench {
        Bench {
            scenes: Arc::new(crate::scene::Library::of(&self.project)),
            references: self.project.layers("references"),
            allowance: Allowance {
                stops_at_failure: self.request.fail_fast,
                ..self.request.budget.into()
            },
            seed: self.request.seed,
            motions: self.request.seed.child("motion").child(&self.salt),
            hosting: self.hosting().patient(),
            unfit: BTreeMap::new(),
            known: Arc::default(),
        }
    }

    /// Where cores live, out of sight of what is expected of them.
    pub(crate) fn hosting(&self) -> Hosting {
        self.hosting.clone().hiding(self.project.secrets())
    }

    /// The trial that a record is of.
    pub(super) fn trial_of(&self, record: &TrialRecord) -> Option<&Trial> {
        self.place_of(record).map(|place| &self.trials[place])
    }

    /// Puts records into the order of their trials.
    pub(super) fn sort(&self, records: &mut [TrialRecord]) {
        records.sort_by_cached_key(|record| self.place_of(record));
    }

    fn place_of(&self, record: &TrialRecord) -> Option<usize> {
        let is_it =
            |trial: &Trial| trial.core.as_str() == record.core && trial.case.id == record.case;
        self.trials.iter().position(is_it)
    }

    pub(crate) fn jobs(&self) -> usize {
        match self.request.jobs {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            jobs => jobs,
        }
    }
}
