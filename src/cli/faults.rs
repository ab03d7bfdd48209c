//! `furnace faults`: the bench put to the test.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, NothingSelected};
use crate::cores::textbook::{different::Different, fault::Fault};
use crate::faults::{Matrix, Spared, Tried, select};
use crate::stats::Budget;
use clap::Args;
use serde::Serialize;
use std::num::NonZeroUsize;

/// Width of the columns of names.
const NAME: usize = 34;

/// What `furnace faults` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct FaultsArguments {
    /// Which faults: parts of their names, or the number of a part of the course [default: all].
    filters: Vec<String>,
    /// How small an error each case looks for: quick, default or strict.
    #[arg(long, default_value_t = Budget::Quick)]
    budget: Budget,
    /// Number of trials to run in parallel [default: one per hardware thread].
    #[arg(short, long, value_name = "N", value_parser = super::jobs)]
    jobs: Option<NonZeroUsize>,
    /// Only the case named for a fault, and those beside it where it does not tell the cause; of
    /// cores that are right only the parts that they change.
    #[arg(long)]
    brief: bool,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    project: ProjectArguments,
}

#[derive(Serialize)]
struct Document {
    faults: Vec<Tried>,
    different: Vec<Spared>,
}

/// Puts every selected fault, and every core that is right but different, to the cases.
pub(crate) fn faults(arguments: &FaultsArguments) -> Answer {
    let project = arguments.project.find()?;
    let cases = case::load_project(&project).map_err(Failure::request)?;
    let jobs = arguments.jobs.map_or(0, NonZeroUsize::get);
    let matrix = Matrix::new(project, &cases, arguments.budget, jobs);
    let (faults, different) = select(&arguments.filters).map_err(Failure::nothing)?;
    let document = Document {
        faults: try_faults(&matrix, &faults, arguments)?,
        different: try_different(&matrix, &different, arguments)?,
    };
    let is_good = document.faults.iter().all(Tried::is_good)
        && document.different.iter().all(Spared::is_good);
    if arguments.json {
        say_line!("{}", serde_json::to_string_pretty(&document).map_err(Failure::broken)?);
    } else {
        say_line!("{}", summary(&document));
    }
    Ok(if is_good { ExitCode::Good } else { ExitCode::Failed })
}

fn try_faults(
    matrix: &Matrix,
    faults: &[&'static Fault],
    arguments: &FaultsArguments,
) -> Result<Vec<Tried>, Failure> {
    let head = format!("{:NAME$} part  caught  named  seconds  by", "fault");
    let attempt = |fault: &Fault| match arguments.brief {
        true => matrix.try_fault_briefly(fault),
        false => matrix.try_fault(fault),
    };
    table(&head, faults, arguments, attempt, fault_row)
}

fn try_different(
    matrix: &Matrix,
    cores: &[&'static Different],
    arguments: &FaultsArguments,
) -> Result<Vec<Spared>, Failure> {
    let head = format!("\n{:NAME$} spared  seconds  by", "right but different");
    let attempt = |core: &Different| match arguments.brief {
        true => matrix.touched_by(core).try_different(core),
        false => matrix.try_different(core),
    };
    table(&head, cores, arguments, attempt, |spared, _| different_row(spared))
}

/// Rows appear as they come: the table is its own progress.
fn table<S, T>(
    head: &str,
    subjects: &[&S],
    arguments: &FaultsArguments,
    attempt: impl Fn(&S) -> Result<T, NothingSelected>,
    row: impl Fn(&T, &S) -> String,
) -> Result<Vec<T>, Failure> {
    if !arguments.json && !subjects.is_empty() {
        say_line!("{head}");
    }
    let tried = |subject: &&S| {
        let tried = attempt(subject).map_err(Failure::nothing)?;
        if !arguments.json {
            say_line!("{}", row(&tried, subject));
        }
        Ok(tried)
    };
    subjects.iter().map(tried).collect()
}

fn fault_row(tried: &Tried, fault: &Fault) -> String {
    let by = match tried.by.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [first, rest @ ..] => format!("{first} and {} more", rest.len()),
    };
    let told = match tried.told {
        _ if tried.named => String::new(),
        Some(told) => format!("; named {told}, not {}", fault.cause.name),
        None => format!("; not named, expected {}", fault.cause.name),
    };
    let wanted = if tried.caught { "" } else { fault.caught_by };
    let missing = if wanted.is_empty() { String::new() } else { format!("; not by {wanted}") };
    format!(
        "{:NAME$} {:<5} {:<7} {:<6} {:>7.1}  {by}{missing}{told}",
        tried.name,
        tried.part,
        yes(tried.caught),
        yes(tried.named),
        tried.seconds
    )
}

fn different_row(spared: &Spared) -> String {
    let by = spared.statements.join("; ");
    format!("{:NAME$} {:<7} {:>7.1}  {by}", spared.name, yes(spared.is_good()), spared.seconds)
}

const fn yes(is_so: bool) -> &'static str {
    if is_so { "yes" } else { "NO" }
}

fn summary(document: &Document) -> String {
    let (faults, different) = (&document.faults, &document.different);
    let caught = faults.iter().filter(|tried| tried.caught).count();
    let named = faults.iter().filter(|tried| tried.is_good()).count();
    let spared = different.iter().filter(|core| core.is_good()).count();
    format!(
        "\n{caught} of {} faults are caught, {named} of them named; {spared} of {} right cores are spared",
        faults.len(),
        different.len()
    )
}
