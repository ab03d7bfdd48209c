//! What an earlier run has kept of a trial, if its folder still stands beside that of this run.

use super::history::folders_beside;
use super::tree::RunTree;
use crate::run::record::{PictureFile, read_json, sidecar_path};
use crate::run::{RunRecord, Status, TrialRecord};
use std::path::{Path, PathBuf};

/// Runs that are looked through, the last ones.
const MOST: usize = 24;

/// The same case on the same core, in an earlier run.
pub(crate) struct Earlier {
    pub(crate) trial: TrialRecord,
    folder: PathBuf,
}

impl Earlier {
    /// The last one that passed, or else the last one.
    pub(crate) fn of(tree: &RunTree, trial: &TrialRecord) -> Option<Self> {
        let mut tries = before(&tree.folder).into_iter().filter_map(|run| Self::read(run, trial));
        let last = tries.next()?;
        let passes = |one: &Self| one.trial.outcome.status() == Status::Pass;
        if passes(&last) { Some(last) } else { Some(tries.find(passes).unwrap_or(last)) }
    }

    /// None where that run did not try it, or of another scene.
    fn read(folder: PathBuf, trial: &TrialRecord) -> Option<Self> {
        let path = sidecar_path(&folder, &trial.core, &trial.case);
        let earlier: TrialRecord = read_json(&path).ok()?;
        let hash = |trial: &TrialRecord| trial.scene.as_ref().map(|scene| scene.hash.clone());
        (hash(&earlier) == hash(trial)).then_some(Self { trial: earlier, folder })
    }

    /// Seconds since 1970, UTC.
    pub(crate) fn started(&self) -> Option<u64> {
        let run: RunRecord = read_json(&self.folder.join("run.json")).ok()?;
        Some(run.timing.started)
    }

    pub(crate) fn path(&self, file: &PictureFile) -> PathBuf {
        let sidecar = sidecar_path(&self.folder, &self.trial.core, &self.trial.case);
        sidecar.with_file_name(&file.file)
    }
}

/// The folders of earlier runs, the last one first: their names say when they began.
fn before(folder: &Path) -> Vec<PathBuf> {
    let is_before = |path: &PathBuf| path.file_name() < folder.file_name();
    let mut runs: Vec<_> = folders_beside(folder).filter(is_before).collect();
    runs.sort();
    runs.reverse();
    runs.truncate(MOST);
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example::Example;

    const CASE: &str = "image/cornell-spheres";

    /// A run of every example beside the others, in their order, and what the last finds of the case.
    fn found(runs: &[Example]) -> Option<(String, Status)> {
        let folder = tempfile::tempdir().unwrap();
        let named = |number: usize| folder.path().join(format!("run-{number}"));
        runs.iter().enumerate().for_each(|(number, run)| run.write_records(&named(number)));
        let tree = RunTree::load(&named(runs.len() - 1)).unwrap();
        let trial = tree.trials_of("builtin").find(|trial| trial.case == CASE).unwrap();
        let earlier = Earlier::of(&tree, trial)?;
        assert!(earlier.started().is_some());
        let name = earlier.folder.file_name()?.to_string_lossy().into_owned();
        Some((name, earlier.trial.outcome.status()))
    }

    #[test]
    fn the_last_pass_is_found_or_else_the_last_try() {
        assert_eq!(found(&[Example::green()]), None);
        let runs = [Example::green(), Example::green(), Example::mixed(), Example::mixed()];
        assert_eq!(found(&runs), Some(("run-1".to_owned(), Status::Pass)));
        let runs = [Example::mixed(), Example::mixed(), Example::mixed()];
        assert_eq!(found(&runs), Some(("run-1".to_owned(), Status::Fail)));
    }

    #[test]
    fn an_image_of_another_scene_is_no_earlier_one() {
        let mut other = Example::green();
        other.trials.retain(|trial| trial.case == CASE);
        other.trials.iter_mut().filter_map(|trial| trial.scene.as_mut()).for_each(|scene| {
            scene.hash = "another".to_owned();
        });
        assert_eq!(found(&[other, Example::green()]), None);
    }
}
