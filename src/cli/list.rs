//! `furnace list`: what there is.

use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Filter};
use crate::cause;
use crate::checks::CHECKS;
use crate::cores::CORES;
use crate::cores::textbook::different::DIFFERENT;
use crate::cores::textbook::fault;
use crate::diagnosis::RULES;
use clap::{Args, ValueEnum};

/// What `furnace list` understands.
#[derive(Clone, Debug, Args)]
pub struct ListArguments {
    /// What to list.
    #[arg(value_enum, default_value_t)]
    what: What,
    /// Which cases, as for `furnace run`.
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

/// Prints a table.
pub fn list(arguments: &ListArguments) -> Answer {
    match arguments.what {
        What::Cases => return list_cases(arguments),
        What::Checks => print_table(CHECKS.iter().map(|check| (check.name, check.summary))),
        What::Faults => {
            print_table(fault::all().map(|fault| (fault.name, fault.summary)));
            print_table(DIFFERENT.iter().map(|core| (core.name, core.summary)));
        }
        What::Causes => print_table(cause::all().map(|cause| (cause.name, cause.headline))),
        What::Rules => print_table(RULES.iter().map(|rule| (rule.name, rule.summary))),
        What::Cores => print_table(CORES.iter().map(|core| (core.name, core.summary))),
    }
    Ok(ExitCode::Good)
}

fn list_cases(arguments: &ListArguments) -> Answer {
    let project = arguments.project.find()?;
    let cases = case::load_all(&project.cases()).map_err(Failure::request)?;
    let filter = Filter::new(&arguments.filters);
    let selected: Vec<_> = cases.iter().filter(|case| filter.selects(case)).collect();
    print_table(selected.iter().map(|case| (case.id.as_str(), case.title.as_str())));
    Ok(if selected.is_empty() { ExitCode::NothingSelected } else { ExitCode::Good })
}

fn print_table<'a>(rows: impl Iterator<Item = (&'a str, &'a str)>) {
    let rows: Vec<_> = rows.collect();
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, summary) in rows {
        println!("{name:width$}  {summary}");
    }
}
