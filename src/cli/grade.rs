//! `furnace grade`: a run by a suite, and its points.

pub(super) mod class;

use super::hosting::HostingArguments;
use super::interrupt::Running;
use super::progress::Progress;
use super::run::salt;
use super::say::{say, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Case};
use crate::cores::CoreSpec;
use crate::disk;
use crate::grade::class::Shard;
use crate::grade::{
    Built, Grade, Standing, Submission, Suite, SuiteError, Workshop, csv, github, gradescope,
    junit, text,
};
use crate::project::Project;
use crate::report::text::Detail;
use crate::report::{self, RunTree};
use crate::run::{self, Event, Plan, RunError};
use clap::Args;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What `furnace grade` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct GradeArguments {
    /// The suite: the name of a file of `suites/`, or a path that ends in `.toml`.
    #[arg(long, value_name = "SUITE")]
    suite: String,
    /// The renderer to grade.
    #[arg(long, value_name = "CORE", required_unless_present_any = ["run", "resume", "submission", "submissions"])]
    core: Option<String>,
    /// Grade a run that is there, without running anything.
    #[arg(long, value_name = "DIR", conflicts_with = "core")]
    run: Option<PathBuf>,
    /// Go on with a graded run that was cut off, or whose time was up.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["core", "run"])]
    resume: Option<PathBuf>,
    /// Grade one submission: a library, a Rust crate, or a folder that the suite's commands build.
    #[arg(long, value_name = "PATH", conflicts_with_all = ["core", "run", "resume"])]
    submission: Option<PathBuf>,
    /// Grade a class: every library and every folder in DIR is a submission.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["core", "run", "resume", "submission", "gradescope", "junit", "github"])]
    submissions: Option<PathBuf>,
    /// Call submissions by their names, where a class is graded.
    #[arg(long, requires = "submissions")]
    names: bool,
    /// Grade the K-th of N equal shares of a class; `furnace merge` puts them together.
    #[arg(long, value_name = "K/N", requires = "submissions")]
    shard: Option<Shard>,
    /// Build submissions as this user, who can read less than the superuser.
    #[arg(long, value_name = "USER")]
    build_as: Option<String>,
    /// Number of trials, or of submissions, to run in parallel [default: one per hardware thread].
    #[arg(short, long, value_name = "N", value_parser = super::jobs)]
    jobs: Option<NonZeroUsize>,
    /// Where runs go [default: reports/runs], and of a class its builds and its page, too [default: classes/SUITE].
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Files for other programs.
#[derive(Clone, Debug, Args)]
struct Outputs {
    /// Write Gradescope's results.json.
    #[arg(long, value_name = "FILE")]
    gradescope: Option<PathBuf>,
    /// Write JUnit's XML.
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write a row a case for spreadsheets.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Print GitHub's annotations, and add to the summary of the step.
    #[arg(long)]
    github: bool,
}

/// Where a run can be read.
struct Pages {
    index: PathBuf,
    /// That it has not come to its end, and how it goes on; nothing of one that has.
    unfinished: String,
}

/// What a grade needs beside a core.
struct Desk {
    project: Project,
    suite: Suite,
    cases: Vec<Arc<Case>>,
    salt: String,
}

/// Runs the cases of the suite and tells the points.
pub(crate) fn grade(arguments: &GradeArguments) -> Answer {
    let project = arguments.project.find()?;
    let suite = Suite::find(&project, &arguments.suite).map_err(suite_failure)?;
    let cases = case::load_project(&project).map_err(Failure::request)?;
    let desk = Desk { project, suite, cases, salt: salt() };
    desk.suite.select(&desk.cases).map_err(suite_failure)?;
    if let Some(folder) = &arguments.submissions {
        return class::grade(arguments, &desk, folder);
    }
    let (grade, pages) = match (&arguments.run, &arguments.resume, &arguments.submission) {
        (Some(folder), _, _) => desk.of_run(folder)?,
        (_, Some(folder), _) => desk.of_resumed(arguments, folder)?,
        (_, _, Some(path)) => desk.of_submission(arguments, path)?,
        _ => desk.of_core(arguments, arguments.core.as_deref().unwrap_or_default())?,
    };
    tell(arguments, &grade, pages.as_ref())?;
    Ok(code(&grade))
}

/// Who shows how a run goes on, and at ctrl-c what it has shown by then.
fn listener(arguments: &GradeArguments) -> impl FnMut(Event<'_>) {
    let mut progress = Progress::new(arguments.json);
    let running = Running::ends_in_words(super::report::style(Detail::Usual));
    move |event| {
        running.hear(&event);
        progress.hear(event);
    }
}

fn suite_failure(error: SuiteError) -> Failure {
    match error {
        SuiteError::Io { .. } => Failure::broken(error),
        _ => Failure::request(error),
    }
}

impl Desk {
    /// Tries a core. One that cannot be asked has a grade too: nothing, and why.
    fn of_core(
        &self,
        arguments: &GradeArguments,
        word: &str,
    ) -> Result<(Grade, Option<Pages>), Failure> {
        let core: CoreSpec = match word.parse() {
            Ok(core) => core,
            Err(unknown) => return Ok(self.absent(word, &unknown)),
        };
        let runs = arguments.report.clone().unwrap_or_else(|| self.project.runs());
        let plan = self.plan(core, arguments.jobs.map_or(0, NonZeroUsize::get))?;
        let plan = plan.hosted(arguments.hosting.hosting(&runs));
        match run::run(&plan, &runs, &mut listener(arguments)) {
            Ok(folder) => self.of_run(&folder),
            Err(error @ RunError::NoCore { .. }) => Ok(self.absent(word, &error)),
            Err(error) => Err(Failure::broken(error)),
        }
    }

    /// Goes on with a run of this very suite.
    fn of_resumed(
        &self,
        arguments: &GradeArguments,
        folder: &Path,
    ) -> Result<(Grade, Option<Pages>), Failure> {
        let tree = RunTree::load(folder).map_err(Failure::request)?;
        let (Some(core), true) = (tree.run.cores.first(), tree.run.seed == self.seed()) else {
            return Err(Failure::request(format!(
                "{} was begun with another suite, version or salt",
                folder.display()
            )));
        };
        let core = core.spec.parse().map_err(Failure::request)?;
        let runs = folder.parent().unwrap_or(folder);
        let plan = self.plan(core, arguments.jobs.map_or(0, NonZeroUsize::get))?;
        let plan = plan.hosted(arguments.hosting.hosting(runs));
        run::resume(&plan, folder, &mut listener(arguments)).map_err(Failure::broken)?;
        self.of_run(folder)
    }

    fn seed(&self) -> u64 {
        self.suite.seed(&self.salt).0
    }

    /// Builds a submission where nobody else is, and tries what comes of it.
    fn of_submission(
        &self,
        arguments: &GradeArguments,
        path: &Path,
    ) -> Result<(Grade, Option<Pages>), Failure> {
        let unreadable =
            |error| Failure::request(format!("cannot read {}: {error}", path.display()));
        let submission = Submission::at(path).map_err(unreadable)?;
        let folder = tempfile::tempdir().map_err(Failure::broken)?;
        let (mut grade, pages) = match submission.core(&self.workshop(arguments), folder.path()) {
            Ok(Built { core, warnings }) => {
                let (grade, pages) = self.of_core(arguments, &core.to_string_lossy())?;
                (Grade { warnings, ..grade }, pages)
            }
            Err(problem) => self.absent("", &problem),
        };
        // Where it was built is no name of its.
        grade.core.clone_from(&submission.name);
        Ok((grade, pages))
    }

    fn workshop<'a>(&'a self, arguments: &'a GradeArguments) -> Workshop<'a> {
        let (project, suite) = (&self.project, &self.suite);
        Workshop { project, suite, user: arguments.build_as.as_deref() }
    }

    fn absent(&self, core: &str, problem: &dyn std::fmt::Display) -> (Grade, Option<Pages>) {
        (Grade::absent(&self.suite, core, &problem.to_string()), None)
    }

    /// The cases of the suite on a core, with the numbers of its version and salt.
    fn plan(&self, core: CoreSpec, jobs: usize) -> Result<Plan, Failure> {
        let selected = self.suite.select(&self.cases).map_err(suite_failure)?;
        let plan = self.suite.plan(&self.project, &selected, &self.salt, core, jobs);
        plan.map_err(Failure::nothing)
    }

    fn of_run(&self, folder: &Path) -> Result<(Grade, Option<Pages>), Failure> {
        let tree = RunTree::load(folder).map_err(Failure::request)?;
        let index = report::html::write(&tree, folder).map_err(Failure::broken)?;
        let selected = self.suite.select(&self.cases).map_err(suite_failure)?;
        let unfinished = report::text::unfinished(&tree, super::report::style(Detail::Usual));
        let grade = Grade::of(&self.suite, &selected, &self.salt, &tree);
        Ok((grade, Some(Pages { index, unfinished })))
    }
}

/// Writes what was asked for, and says the rest.
fn tell(arguments: &GradeArguments, grade: &Grade, pages: Option<&Pages>) -> Result<(), Failure> {
    let outputs = &arguments.outputs;
    if let Some(path) = &outputs.gradescope {
        put(path, &gradescope::results(grade).map_err(Failure::broken)?)?;
    }
    if let Some(path) = &outputs.junit {
        put(path, &junit::report(grade).map_err(Failure::broken)?)?;
    }
    if let Some(path) = &outputs.csv {
        put(path, &csv::table(grade))?;
    }
    if arguments.json {
        say_line!("{}", serde_json::to_string_pretty(grade).map_err(Failure::broken)?);
        return Ok(());
    }
    say!("\n{}", text::table(grade));
    if let Some(Pages { index, unfinished }) = pages {
        say!("\n{unfinished}");
        say_line!("  report  {}", super::report::address(index));
    }
    if outputs.github {
        say!("{}", github::annotations(grade));
        add_to_summary(&github::summary(grade))?;
    }
    Ok(())
}

fn put(path: &Path, text: &str) -> Result<(), Failure> {
    let written = disk::replace(path, text.as_bytes());
    written.map_err(|error| Failure::broken(format!("cannot write {}: {error}", path.display())))
}

/// Other steps' words stand in that file too.
fn add_to_summary(text: &str) -> Result<(), Failure> {
    let Some(path) = std::env::var_os("GITHUB_STEP_SUMMARY") else { return Ok(()) };
    let file = std::fs::OpenOptions::new().append(true).create(true).open(path);
    let added = file.and_then(|mut file| file.write_all(text.as_bytes()));
    added.map_err(|error| Failure::broken(format!("cannot add to the summary: {error}")))
}

/// A grade ends as a run does.
fn code(grade: &Grade) -> ExitCode {
    if grade.points.are_lost() {
        ExitCode::Failed
    } else if grade.count(Standing::Broken) > 0 {
        ExitCode::Broken
    } else if grade.points.earned > 0.0 {
        ExitCode::Good
    } else {
        ExitCode::NothingProven
    }
}
