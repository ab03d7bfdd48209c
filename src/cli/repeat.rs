//! `furnace run --repeat N`: how often each case passes, with other random numbers each time.

use super::progress::Progress;
use super::report::style;
use super::say::say_line;
use super::{Answer, ExitCode, Failure};
use crate::math::rng::Seed;
use crate::report::RunTree;
use crate::report::text::{Detail, Paint, clean};
use crate::run::{self, Event, Plan, RunError, Status, Tally, TrialRecord};
use crate::text::number::count;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::Path;

/// What became of one case on one core, over all times.
#[derive(Default)]
struct Ends {
    tally: Tally,
    /// Seeds of the runs in which it failed.
    failing: Vec<u64>,
}

/// By core and case.
type Table = BTreeMap<(String, String), Ends>;

/// Runs a plan so often; the first time with its own seed, then with those that follow it. Whatever is found, nothing is
/// diagnosed: each run stands in a folder that `furnace report` reads.
pub(super) fn repeat(mut plan: Plan, runs: &Path, times: NonZeroUsize, quiet: bool) -> Answer {
    let first = plan.request.seed.0;
    plan.searches = false;
    let mut table = Table::new();
    let mut all = Tally::default();
    for seed in (0..times.get() as u64).map(|number| first.wrapping_add(number)) {
        plan.request.seed = Seed(seed);
        let mut progress = Progress::new(quiet);
        let folder = run::run(&plan, runs, &mut |event: Event<'_>| progress.hear(event));
        let folder = folder.map_err(|error| match error {
            RunError::NoCore { .. } => Failure::request(error),
            other => Failure::broken(other),
        })?;
        let tree = RunTree::load(&folder).map_err(Failure::broken)?;
        for trial in tree.trials.iter().filter(|trial| trial.tier.is_graded()) {
            all.add(trial.outcome.status());
            note(&mut table, trial, seed);
        }
    }
    tell(&table, times.get());
    Ok(ExitCode::of(&all, false))
}

fn note(table: &mut Table, trial: &TrialRecord, seed: u64) {
    let ends = table.entry((trial.core.clone(), trial.case.clone())).or_default();
    ends.tally.add(trial.outcome.status());
    if trial.fails_the_core() {
        ends.failing.push(seed);
    }
}

/// What does not always pass, and how much does.
fn tell(table: &Table, times: usize) {
    let style = style(Detail::Usual);
    let passes = |ends: &Ends| ends.tally.count(Status::Pass);
    let is_skipped = |ends: &Ends| ends.tally.count(Status::Skipped) == times;
    let mut others: Vec<_> =
        table.iter().filter(|(_, ends)| passes(ends) < times && !is_skipped(ends)).collect();
    others.sort_by_key(|(_, ends)| passes(ends));
    let width = others.iter().map(|((_, case), _)| case.chars().count()).max().unwrap_or(0);
    say_line!();
    for ((core, case), ends) in &others {
        let often = format!("{:>4} of {times} pass", passes(ends));
        let paint = if ends.failing.is_empty() { Paint::Unknown } else { Paint::Bad };
        let often = style.paint(paint, &often);
        let seeds: Vec<_> =
            ends.failing.iter().take(3).map(|seed| format!("--seed {seed}")).collect();
        let seeds = if seeds.is_empty() {
            String::new()
        } else {
            format!("  fails with {}", seeds.join(", "))
        };
        say_line!("  {often}  {case:width$}  {}{seeds}", clean(core));
    }
    let always = table.values().filter(|ends| passes(ends) == times).count();
    let skipped = table.values().filter(|ends| is_skipped(ends)).count();
    let skipped = if skipped == 0 { String::new() } else { format!(", {skipped} skipped") };
    let of = count(table.len(), "case");
    say_line!("\n  {always} of {of} pass {times} times of {times}{skipped}");
}
