//! Every case on every core, one trial each, through the same path as `furnace run`.
//!
//! `FURNACE_CORE=NAME|path/to/lib.so|'exec: COMMAND'` grades that core alone, `FURNACE_BUDGET=quick|default|strict` says how small an error is
//! looked for. Names are paths: `cargo test --test cases builtin::bvh`, `-- --exact textbook::light/claim`.

use furnace::case::{self, Case};
use furnace::cores::{CORES, CoreSpec, Hosting};
use furnace::project::Project;
use furnace::run::{Bench, Plan, Request, Status, Trial, run_trial};
use furnace::stats::Verdict;
use libtest_mimic::{Arguments, Failed, Trial as Test};
use std::process::ExitCode;
use std::sync::Arc;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    match plan() {
        Ok(plan) => libtest_mimic::run(&arguments, tests(&plan)).exit_code(),
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn plan() -> Result<Plan, String> {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).map_err(|error| error.to_string())?;
    let request = Request {
        cores: cores()?,
        budget: from_environment("FURNACE_BUDGET")?.unwrap_or_default(),
        jobs: 0,
        ..Request::default()
    };
    let program = env!("CARGO_BIN_EXE_furnace").into();
    let plan = Plan::new(project, request, &cases).map_err(|error| error.to_string())?;
    Ok(plan.hosted(Hosting { program, ..Hosting::default() }))
}

fn cores() -> Result<Vec<CoreSpec>, String> {
    match from_environment("FURNACE_CORE")? {
        Some(core) => Ok(vec![core]),
        None => CORES.iter().map(|kind| kind.name.parse().map_err(|e| format!("{e}"))).collect(),
    }
}

/// The value of a variable, if it is set; a value that means nothing is an error.
fn from_environment<T: std::str::FromStr<Err: std::fmt::Display>>(
    name: &str,
) -> Result<Option<T>, String> {
    match std::env::var(name) {
        Ok(word) => word.parse().map(Some).map_err(|error| format!("{name}: {error}")),
        Err(_) => Ok(None),
    }
}

fn tests(plan: &Plan) -> Vec<Test> {
    let bench = Arc::new(plan.bench());
    plan.trials.iter().map(|trial| test(Arc::clone(&bench), trial.clone())).collect()
}

fn test(bench: Arc<Bench>, trial: Trial) -> Test {
    let name = name(&trial.core, &trial.case);
    Test::test(name, move || verdict(&bench, &trial))
}

fn name(core: &CoreSpec, case: &Case) -> String {
    format!("{core}::{}", case.id)
}

/// A pass, or the words of the report. What a foreign core cannot do is not held against it, and our own can do
/// everything; what was not decided is no pass.
fn verdict(bench: &Bench, trial: &Trial) -> Result<(), Failed> {
    let record = run_trial(bench, trial).record;
    match record.outcome.status() {
        Status::Pass => Ok(()),
        Status::Skipped if !is_own(&trial.core) => Ok(()),
        status => Err(Failed::from(format!(
            "{}: {}\n  {}\n  rerun   {}",
            status.word(),
            record.outcome.statement(),
            measures(&record.outcome),
            record.rerun,
        ))),
    }
}

fn is_own(core: &CoreSpec) -> bool {
    CORES.iter().any(|kind| kind.name == core.as_str())
}

/// What did not pass, one line a measure.
fn measures(outcome: &furnace::run::Outcome) -> String {
    let Some(finding) = outcome.finding() else { return String::new() };
    let lines = finding.measures.iter().filter(|measure| measure.verdict != Verdict::Pass);
    let lines = lines.take(12).map(|measure| {
        format!(
            "{}: measured {}, expected {}, allowed {}, would have caught {}",
            measure.name(),
            measure.measured,
            measure.expected,
            measure.allowed,
            measure.resolution.map_or("-".to_owned(), |share| format!("{:.2} %", 100.0 * share)),
        )
    });
    lines.collect::<Vec<_>>().join("\n  ")
}
