//! `furnace agreement`: how far renderers are from the references.

use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::agreement::{self, Effort};
use crate::case::NothingSelected;
use crate::cores::CoreSpec;
use clap::Args;

/// What `furnace agreement` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct AgreementArguments {
    /// References: parts of their names [default: all].
    filters: Vec<String>,
    /// The renderer, such as adapters/command/cycles.toml; may be repeated.
    #[arg(long = "core", value_name = "CORE", required = true)]
    cores: Vec<CoreSpec>,
    /// Independent renders of each scene.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..))]
    runs: u32,
    /// Samples per pixel in each.
    #[arg(long, value_name = "N", default_value_t = 64)]
    spp: u32,
    /// Use hemisphere sampling instead of light sampling.
    #[arg(long)]
    hemisphere: bool,
    #[command(flatten)]
    project: ProjectArguments,
}

/// Renders and prints one table a renderer, in Markdown.
pub(crate) fn agreement(arguments: &AgreementArguments) -> Answer {
    let project = arguments.project.find()?;
    let filters = &arguments.filters;
    let all = agreement::references(&project);
    if let Some(word) = filters.iter().find(|word| !all.iter().any(|name| name.contains(*word))) {
        return Err(Failure::nothing(NothingSelected::by(word, all.iter().map(String::as_str))));
    }
    let is_selected =
        |name: &String| filters.is_empty() || filters.iter().any(|part| name.contains(part));
    let names: Vec<_> = all.into_iter().filter(is_selected).collect();
    let effort = Effort {
        runs: arguments.runs,
        samples: arguments.spp,
        by_hemisphere: arguments.hemisphere,
    };
    for core in &arguments.cores {
        let rows: Vec<_> = names
            .iter()
            .map(|name| (name.clone(), agreement::compare(&project, core, name, effort)))
            .collect();
        say_line!("{}", agreement::table(core.as_str(), &rows));
    }
    Ok(ExitCode::Good)
}
