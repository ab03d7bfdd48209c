//! `furnace history`: what earlier runs have shown, from their `run.json` alone.

use super::report::style;
use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::report::text::{Detail, Paint};
use crate::report::{self, Reached};
use crate::text::number::{count, duration};
use crate::text::{all_of, hint};
use clap::Args;
use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, UNIX_EPOCH};

/// What `furnace history` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct HistoryArguments {
    /// Runs to tell of, the last ones.
    #[arg(short, long, value_name = "N", default_value_t = 20)]
    number: usize,
    /// Of this core alone, as it was named.
    #[arg(long, value_name = "CORE")]
    core: Option<String>,
    /// Print JSON, one object a run and core.
    #[arg(long)]
    json: bool,
    /// Where runs are [default: reports/runs].
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    #[command(flatten)]
    project: ProjectArguments,
}

pub(crate) fn history(arguments: &HistoryArguments) -> Answer {
    let runs = match &arguments.report {
        Some(runs) => runs.clone(),
        None => arguments.project.find()?.runs(),
    };
    let mut reached = report::reached(&runs);
    if reached.is_empty() {
        let none = format!("{} holds no run that has come to its end", runs.display());
        return Err(Failure::nothing(none));
    }
    if let Some(core) = &arguments.core {
        let cores: BTreeSet<_> = reached.iter().map(|one| one.core.as_str()).collect();
        let cores = cores.iter().copied();
        let meant = hint(core, cores.clone(), || all_of(cores));
        reached.retain(|one| one.core == *core);
        if reached.is_empty() {
            let none = format!("no run in {} has a result of `{core}`", runs.display());
            return Err(Failure::nothing(format!("{none}\nhint: {meant}")));
        }
    }
    let first = reached.len().saturating_sub(arguments.number);
    if arguments.json {
        for one in &reached[first..] {
            say_line!("{}", serde_json::to_string(one).map_err(Failure::broken)?);
        }
    } else {
        tell(&reached, first);
    }
    Ok(ExitCode::Good)
}

fn tell(reached: &[Reached], first: usize) {
    let style = style(Detail::Usual);
    let shown = &reached[first..];
    let width = shown.iter().map(|one| one.core.chars().count()).max().unwrap_or(0).max(4);
    let head =
        format!("  {:<16}  {:width$}  {:>12}  {:>9}  asked", "began, UTC", "core", "pass", "time");
    say_line!("{}", style.paint(Paint::Faint, &head));
    for (number, one) in reached.iter().enumerate().skip(first) {
        let began = UNIX_EPOCH + Duration::from_secs(one.started);
        let began = humantime::format_rfc3339_seconds(began).to_string().replace('T', " ");
        let passes = format!("{} of {}", one.passes, one.graded);
        let paint = if one.passes == one.graded { Paint::Good } else { Paint::Bad };
        let passes = style.paint(paint, &format!("{passes:>12}"));
        let time = duration(one.seconds);
        let core = &one.core;
        let asked = format!("{}{}", one.asked(), since(reached, number));
        say_line!("  {:.16}  {core:width$}  {passes}  {time:>9}  {asked}", began);
    }
    if first > 0 {
        say_line!("  {} before these: `--number N` shows more", count(first, "result"));
    }
}

/// What has changed since the same was asked of this core before.
fn since(reached: &[Reached], number: usize) -> String {
    let one = &reached[number];
    let is_same = |other: &&Reached| other.core == one.core && other.asks_as(one);
    let Some(before) = reached[..number].iter().rev().find(is_same) else { return String::new() };
    let by = one.passes.abs_diff(before.passes);
    match one.passes.cmp(&before.passes) {
        Ordering::Equal => String::new(),
        Ordering::Greater => format!(", {by} more than before"),
        Ordering::Less => format!(", {by} fewer than before"),
    }
}
