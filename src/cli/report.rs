//! `furnace report`: writes the pages of a run again, from its folder alone.

use super::say::{say, say_line};
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::report::text::Style;
use crate::report::{self, RunTree};
use clap::Args;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

/// What `furnace report` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReportArguments {
    /// The folder of a run [default: the newest].
    run: Option<PathBuf>,
    /// List the smallest detectable error of every trial.
    #[arg(short, long)]
    verbose: bool,
    /// Write one file with the failing cases, to be sent, in place of a page a case.
    #[arg(long)]
    single_file: bool,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Prints the summary and writes the page.
pub(crate) fn report(arguments: &ReportArguments) -> Answer {
    let folder = match &arguments.run {
        Some(folder) => folder.clone(),
        None => newest(&arguments.project.find()?.runs())?,
    };
    let tree = RunTree::load(&folder).map_err(Failure::request)?;
    let write = match arguments.single_file {
        true => report::html::write_single,
        false => report::html::write,
    };
    let page = write(&tree, &folder).map_err(Failure::broken)?;
    say!("{}", report::text::summary(&tree, style(arguments.verbose)));
    say_line!("  report  {}", address(&page));
    Ok(ExitCode::Good)
}

/// The last folder by name: names are times.
fn newest(runs: &Path) -> Result<PathBuf, Failure> {
    let none = || Failure::request(format!("{} holds no run", runs.display()));
    let entries = std::fs::read_dir(runs).map_err(|_| none())?;
    let folders = entries.filter_map(|entry| Some(entry.ok()?.path()));
    folders.filter(|path| path.join("run.json").is_file()).max().ok_or_else(none)
}

/// How the summary is dressed on this terminal.
pub(crate) fn style(verbose: bool) -> Style {
    let colour = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    Style { colour, verbose, ..Style::PLAIN }
}

/// What a browser opens.
pub(crate) fn address(page: &Path) -> String {
    let page = page.canonicalize().unwrap_or_else(|_| page.to_owned());
    format!("file://{}", page.display())
}
