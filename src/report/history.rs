//! Earlier runs of the same question: the folders beside that of a run, of which `run.json` alone is read.

use super::tree::RunTree;
use crate::run::RunRecord;
use crate::run::record::{CoreRecord, Score, VERSION, read_json};
use crate::stats::Budget;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Runs that are shown, the last ones.
const MOST: usize = 24;

/// The runs of one core that were asked the same, the earliest first, the run itself the last.
pub(crate) struct History {
    pub(crate) core: String,
    pub(crate) runs: Vec<Past>,
}

/// What a core reached in one of them.
pub(crate) struct Past {
    /// Seconds since 1970, UTC.
    pub(crate) started: u64,
    pub(crate) score: Score,
}

/// Of each core of a run.
pub(crate) fn histories(tree: &RunTree) -> Vec<History> {
    let mut runs = beside(&tree.folder);
    runs.retain(|run| asks_the_same(run, &tree.run));
    runs.push(tree.run.clone());
    runs.sort_by_key(|run| run.timing.started);
    let runs = &runs[runs.len().saturating_sub(MOST)..];
    tree.run.cores.iter().map(|core| History::of(&core.spec, runs)).collect()
}

impl History {
    fn of(core: &str, runs: &[RunRecord]) -> Self {
        let past = |run: &RunRecord| {
            let record = run.cores.iter().find(|record| record.spec == core)?;
            Some(Past { started: run.timing.started, score: record.score.clone()? })
        };
        Self { core: core.to_owned(), runs: runs.iter().filter_map(past).collect() }
    }
}

/// Every run that has come to its end beside this one, before it; what is not a run, or of another version, is passed over.
fn beside(folder: &Path) -> Vec<RunRecord> {
    let read = |path: PathBuf| read_json::<RunRecord>(&path.join("run.json")).ok();
    folders_beside(folder).filter_map(read).collect()
}

/// The folders of other runs.
pub(super) fn folders_beside(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = folder.parent().and_then(|runs| std::fs::read_dir(runs).ok());
    let folders = entries.into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    folders.filter(|path| path.file_name() != folder.file_name() && path.join("run.json").is_file())
}

/// Whether two runs can be held against each other: the same cases, as closely looked at.
fn asks_the_same(one: &RunRecord, other: &RunRecord) -> bool {
    let question = |run: &RunRecord| {
        let of_each = run.trials / run.cores.len().max(1);
        (run.filters.clone(), run.suite.clone(), run.budget, run.with, of_each)
    };
    one.version == VERSION
        && one.timing.started <= other.timing.started
        && question(one) == question(other)
}

/// What one core reached in one run, for whoever lists runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Reached {
    /// The folder of the run.
    pub(crate) run: PathBuf,
    /// Seconds since 1970, UTC.
    pub(crate) started: u64,
    /// As the user named it.
    pub(crate) core: String,
    pub(crate) filters: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) suite: Option<String>,
    pub(crate) budget: Budget,
    pub(crate) seed: u64,
    /// Graded trials that pass, and all graded ones.
    pub(crate) passes: usize,
    pub(crate) graded: usize,
    /// Of all its trials, added up.
    pub(crate) seconds: f64,
}

impl Reached {
    /// What was asked, where it was not all as usual.
    pub(crate) fn asked(&self) -> String {
        let cases = match (&self.suite, &self.filters[..]) {
            (Some(suite), _) => format!("suite {suite}"),
            (None, []) => "every case".to_owned(),
            (None, filters) => filters.join(" "),
        };
        let budget = match self.budget == Budget::default() {
            true => String::new(),
            false => format!(", {}", self.budget),
        };
        cases + &budget
    }

    pub(crate) fn asks_as(&self, other: &Self) -> bool {
        let question =
            |one: &Self| (one.filters.clone(), one.suite.clone(), one.budget, one.graded);
        question(self) == question(other)
    }
}

/// Every core of every run below a folder that has come to its end, the earliest first.
pub(crate) fn reached(runs: &Path) -> Vec<Reached> {
    let none = runs.join("none");
    let mut reached: Vec<_> = folders_beside(&none).flat_map(of_run).collect();
    reached.sort_by(|a, b| (a.started, &a.run).cmp(&(b.started, &b.run)));
    reached
}

fn of_run(folder: PathBuf) -> Vec<Reached> {
    let Ok(run) = read_json::<RunRecord>(&folder.join("run.json")) else { return Vec::new() };
    let of = |core: &CoreRecord| {
        let Score { passes, graded, seconds, .. } = core.score.clone()?;
        Some(Reached {
            run: folder.clone(),
            started: run.timing.started,
            core: core.spec.clone(),
            filters: run.filters.clone(),
            suite: run.suite.clone(),
            budget: run.budget,
            seed: run.seed,
            passes,
            graded,
            seconds,
        })
    };
    run.cores.iter().filter_map(of).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::report::example::Example;
    use crate::run::record::Number;

    /// A folder of runs: what passes of 12 on `builtin`, in the order of days.
    pub(crate) fn runs(passes: &[usize]) -> (tempfile::TempDir, RunTree) {
        let folder = tempfile::tempdir().unwrap();
        for (day, passes) in passes.iter().enumerate() {
            let mut example = Example::green();
            example.run.timing.started += 86_400 * day as u64;
            example.run.cores[0].score = Some(Score {
                passes: *passes,
                graded: 12,
                seconds: 10.0 + day as f64,
                numbers: vec![Number {
                    case: "bvh/soup".to_owned(),
                    what: "tests a ray".to_owned(),
                    value: 30.0,
                    more_is_better: false,
                }],
            });
            example.write_records(&folder.path().join(format!("run-{day}")));
        }
        let last = folder.path().join(format!("run-{}", passes.len() - 1));
        let tree = RunTree::load(&last).unwrap();
        (folder, tree)
    }

    #[test]
    fn runs_that_were_asked_the_same_are_told_in_their_order() {
        let (folder, tree) = runs(&[7, 9, 12]);
        let broken = folder.path().join("broken");
        std::fs::create_dir(&broken).unwrap();
        std::fs::write(broken.join("run.json"), "{").unwrap();
        let mut strict = Example::green();
        strict.run.budget = Budget::Strict;
        strict.run.cores[0].score = tree.run.cores[0].score.clone();
        strict.write_records(&folder.path().join("strict"));
        let histories = histories(&tree);
        let passes = |history: &History| {
            history.runs.iter().map(|past| past.score.passes).collect::<Vec<_>>()
        };
        assert_eq!(histories.iter().map(passes).collect::<Vec<_>>(), [vec![7, 9, 12], vec![]]);
    }

    #[test]
    fn all_that_was_reached_is_listed_in_its_order() {
        let (folder, _) = runs(&[7, 9]);
        let reached = reached(folder.path());
        let of_builtin = reached.iter().filter(|one| one.core == "builtin");
        let told = of_builtin.map(|one| (one.passes, one.graded, one.seconds));
        assert_eq!(told.collect::<Vec<_>>(), [(7, 12, 10.0), (9, 12, 11.0)]);
        assert!(super::reached(&folder.path().join("none")).is_empty());
    }

    #[test]
    fn a_report_of_an_old_run_knows_nothing_of_later_ones() {
        let (folder, _) = runs(&[7, 9, 12]);
        let tree = RunTree::load(&folder.path().join("run-1")).unwrap();
        assert_eq!(histories(&tree)[0].runs.len(), 2);
    }
}
