//! The command line: one verb a file, and what each word means.

#![deny(clippy::print_stdout, clippy::print_stderr)]

mod agreement;
mod bench;
mod compare;
mod completions;
mod debug;
mod doctor;
mod exit_code;
mod explain;
mod export;
mod failures;
mod faults;
mod grade;
mod history;
mod hosting;
mod inline;
mod interrupt;
mod lint;
mod list;
mod man;
mod merge;
mod new;
mod progress;
mod reference;
mod render;
mod repeat;
mod report;
mod run;
mod say;
mod schema;
mod watch;
mod worker;
mod writeup;

pub(crate) use exit_code::ExitCode;

use crate::project::{self, Carried, Project};
use crate::text::colour::Colour;
use clap::{Args, CommandFactory, Parser, Subcommand};
use say::complain;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// What every verb answers: how the process ends, or why it cannot.
type Answer = Result<ExitCode, Failure>;

#[derive(Debug)]
pub(crate) struct Failure {
    code: ExitCode,
    message: String,
}

impl Failure {
    fn request(error: impl std::fmt::Display) -> Self {
        Self { code: ExitCode::BadRequest, message: error.to_string() }
    }

    fn nothing(error: impl std::fmt::Display) -> Self {
        Self { code: ExitCode::NothingSelected, message: error.to_string() }
    }

    /// The harness could not do its work: a full disk, a missing tool.
    fn broken(error: impl std::fmt::Display) -> Self {
        Self { code: ExitCode::Broken, message: error.to_string() }
    }
}

/// Told below every help.
const EXIT_CODES: &str = "\
Exit codes:
  0  something passed, and nothing failed
  1  something failed, crashed or timed out
  2  the request or a case is wrong
  3  something is broken; with --strict also if anything is inconclusive, skipped or blocked
  4  nothing was selected
  5  nothing was proven: all was skipped, blocked, inconclusive or not graded
  130  interrupted";

/// A test bench for path tracers: what is wrong, by how much, where, and why.
#[derive(Debug, Parser)]
#[command(name = "furnace", version, args_conflicts_with_subcommands = true, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    verb: Option<Verb>,
    /// Colour what is printed: where there is a terminal and NO_COLOR is not set, or CLICOLOR_FORCE is; always; never.
    #[arg(
        long,
        value_enum,
        value_name = "WHEN",
        default_value_t,
        global = true,
        hide_possible_values = true
    )]
    color: Colour,
    #[command(flatten)]
    run: run::RunArguments,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Try cases on cores and write a report (what happens without a verb).
    #[command(after_help = EXIT_CODES)]
    Run(run::RunArguments),
    /// Show cases, checks or cores.
    List(list::ListArguments),
    /// Explain a case: what it checks, why it is true, its smallest detectable error and error rate.
    Explain(explain::ExplainArguments),
    /// Look at single answers of a core beside the right ones, and stop a debugger in one.
    Debug(debug::DebugArguments),
    /// Run planted mistakes against the cases: each must be caught and named.
    Faults(faults::FaultsArguments),
    /// Test whether images differ from the last by more than noise, and by which mistake.
    Compare(compare::CompareArguments),
    /// Render one image of one scene by one core.
    Render(render::RenderArguments),
    /// Write the course's write-up of a core: its ladders of images and its tables, as Markdown and HTML.
    Writeup(writeup::WriteupArguments),
    /// Measure how fast BVHs of cores are: speed-ups over brute force, tests a ray, growth.
    Bench(bench::BenchArguments),
    /// Validate every case and scene.
    Lint(lint::LintArguments),
    /// Write the report of a run again.
    Report(report::ReportArguments),
    /// Examine a core: its capabilities, its sandbox, and what to implement next.
    Doctor(doctor::DoctorArguments),
    /// The worker process of a core; furnace starts it by itself.
    #[command(hide = true)]
    Worker(worker::WorkerArguments),
    /// Render the reference scenes, and print how far a renderer is from the references.
    Agreement(agreement::AgreementArguments),
    /// Export a scene to another format: Mitsuba, the course's COLLADA, pbrt, OBJ.
    Export(export::ExportArguments),
    /// Grade a core by a suite: points for each part, for people, Gradescope, JUnit, GitHub and spreadsheets.
    Grade(grade::GradeArguments),
    /// Merge the shares of a class, `furnace grade --shard`, into one table.
    Merge(merge::MergeArguments),
    /// Write a core, a case, a suite or an autograder that is ready to run.
    New(new::NewArguments),
    /// Make, verify or list Mitsuba references.
    Reference(reference::ReferenceArguments),
    /// Show what earlier runs have reached: passes, times.
    History(history::HistoryArguments),
    /// Print the JSON Schema of a kind of file, for editors.
    Schema(schema::SchemaArguments),
    /// Print what a shell needs to complete commands.
    Completions(completions::CompletionsArguments),
    /// Write a manual page for each verb.
    Man(man::ManArguments),
}

/// Where the project is, if not here or above.
#[derive(Clone, Debug, Args)]
struct ProjectArguments {
    /// The folder with cases, scenes or suites of your own [default: here or above, or FURNACE_HOME].
    #[arg(long, value_name = "DIR", global = true)]
    project: Option<PathBuf>,
}

impl ProjectArguments {
    fn find(&self) -> Result<Project, Failure> {
        let found = match &self.project {
            Some(root) => Project::over_the_bench(root.clone()),
            None => Project::find(),
        };
        found.map_err(Failure::request)
    }
}

/// Does what the arguments of the process say, anywhere: `carried` is what a checkout would have.
pub fn main(carried: Carried) -> ExitCode {
    project::carry(carried);
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage(&error),
    };
    arguments.color.choose();
    let answer = match arguments.verb {
        None => run::refuse_a_misplaced_verb(&arguments.run, &verbs())
            .and_then(|()| run_or_watch(&arguments.run)),
        Some(Verb::Run(arguments)) => run_or_watch(&arguments),
        Some(Verb::List(arguments)) => list::list(&arguments),
        Some(Verb::Explain(arguments)) => explain::explain(&arguments),
        Some(Verb::Debug(arguments)) => debug::debug(&arguments),
        Some(Verb::Faults(arguments)) => faults::faults(&arguments),
        Some(Verb::Doctor(arguments)) => doctor::doctor(&arguments),
        Some(Verb::Worker(arguments)) => worker::worker(&arguments),
        Some(Verb::Compare(arguments)) => compare::compare(&arguments),
        Some(Verb::Render(arguments)) => render::render(&arguments),
        Some(Verb::Writeup(arguments)) => writeup::writeup(&arguments),
        Some(Verb::Bench(arguments)) => bench::bench(&arguments),
        Some(Verb::Lint(arguments)) => lint::lint(&arguments),
        Some(Verb::Report(arguments)) => report::report(&arguments),
        Some(Verb::Agreement(arguments)) => agreement::agreement(&arguments),
        Some(Verb::Export(arguments)) => export::export(&arguments),
        Some(Verb::Grade(arguments)) => grade::grade(&arguments),
        Some(Verb::Merge(arguments)) => merge::merge(&arguments),
        Some(Verb::New(arguments)) => new::new(&arguments),
        Some(Verb::Reference(arguments)) => reference::reference(&arguments),
        Some(Verb::History(arguments)) => history::history(&arguments),
        Some(Verb::Schema(arguments)) => schema::schema(&arguments),
        Some(Verb::Completions(arguments)) => completions::completions(&arguments),
        Some(Verb::Man(arguments)) => man::man(&arguments),
    };
    answer.unwrap_or_else(|failure| {
        complain(failure.message);
        failure.code
    })
}

/// A number of threads.
fn jobs(word: &str) -> Result<NonZeroUsize, String> {
    word.parse().map_err(|_| "must be a whole number, 1 or more".to_owned())
}

fn run_or_watch(arguments: &run::RunArguments) -> Answer {
    if arguments.watch { watch::watch(arguments) } else { run::run(arguments) }
}

/// Every word that a command may begin with.
fn verbs() -> Vec<String> {
    let command = Arguments::command();
    let shown = command.get_subcommands().filter(|verb| !verb.is_hide_set());
    shown.map(|verb| verb.get_name().to_owned()).chain(["help".to_owned()]).collect()
}

/// Help goes to stdout and is no error; anything else is a wrong request.
fn usage(error: &clap::Error) -> ExitCode {
    let code = if error.use_stderr() { ExitCode::BadRequest } else { ExitCode::Good };
    // There is nobody left to tell if this cannot be printed.
    let _ = error.print();
    code
}
