//! Every case as a trial of `cargo test`, and of `cargo nextest`, which starts this program once for each.
//!
//! The trials run as one run of the bench, in which what rests on something broken is tried with the bench's own; each
//! test waits for the result of its case. So filters are those of `cargo test`, and the report is that of a run.

use super::folder::{command, runs};
use super::{Trials, TrialsError, cases, read_and_report};
use crate::case::Case;
use crate::report::text::blocks::full_block;
use crate::report::text::{Detail, Style, summary};
use crate::report::{self, RunTree};
use crate::run::{self, Event, Plan, RunError, Status, Trial, TrialRecord};
use crate::text::colour::Colour;
use libtest_mimic::{Arguments, Completion, Failed, Trial as Test};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What nextest tells the programs that it starts: each of them tries one case.
const NEXTEST: &str = "NEXTEST";

type Senders = BTreeMap<String, Sender<TrialRecord>>;

impl Trials {
    /// Does what the arguments of this program say, as `cargo test` and nextest give them: the whole `main` of a test.
    /// What the core cannot be asked, what is blocked and what is not decided is *ignored*, with the reason.
    #[must_use = "it says whether a test has failed"]
    pub fn test(self) -> ExitCode {
        self.tested(Arguments::from_args()).unwrap_or_else(|error| {
            eprintln!("error: {error}");
            ExitCode::from(2)
        })
    }

    fn tested(self, mut arguments: Arguments) -> Result<ExitCode, TrialsError> {
        let jobs = arguments.test_threads.unwrap_or(self.jobs);
        let trials = self.jobs(jobs);
        let mut plan = trials.plan(trials.core(&command()))?;
        let is_alone = std::env::var_os(NEXTEST).is_some();
        let can = (trials.make)().info().capabilities;
        let mut senders = Senders::new();
        let tests = plan.trials.iter().map(|trial| {
            let (sender, result) = channel();
            senders.insert(trial.case.id.clone(), sender);
            // nextest knows no reason to ignore a test, once it has begun.
            let lacks = !trial.case.prepared.missing(can).is_empty();
            test(&trial.case, result).with_ignored_flag(is_alone && lacks)
        });
        let tests: Vec<_> = tests.collect();
        // Those that wait cost nothing, and each is told of when it ends: the run has threads of its own.
        arguments.test_threads.get_or_insert(tests.len().max(1));
        let chosen = tests.iter().map(|test| !is_left_out(&arguments, test));
        let chosen: Vec<_> = chosen.collect();
        let mut chosen = chosen.into_iter();
        plan.trials.retain(|_| chosen.next().unwrap_or(false));
        if arguments.list || plan.trials.is_empty() {
            return Ok(libtest_mimic::run(&arguments, tests).exit_code());
        }
        let tried = if is_alone { alone } else { together };
        tried(plan, &arguments, tests, senders)
    }
}

fn is_left_out(arguments: &Arguments, test: &Test) -> bool {
    arguments.is_filtered_out(test) || arguments.is_ignored(test)
}

/// All that is chosen as one run, with a report.
fn together(
    plan: Plan,
    arguments: &Arguments,
    tests: Vec<Test>,
    senders: Senders,
) -> Result<ExitCode, TrialsError> {
    let run = std::thread::spawn(move || run_into(&plan, &runs(), senders));
    let conclusion = libtest_mimic::run(arguments, tests);
    let folder = run.join().map_err(|_| TrialsError("furnace itself panicked".to_owned()))?;
    let tree = read_and_report(&folder.map_err(TrialsError::because)?)?;
    tell(&tree, if conclusion.has_failed() { Detail::Usual } else { Detail::Counts });
    let page = tree.folder.join("index.html");
    say(&format!("  report  {}\n", report::address(&page)));
    Ok(conclusion.exit_code())
}

/// One case in a process of its own: where it fails, so does what it rests on, perhaps, which is tried before it then.
fn alone(
    plan: Plan,
    arguments: &Arguments,
    tests: Vec<Test>,
    senders: Senders,
) -> Result<ExitCode, TrialsError> {
    let runs = tempfile::tempdir().map_err(TrialsError::because)?;
    let below = runs.path().to_owned();
    let run = std::thread::spawn(move || run_with_foundations(plan, &below, senders));
    let conclusion = libtest_mimic::run(arguments, tests);
    let tree = run.join().map_err(|_| TrialsError("furnace itself panicked".to_owned()))??;
    if conclusion.has_failed() {
        tell(&tree, Detail::Usual);
    }
    Ok(conclusion.exit_code())
}

fn run_with_foundations(
    mut plan: Plan,
    runs: &Path,
    senders: Senders,
) -> Result<RunTree, TrialsError> {
    let run = |plan: &Plan| super::carry_out(plan, runs);
    let mut tree = run(&plan)?;
    if tree.trials.iter().any(TrialRecord::fails_the_core) {
        let below = foundations(&plan, &tree.trials)?;
        if !below.is_empty() {
            plan.trials.splice(0..0, below);
            tree = run(&plan)?;
        }
    }
    tree.trials.iter().for_each(|trial| hand_over(&senders, trial));
    Ok(tree)
}

/// The cases that prove what these rest on, and what those rest on in turn.
fn foundations(plan: &Plan, trials: &[TrialRecord]) -> Result<Vec<Trial>, TrialsError> {
    let bench = plan.bench();
    let known: BTreeSet<_> = trials.iter().map(|trial| trial.case.as_str()).collect();
    let mut wanted: BTreeSet<_> = trials.iter().flat_map(|trial| trial.rests_on.clone()).collect();
    let all = cases(&plan.project)?;
    let proves = |case: &Case, wanted: &BTreeSet<_>| case.proves.iter().any(|f| wanted.contains(f));
    loop {
        let before = wanted.len();
        for case in all.iter().filter(|case| proves(case, &wanted)).collect::<Vec<_>>() {
            wanted.extend(run::rests_on(&bench, case));
        }
        if wanted.len() == before {
            break;
        }
    }
    let below =
        all.iter().filter(|case| proves(case, &wanted) && !known.contains(case.id.as_str()));
    let core = &plan.request.cores[0];
    Ok(below.map(|case| Trial { case: Arc::clone(case), core: core.clone() }).collect())
}

fn run_into(plan: &Plan, runs: &Path, senders: Senders) -> Result<PathBuf, RunError> {
    let mut listen = |event: Event<'_>| {
        if let Event::Ended { trial } = event {
            hand_over(&senders, trial);
        }
    };
    run::run(plan, runs, &mut listen)
}

/// Nobody waits any more where the tests were ended.
fn hand_over(senders: &Senders, trial: &TrialRecord) {
    if let Some(sender) = senders.get(&trial.case) {
        let _ = sender.send(trial.clone());
    }
}

fn test(case: &Case, result: Receiver<TrialRecord>) -> Test {
    Test::ignorable_test(case.id.clone(), move || match result.recv() {
        Ok(record) => completion(&record),
        Err(_) => Err("the run ended before this case was tried".into()),
    })
}

/// A pass, a failure in the words of the report, or why neither is known.
fn completion(record: &TrialRecord) -> Result<Completion, Failed> {
    let status = record.outcome.status();
    if status == Status::Pass {
        return Ok(Completion::Completed);
    }
    if record.fails_the_core() || status == Status::Broken {
        return Err(full_block(record, Style::PLAIN).join("\n").into());
    }
    let graded = if record.tier.is_graded() { "" } else { "not graded, " };
    let statement = record.outcome.statement();
    let first = statement.lines().next().unwrap_or_default();
    Ok(Completion::ignored_with(format!("{graded}{}: {first}", status.word())))
}

fn tell(tree: &RunTree, detail: Detail) {
    let colour = Colour::is_wanted(std::io::stdout().is_terminal());
    say(&summary(tree, Style { colour, detail, ..Style::PLAIN }));
}

/// Where nobody reads, nothing is told.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
