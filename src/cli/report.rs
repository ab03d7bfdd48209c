//! `furnace report`: writes the pages of a run again, from its folder alone.

use super::say::{say, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
pub(crate) use crate::report::address;
use crate::report::text::{Detail, Style};
use crate::report::{self, RunTree, TreeError};
use crate::text::colour::Colour;
use crate::text::did_you_mean;
use clap::Args;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

const MOST_COLUMNS: usize = 100;

/// What `furnace report` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReportArguments {
    /// The folder of a run [default: the newest].
    run: Option<PathBuf>,
    /// Tell all that is known of each failure, the smallest detectable error of every trial, and the error rates.
    #[arg(short, long)]
    verbose: bool,
    /// Write one file with the failing cases, to be sent, in place of a page a case.
    #[arg(long)]
    single_file: bool,
    /// Where people look for it first; it renders, so it has a verb of its own.
    #[arg(long, hide = true)]
    writeup: bool,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Prints the summary and writes the page.
pub(crate) fn report(arguments: &ReportArguments) -> Answer {
    if arguments.writeup {
        return Err(Failure::request("a write-up is made by `furnace writeup --core CORE`"));
    }
    let folder = match &arguments.run {
        Some(folder) => folder.clone(),
        None => newest(&arguments.project.find()?.runs())?,
    };
    let tree = RunTree::load(&folder).map_err(|error| match error {
        TreeError::NotARun(_) => Failure::request(format!("{error}{}", meant(&folder))),
        _ => Failure::request(error),
    })?;
    let write = match arguments.single_file {
        true => report::html::write_single,
        false => report::html::write,
    };
    let page = write(&tree, &folder).map_err(Failure::broken)?;
    let detail = if arguments.verbose { Detail::Everything } else { Detail::Usual };
    say!("{}", report::text::summary(&tree, style(detail)));
    say_line!("  report  {}", address(&page));
    Ok(ExitCode::Good)
}

/// The run beside it that was probably meant, or else the newest; the newest of a folder of runs.
fn meant(folder: &Path) -> String {
    let runs = if folder.is_dir() { folder } else { folder.parent().unwrap_or(folder) };
    let found: Vec<_> = in_folder(runs).map(|path| path.display().to_string()).collect();
    let wrong = folder.display().to_string();
    let nearest = did_you_mean(&wrong, found.iter().map(String::as_str));
    let newest = || found.iter().max().map(|path| format!("the newest run there is `{path}`"));
    nearest.or_else(newest).map_or_else(String::new, |hint| format!("\nhint: {hint}"))
}

/// The last folder by name: names are times.
pub(crate) fn newest(runs: &Path) -> Result<PathBuf, Failure> {
    let none = || Failure::request(format!("{} holds no run", runs.display()));
    in_folder(runs).max().ok_or_else(none)
}

/// The runs in a folder, in no order.
fn in_folder(runs: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = std::fs::read_dir(runs).into_iter().flatten();
    let folders = entries.filter_map(|entry| Some(entry.ok()?.path()));
    folders.filter(|path| path.join("run.json").is_file())
}

/// How the summary is dressed on this terminal.
pub(crate) fn style(detail: Detail) -> Style {
    let colour = Colour::is_wanted(std::io::stdout().is_terminal());
    Style { colour, detail, columns: columns(), ..Style::PLAIN }
}

/// As many as the user says, or the terminal has; longer lines than these are hard to read.
fn columns() -> usize {
    let said = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let terminal = || terminal_size::terminal_size().map(|(width, _)| usize::from(width.0));
    said.or_else(terminal).unwrap_or(Style::PLAIN.columns).min(MOST_COLUMNS)
}
