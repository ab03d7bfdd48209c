//! `furnace list`: what there is.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Filter, NothingSelected};
use crate::cause;
use crate::checks;
use crate::cores::CORES;
use crate::cores::textbook::different::DIFFERENT;
use crate::cores::textbook::fault;
use crate::diagnosis::RULES;
use clap::{Args, ValueEnum};

/// What `furnace list` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ListArguments {
    /// What to list.
    #[arg(value_enum, default_value_t)]
    what: What,
    /// Which cases, as for `furnace run`; of anything else, parts of names.
    filters: Vec<String>,
    #[command(flatten)]
    project: ProjectArguments,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum What {
    #[default]
    Cases,
    Checks,
    Cores,
    Faults,
    Causes,
    Rules,
}

pub(crate) fn list(arguments: &ListArguments) -> Answer {
    let words = &arguments.filters;
    match arguments.what {
        What::Cases => list_cases(arguments),
        What::Checks => list_named(words, checks::all().map(|check| (check.name, check.summary))),
        What::Faults => {
            let faults = fault::all().map(|fault| (fault.name, fault.summary));
            list_named(words, faults.chain(DIFFERENT.iter().map(|core| (core.name, core.summary))))
        }
        What::Causes => list_named(words, cause::all().map(|cause| (cause.name, cause.headline))),
        What::Rules => list_named(words, RULES.iter().map(|rule| (rule.name, rule.summary))),
        What::Cores => list_named(words, CORES.iter().map(|core| (core.name, core.summary))),
    }
}

fn list_cases(arguments: &ListArguments) -> Answer {
    let project = arguments.project.find()?;
    let cases = case::load_project(&project).map_err(Failure::request)?;
    let selected = Filter::new(&arguments.filters).select(&cases).map_err(Failure::nothing)?;
    print_table(selected.iter().map(|case| (case.id.as_str(), case.title.as_str())));
    Ok(ExitCode::Good)
}

/// The rows whose names contain one of the words; all without words.
fn list_named<'a>(words: &[String], rows: impl Iterator<Item = (&'a str, &'a str)>) -> Answer {
    let rows: Vec<_> = rows.collect();
    let names = || rows.iter().map(|(name, _)| *name);
    if let Some(unknown) = words.iter().find(|word| !names().any(|name| name.contains(*word))) {
        return Err(Failure::nothing(NothingSelected::by(unknown, names())));
    }
    let is_wanted = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word));
    print_table(rows.iter().copied().filter(|(name, _)| is_wanted(name)));
    Ok(ExitCode::Good)
}

fn print_table<'a>(rows: impl Iterator<Item = (&'a str, &'a str)>) {
    let rows: Vec<_> = rows.collect();
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, summary) in rows {
        say_line!("{name:width$}  {summary}");
    }
}
