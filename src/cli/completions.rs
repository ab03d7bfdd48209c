//! `furnace completions`: what a shell completes, from the same declarations as the help.

use super::say::say;
use super::{Answer, Arguments, ExitCode, Failure};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// What `furnace completions` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct CompletionsArguments {
    /// The shell whose script is printed.
    #[arg(value_enum)]
    shell: Shell,
}

pub(crate) fn completions(arguments: &CompletionsArguments) -> Answer {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "furnace", &mut script);
    say!("{}", String::from_utf8(script).map_err(Failure::broken)?);
    Ok(ExitCode::Good)
}
