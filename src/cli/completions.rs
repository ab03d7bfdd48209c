//! `furnace completions`: what a shell completes, from the same declarations as the help.

use super::say::say;
use super::{Answer, Arguments, ExitCode, Failure};
use clap::{Args, Command, CommandFactory};
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
    clap_complete::generate(arguments.shell, &mut shown(), "furnace", &mut script);
    say!("{}", String::from_utf8(script).map_err(Failure::broken)?);
    Ok(ExitCode::Good)
}

/// The command without the verbs that nobody types.
fn shown() -> Command {
    let all = Arguments::command();
    let verbs = all.get_subcommands().filter(|verb| !verb.is_hide_set());
    let (arguments, groups) = (all.get_arguments(), all.get_groups());
    Command::new("furnace")
        .groups(groups.cloned())
        .args(arguments.cloned())
        .subcommands(verbs.cloned())
}
