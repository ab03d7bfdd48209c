//! `furnace man`: a manual page for each verb, from the same declarations as the help.

use super::say::say_line;
use super::{Answer, Arguments, ExitCode, Failure};
use clap::{Args, CommandFactory};
use std::path::PathBuf;

/// What `furnace man` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct ManArguments {
    /// The folder for the pages: `furnace.1`, `furnace-run.1`, and so on.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(crate) fn man(arguments: &ManArguments) -> Answer {
    let folder = &arguments.out;
    let failed = |error| Failure::broken(format!("cannot write to {}: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(failed)?;
    clap_mangen::generate_to(Arguments::command(), folder).map_err(failed)?;
    say_line!("{}", folder.join("furnace.1").display());
    Ok(ExitCode::Good)
}
