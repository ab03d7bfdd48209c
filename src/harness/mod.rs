//! The bench as a library: a renderer in Rust is tried where it is written, by its own `cargo test`.
//!
//! [`trials`] names a core and says how it is made; what is asked of it is what `furnace run` asks, with the same
//! transplants, diagnosis and report. `test` makes every case a trial of `cargo test`. Not here: verdicts, and processes of
//! foreign cores. The core lives in this process: its panics are caught, an endless loop is not.

#[cfg(feature = "harness")]
mod folder;
#[cfg(feature = "harness")]
mod test;

use crate::case::{self, Case};
use crate::contract::Core;
use crate::cores::CoreSpec;
use crate::grade::{Grade, Suite};
use crate::math::rng::Seed;
use crate::project::Project;
use crate::report::{self, RunTree};
use crate::run::{self, Plan, Request};
use crate::stats::Budget;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What makes a core, once a trial.
type Make = Arc<dyn Fn() -> Box<dyn Core> + Send + Sync>;

/// Cases to be tried on a core of this program; begins with [`trials`].
#[derive(Clone)]
#[must_use = "nothing is tried before `test`, `run` or `grade`"]
pub struct Trials {
    name: String,
    make: Make,
    filters: Vec<String>,
    budget: Budget,
    seed: Seed,
    jobs: usize,
    own: Option<PathBuf>,
}

/// Why nothing could be tried, in words for people.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct TrialsError(String);

impl TrialsError {
    #[expect(clippy::needless_pass_by_value, reason = "`map_err` hands it over")]
    fn because(error: impl ToString) -> Self {
        Self(error.to_string())
    }
}

/// Every case, to be tried on the core that `make` makes; `name` is what reports call it.
///
/// As `tests/furnace.rs` of a crate, with `harness = false` in its manifest and the feature `harness` of this one:
///
/// ```ignore
/// fn main() -> std::process::ExitCode {
///     furnace::trials("mine", mine::Core::new).test()
/// }
/// ```
pub fn trials<C: Core + 'static>(
    name: &str,
    make: impl Fn() -> C + Send + Sync + 'static,
) -> Trials {
    Trials {
        name: name.to_owned(),
        make: Arc::new(move || Box::new(make())),
        filters: Vec::new(),
        budget: Budget::default(),
        seed: Seed::SUITE,
        jobs: 0,
        own: None,
    }
}

/// The points of a core by a suite, such as `cs184-hw3`: what `furnace grade` tells, as data.
///
/// # Errors
/// If there is no such suite, or a file is wrong or cannot be read.
pub fn grade<C: Core + 'static>(
    suite: &str,
    make: impl Fn() -> C + Send + Sync + 'static,
) -> Result<Grade, TrialsError> {
    let name = make().info().name;
    trials(&name, make).grade(suite)
}

impl Trials {
    /// Only cases with these parts of names, `@tag`s, or numbers of parts; `!` before any of these for not.
    pub fn cases<I: IntoIterator<Item: Into<String>>>(mut self, filters: I) -> Self {
        self.filters.extend(filters.into_iter().map(Into::into));
        self
    }

    /// How small an error is looked for.
    pub fn budget(self, budget: Budget) -> Self {
        Self { budget, ..self }
    }

    /// The seed of all random numbers.
    pub fn seed(self, seed: u64) -> Self {
        Self { seed: Seed(seed), ..self }
    }

    /// Trials at a time; 0 means one per hardware thread.
    pub fn jobs(self, jobs: usize) -> Self {
        Self { jobs, ..self }
    }

    /// The folder with cases, scenes and suites of your own, laid over the bench's.
    pub fn project(self, folder: impl Into<PathBuf>) -> Self {
        Self { own: Some(folder.into()), ..self }
    }

    /// Tries the cases, and writes the run with its report, `index.html`, into a new folder below `runs`.
    ///
    /// # Errors
    /// If no case is selected, or a file is wrong or cannot be read or written.
    pub fn run(&self, runs: impl AsRef<Path>) -> Result<RunTree, TrialsError> {
        carry_out(&self.plan(self.core(&self.in_words()))?, runs.as_ref())
    }

    /// The points of the core by a suite; budget, seed and cases are the suite's.
    ///
    /// # Errors
    /// If there is no such suite, or a file is wrong or cannot be read.
    pub fn grade(&self, suite: &str) -> Result<Grade, TrialsError> {
        let project = self.layers()?;
        let suite = Suite::find(&project, suite).map_err(TrialsError::because)?;
        let selected = suite.select(&cases(&project)?).map_err(TrialsError::because)?;
        let core = self.core(&self.in_words());
        let plan = suite.plan(&project, &selected, "", core, self.jobs);
        let plan = plan.map_err(TrialsError::because)?;
        let runs = tempfile::tempdir().map_err(TrialsError::because)?;
        let tree = carry_out(&plan, runs.path())?;
        Ok(Grade::of(&suite, &selected, "", &tree))
    }

    /// Its cases on the core.
    fn plan(&self, core: CoreSpec) -> Result<Plan, TrialsError> {
        let project = self.layers()?;
        let request = Request {
            cores: vec![core],
            filters: self.filters.clone(),
            budget: self.budget,
            seed: self.seed,
            jobs: self.jobs,
            fail_fast: false,
        };
        let cases = cases(&project)?;
        Plan::new(project, request, &cases).map_err(TrialsError::because)
    }

    /// `command` repeats a case whose name follows.
    fn core(&self, command: &str) -> CoreSpec {
        CoreSpec::brought(&self.name, command.to_owned(), Arc::clone(&self.make))
    }

    /// What repeats a case where no command is known.
    fn in_words(&self) -> String {
        format!("the case on {}:", self.name)
    }

    fn layers(&self) -> Result<Project, TrialsError> {
        Project::of_the_library(self.own.clone()).map_err(TrialsError::because)
    }
}

fn cases(project: &Project) -> Result<Vec<Arc<Case>>, TrialsError> {
    case::load_project(project).map_err(TrialsError::because)
}

/// Runs a plan into a new folder below `runs`, and writes its report.
fn carry_out(plan: &Plan, runs: &Path) -> Result<RunTree, TrialsError> {
    let folder = run::run(plan, runs, &mut |_| ()).map_err(TrialsError::because)?;
    read_and_report(&folder)
}

fn read_and_report(folder: &Path) -> Result<RunTree, TrialsError> {
    let tree = RunTree::load(folder).map_err(TrialsError::because)?;
    report::html::write(&tree, folder).map_err(TrialsError::because)?;
    Ok(tree)
}
