//! `furnace run`: the default verb.

use super::failures::Failures;
use super::hosting::HostingArguments;
use super::inline;
use super::interrupt::Running;
use super::progress::Progress;
use super::repeat;
use super::say::{say, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, CatalogError};
use crate::contract::Components;
use crate::cores::{CORES, CoreSpec};
use crate::grade::SALT_VARIABLE;
use crate::image::exr;
use crate::math::rng::Seed;
use crate::project::Project;
use crate::report::html::develop::Shows;
use crate::report::text::Detail;
use crate::report::{self, RunTree, TreeError};
use crate::run::record::{self, PictureFile};
use crate::run::{self, Plan, Request, RunError, RunRecord, TrialRecord};
use crate::stats::Budget;
use crate::text::{all_of, did_you_mean, hint, program};
use clap::Args;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Cases whose images are shown on a terminal that can.
const MOST_SHOWN: usize = 3;

/// What `furnace run` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct RunArguments {
    /// Cases to try: parts of their names, `@tag`, a part's number 1 to 6, `!` before any of these for not.
    filters: Vec<String>,
    /// The renderer to try; may be repeated [default: every core of our own].
    #[arg(long = "core", value_name = "CORE")]
    cores: Vec<CoreSpec>,
    /// How small an error to look for: quick (5 %), default (2 %) or strict (0.5 %).
    #[arg(long, default_value_t)]
    budget: Budget,
    /// Seed of the random numbers, for audits. Verdicts are published for the default seed.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = seed)]
    seed: Option<u64>,
    /// Number of trials to run in parallel [default: one per hardware thread].
    #[arg(short, long, value_name = "N", value_parser = super::jobs)]
    jobs: Option<NonZeroUsize>,
    /// Stop at the first failure.
    #[arg(long)]
    fail_fast: bool,
    /// Components to take from the bench in place of the core's own: `--with box-test,bsdf`.
    #[arg(long, value_name = "COMPONENTS", value_delimiter = ',', value_parser = component)]
    with: Vec<Components>,
    /// Try again whenever a case, a scene or the core's file changes, what failed last first; ctrl-c ends.
    #[arg(long, conflicts_with_all = ["resume", "verbose", "strict"])]
    pub(crate) watch: bool,
    /// Only what failed in the last run: its cases, on its cores.
    #[arg(long, conflicts_with_all = ["resume", "watch"])]
    failed: bool,
    /// Run N times, each with other random numbers, and tell how often each case passes.
    #[arg(long, value_name = "N", conflicts_with_all = ["resume", "watch", "fail_fast"])]
    repeat: Option<NonZeroUsize>,
    /// Resume an interrupted run; its request is read from its folder.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["filters", "cores", "budget", "seed", "fail_fast", "with"])]
    resume: Option<PathBuf>,
    /// Exit with code 3 if anything is inconclusive, skipped or blocked.
    #[arg(long)]
    strict: bool,
    /// Where runs go [default: reports/runs].
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Print only the counts and where the report is.
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// Tell all that is known of each failure, the smallest detectable error of every trial, and the error rates.
    #[arg(short, long)]
    verbose: bool,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    pub(crate) project: ProjectArguments,
}

/// Refuses a run without a verb where a word is nearly one, mistyped or late: it must not cost minutes of trials.
pub(crate) fn refuse_a_misplaced_verb(
    arguments: &RunArguments,
    verbs: &[String],
) -> Result<(), Failure> {
    let verbs = || verbs.iter().map(String::as_str);
    let meant =
        arguments.filters.iter().find_map(|word| Some((word, did_you_mean(word, verbs())?)));
    let Some((word, hint)) = meant else { return Ok(()) };
    let problem = match verbs().any(|verb| verb == word) {
        true => format!("`{word}` is a verb, and a verb comes first: `furnace {word} ...`"),
        false => format!("there is no verb `{word}`\nhint: {hint}"),
    };
    let other = format!("to try the cases that are called so: `furnace run {word}`");
    Err(Failure::request(format!("{problem}\nhint: {other}")))
}

/// The salt of grades, or nothing.
pub(crate) fn salt() -> String {
    std::env::var(SALT_VARIABLE).unwrap_or_default()
}

/// Tries the cases, prints the summary, writes the report.
pub(crate) fn run(arguments: &RunArguments) -> Answer {
    let project = arguments.project.find()?;
    let cases = case::load_project(&project).map_err(|error| match error {
        CatalogError::Io { .. } => Failure::broken(error),
        CatalogError::Malformed(_) => Failure::request(error),
    })?;
    let runs = arguments.runs(&project);
    let (request, with) = match &arguments.resume {
        Some(folder) => request_of(folder, arguments.jobs())?,
        None => (arguments.request(), arguments.with.iter().copied().collect()),
    };
    let hosting = arguments.hosting.hosting(&runs);
    let failures = if arguments.failed { Some(Failures::of_the_last(&runs)?) } else { None };
    let request = match &failures {
        Some(failures) if arguments.cores.is_empty() => failures.request(request)?,
        _ => request,
    };
    let mut plan = Plan::new(project, request, &cases).map_err(Failure::nothing)?;
    if let Some(failures) = failures {
        failures.restrict(&mut plan)?;
    }
    let plan = plan.hosted(hosting).taking(with).salted(salt());
    if let Some(times) = arguments.repeat {
        return repeat::repeat(plan, &runs, times, arguments.quiet);
    }
    let mut progress = Progress::new(arguments.quiet);
    let running = Running::ends_in_words(super::report::style(arguments.detail()));
    let mut listen = |event: run::Event<'_>| {
        running.hear(&event);
        progress.hear(event);
    };
    let folder = match &arguments.resume {
        Some(folder) => run::resume(&plan, folder, &mut listen).map(|()| folder.clone()),
        None => run::run(&plan, &runs, &mut listen),
    };
    match folder {
        Ok(folder) => finish(arguments, &folder),
        Err(error @ RunError::NoCore { .. }) => Err(Failure::request(error)),
        Err(error) => Err(Failure::broken(error)),
    }
}

impl RunArguments {
    pub(crate) fn runs(&self, project: &Project) -> PathBuf {
        self.report.clone().unwrap_or_else(|| project.runs())
    }

    /// None means one per hardware thread.
    fn jobs(&self) -> usize {
        self.jobs.map_or(0, NonZeroUsize::get)
    }

    const fn detail(&self) -> Detail {
        match (self.quiet, self.verbose) {
            (true, _) => Detail::Counts,
            (_, true) => Detail::Everything,
            _ => Detail::Usual,
        }
    }

    pub(crate) fn request(&self) -> Request {
        let all = || CORES.iter().filter_map(|kind| kind.name.parse().ok()).collect();
        Request {
            cores: if self.cores.is_empty() { all() } else { self.cores.clone() },
            filters: self.filters.clone(),
            budget: self.budget,
            seed: self.seed.map_or(Seed::SUITE, Seed),
            jobs: self.jobs(),
            fail_fast: self.fail_fast,
        }
    }
}

/// What a run was asked, from its own folder.
fn request_of(folder: &Path, jobs: usize) -> Result<(Request, Components), Failure> {
    let path = folder.join("run.json");
    if !path.is_file() {
        return Err(Failure::request(TreeError::NotARun(folder.to_owned())));
    }
    let record: RunRecord = record::read_json(&path).map_err(Failure::request)?;
    if let Some(suite) = &record.suite {
        let suite = shell_words::quote(suite);
        return Err(Failure::request(format!(
            "{folder} is a run of the suite {suite}\nhint: `{} grade --suite {suite} --resume {folder}`",
            program(),
            folder = folder.display()
        )));
    }
    let cores = record.cores.iter().map(|core| core.spec.parse());
    let request = Request {
        cores: cores.collect::<Result<_, _>>().map_err(Failure::request)?,
        filters: record.filters,
        budget: record.budget,
        seed: Seed(record.seed),
        jobs,
        fail_fast: record.fail_fast,
    };
    Ok((request, record.with))
}

fn seed(word: &str) -> Result<u64, String> {
    word.parse().map_err(|_| format!("must be a whole number from 0 to {}", u64::MAX))
}

/// The component of this name.
fn component(word: &str) -> Result<Components, String> {
    let names = Components::all().names();
    let names = || names.iter().map(String::as_str);
    let hint = || hint(word, names(), || all_of(names()));
    let component = Components::from_names(&[word.to_owned()]);
    component.map_err(|problem| format!("{problem}\nhint: {}", hint()))
}

/// Summary and report, both of them readers of the folder.
fn finish(arguments: &RunArguments, folder: &Path) -> Answer {
    let tree = RunTree::load(folder).map_err(Failure::broken)?;
    let page = report::html::write(&tree, folder).map_err(Failure::broken)?;
    if arguments.verbose && !arguments.quiet && inline::is_possible() {
        show_failures(&tree);
    }
    say!("{}", report::text::summary(&tree, super::report::style(arguments.detail())));
    say_line!("  report  {}", super::report::address(&page));
    Ok(ExitCode::of(&tree.counts().graded, arguments.strict))
}

/// The images of the first cases that fail, each with what it should be and where it is not.
fn show_failures(tree: &RunTree) {
    let shown =
        |trial: &&TrialRecord| trial.outcome.status().is_failure() && !trial.pictures.is_empty();
    for trial in tree.trials.iter().filter(shown).take(MOST_SHOWN) {
        let read = |picture: &PictureFile| {
            let image = exr::read_image(&tree.picture_path(trial, picture)).ok()?;
            Some((image, Shows::from(picture.role)))
        };
        let images: Vec<_> = trial.pictures.iter().filter_map(read).collect();
        let captions = trial.pictures.iter().map(|picture| picture.caption.as_str());
        let captions = captions.collect::<Vec<_>>().join(" · ");
        say_line!("\n  {} on {}: {captions}", trial.case, trial.core);
        inline::show(&images.iter().map(|(image, shows)| (image, *shows)).collect::<Vec<_>>());
    }
}
