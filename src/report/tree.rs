//! Loads the folder of a run: `run.json` and the sidecars below it. The only way a report learns anything.
//!
//! A version or a word that is not known, a sidecar in the wrong place, a picture outside the folder: each stops the
//! reading with an error that names the file, for a report of half-understood results would be believed. Not here:
//! pictures, which are read when they are drawn, and whose absence is shown in their place.

use crate::case::Part;
use crate::diagnosis::{Diagnosis, Headline};
use crate::run::record::{self, PictureFile, read_json, sidecar_path};
use crate::run::{self, Counts, RecordError, RunRecord, TrialRecord};
use crate::text::program;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use walkdir::WalkDir;

/// A run, read.
#[derive(Clone, Debug)]
pub struct RunTree {
    /// `run.json`
    pub run: RunRecord,
    /// Every sidecar there is: cores in the order they were asked; of each, cases in the order of parts.
    pub trials: Vec<TrialRecord>,
    /// Where all this stands.
    pub folder: PathBuf,
}

/// A core that was asked for and failed to start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AbsentCore<'a> {
    /// What the user typed after `--core`.
    pub(crate) spec: &'a str,
    pub(crate) problem: &'a str,
    /// A trial that shows it, with what the core printed.
    pub(crate) witness: &'a TrialRecord,
}

/// Why a run has not come to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unfinished {
    /// It stopped at a failure, as it was asked to.
    AtFailure,
    /// The time of its suite was up before the last trial began.
    OutOfTime,
    /// It was cut off between its trials.
    Trials,
    /// It was cut off when all trials had a result, and causes were searched for.
    Causes,
}

impl AbsentCore<'_> {
    /// What tries to bring it up, and nothing else.
    pub(crate) fn command(&self) -> String {
        format!("{} doctor --core {}", program(), shell_words::quote(self.spec))
    }
}

/// Why a folder could not be read as a run.
#[derive(Debug, thiserror::Error)]
pub enum TreeError {
    /// There is no `run.json`.
    #[error("{0} is not the folder of a run: it has no run.json")]
    NotARun(PathBuf),
    /// A file cannot be read, or has words that are not known.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A file of another version.
    #[error(
        "{path} is version {found}, and this furnace reads version {known}\n\
         hint: read it with the furnace that wrote it, or run again"
    )]
    UnknownVersion {
        /// The file.
        path: PathBuf,
        /// What it says.
        found: u32,
        /// What would have been right.
        known: u32,
    },
    /// A file does not belong where it stands.
    #[error("{path} does not belong to this run: {why}\nhint: move it out of the folder")]
    Stray {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        why: String,
    },
    /// An I/O error.
    #[error("cannot read the run{}", in_words(.0))]
    Walk(#[from] walkdir::Error),
}

/// `: reports/runs/a/b: Permission denied`
fn in_words(error: &walkdir::Error) -> String {
    let path = error.path().map(|path| format!(": {}", path.display()));
    let error = error.io_error().map(|error| format!(": {error}"));
    path.into_iter().chain(error).collect()
}

#[derive(Deserialize)]
struct Versioned {
    version: u32,
}

impl RunTree {
    /// Reads the run in `folder`.
    ///
    /// # Errors
    /// If it is not a run, or something in it is not known.
    pub fn load(folder: &Path) -> Result<Self, TreeError> {
        let path = folder.join("run.json");
        if !path.is_file() {
            return Err(TreeError::NotARun(folder.to_owned()));
        }
        check_version(&path)?;
        let run: RunRecord = read_json(&path)?;
        let mut trials = sidecars(folder)?
            .iter()
            .map(|path| load_trial(&run, folder, path))
            .collect::<Result<Vec<_>, _>>()?;
        trials.sort_by_cached_key(|trial| place(&run, trial));
        Ok(Self { run, trials, folder: folder.to_owned() }.diagnosed())
    }

    /// What is wrong with the cores, the likeliest causes of each first.
    pub fn headlines(&self) -> impl Iterator<Item = &Headline> {
        let diagnoses = self.run.cores.iter().filter_map(|core| core.diagnosis.as_ref());
        diagnoses.flat_map(|diagnosis| &diagnosis.headlines)
    }

    /// Diagnoses what a run that was cut off, or one of an earlier furnace, does not say of itself.
    pub(crate) fn diagnosed(mut self) -> Self {
        for core in self.run.cores.iter_mut().filter(|core| core.diagnosis.is_none()) {
            core.diagnosis = Some(run::diagnose(core, &self.trials));
        }
        self
    }

    pub(crate) fn trials_of<'a>(&'a self, spec: &'a str) -> impl Iterator<Item = &'a TrialRecord> {
        self.trials.iter().filter(move |trial| trial.core == spec)
    }

    /// The trials that count for or against a core.
    pub(crate) fn graded(&self) -> impl Iterator<Item = &TrialRecord> {
        self.trials.iter().filter(|trial| trial.tier.is_graded())
    }

    pub(crate) fn counts(&self) -> Counts {
        Counts::of(self.run.trials, &self.trials)
    }

    pub(crate) fn diagnoses(&self) -> Vec<(&str, &Diagnosis)> {
        let cores = self.run.cores.iter();
        cores.filter_map(|core| Some((core.spec.as_str(), core.diagnosis.as_ref()?))).collect()
    }

    /// The cores that failed to start, in the order they were asked.
    pub(crate) fn absent_cores(&self) -> impl Iterator<Item = AbsentCore<'_>> {
        self.run.cores.iter().filter_map(|core| {
            let is_witness = |trial: &&TrialRecord| {
                trial.core == core.spec && trial.outcome.status().is_failure()
            };
            let witness = self.trials.iter().find(is_witness)?;
            Some(AbsentCore { spec: &core.spec, problem: core.problem.as_deref()?, witness })
        })
    }

    /// The same run without cores that failed to start: that is one cause, and no trial of theirs says anything more.
    pub(crate) fn of_present_cores(&self) -> Self {
        let (mut run, mut trials) = (self.run.clone(), self.trials.clone());
        trials.retain(|trial| !self.run.is_absent(&trial.core));
        run.cores.retain(|core| core.problem.is_none());
        run.trials = run.trials.saturating_sub(self.trials.len() - trials.len());
        Self { run, trials, folder: self.folder.clone() }
    }

    pub(crate) fn missing(&self) -> usize {
        self.run.trials.saturating_sub(self.trials.len())
    }

    /// Why the run did not come to its end with a result for every trial, if it did not.
    pub(crate) fn unfinished(&self) -> Option<Unfinished> {
        match (self.missing(), self.run.timing.seconds) {
            (0, Some(_)) => None,
            (0, None) => Some(Unfinished::Causes),
            (_, None) => Some(Unfinished::Trials),
            (_, Some(_)) if self.run.fail_fast => Some(Unfinished::AtFailure),
            // Only suites have a time. A folder that lacks files for another reason is none of ours.
            (_, Some(_)) if self.run.suite.is_some() => Some(Unfinished::OutOfTime),
            (_, Some(_)) => Some(Unfinished::Trials),
        }
    }

    pub(crate) fn is_finished(&self) -> bool {
        self.unfinished().is_none()
    }

    /// The command that goes on with it.
    pub(crate) fn resume(&self) -> String {
        let verb = match &self.run.suite {
            Some(suite) => format!("grade --suite {}", shell_words::quote(suite)),
            None => "run".to_owned(),
        };
        let folder = self.folder.to_string_lossy();
        format!("{} {verb} --resume {}", program(), shell_words::quote(&folder))
    }

    pub(crate) fn picture_path(&self, trial: &TrialRecord, picture: &PictureFile) -> PathBuf {
        sidecar_path(&self.folder, &trial.core, &trial.case).with_file_name(&picture.file)
    }
}

/// Every JSON file below the folders of the cores.
fn sidecars(folder: &Path) -> Result<Vec<PathBuf>, TreeError> {
    let mut found = Vec::new();
    for entry in WalkDir::new(folder).min_depth(2).sort_by_file_name() {
        let entry = entry?;
        let is_json = entry.path().extension().is_some_and(|extension| extension == "json");
        if entry.file_type().is_file() && is_json {
            found.push(entry.into_path());
        }
    }
    Ok(found)
}

fn load_trial(run: &RunRecord, folder: &Path, path: &Path) -> Result<TrialRecord, TreeError> {
    check_version(path)?;
    let trial: TrialRecord = read_json(path)?;
    match misplaced(run, folder, path, &trial) {
        Some(why) => Err(TreeError::Stray { path: path.to_owned(), why }),
        None => Ok(trial),
    }
}

/// Looks at the version alone, so that a file of another one is called that and not malformed.
fn check_version(path: &Path) -> Result<(), TreeError> {
    let Versioned { version: found } = read_json(path)?;
    if found == record::VERSION {
        return Ok(());
    }
    Err(TreeError::UnknownVersion { path: path.to_owned(), found, known: record::VERSION })
}

fn misplaced(run: &RunRecord, folder: &Path, path: &Path, trial: &TrialRecord) -> Option<String> {
    if !run.cores.iter().any(|core| core.spec == trial.core) {
        return Some(format!("run.json names no core `{}`", trial.core));
    }
    if sidecar_path(folder, &trial.core, &trial.case) != path {
        return Some(format!("its contents are about `{}` on `{}`", trial.case, trial.core));
    }
    let outside = trial.pictures.iter().find(|picture| !is_file_name(&picture.file))?;
    Some(format!("its image `{}` is not a file beside it", outside.file))
}

/// Whether `name` stays in the folder that it is joined to.
fn is_file_name(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|last| last == name)
}

/// By core, then by part and folder, then by name.
fn place(run: &RunRecord, trial: &TrialRecord) -> (usize, usize, String) {
    let core = run.cores.iter().position(|core| core.spec == trial.core);
    (core.unwrap_or(usize::MAX), Part::position(&trial.case), trial.case.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example::{self, Example};
    use crate::run::record::write_json;
    use tempfile::TempDir;

    /// The folder of [`Example::mixed`].
    fn mixed() -> TempDir {
        let folder = tempfile::tempdir().unwrap();
        Example::mixed().write_records(folder.path());
        folder
    }

    fn sidecar(folder: &TempDir) -> PathBuf {
        sidecar_path(folder.path(), "builtin", example::FAILING)
    }

    /// The message with which the folder is refused.
    fn refusal(folder: &Path) -> String {
        RunTree::load(folder).unwrap_err().to_string()
    }

    fn edit(path: &Path, from: &str, to: &str) {
        let text = std::fs::read_to_string(path).unwrap();
        assert!(text.contains(from), "{from} is not in {text}");
        std::fs::write(path, text.replace(from, to)).unwrap();
    }

    #[test]
    fn a_run_reads_back_in_the_order_of_cores_and_parts() {
        let folder = mixed();
        let tree = RunTree::load(folder.path()).unwrap();
        assert_eq!(tree.trials.len(), tree.run.trials);
        assert!(tree.is_finished());
        let places: Vec<_> = tree.trials.iter().map(|trial| place(&tree.run, trial)).collect();
        assert!(places.is_sorted());
    }

    #[test]
    fn a_killed_run_says_how_much_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let mut example = Example::mixed();
        example.run.timing.seconds = None;
        example.trials.truncate(3);
        example.write_records(folder.path());
        let tree = RunTree::load(folder.path()).unwrap();
        assert_eq!(tree.missing(), tree.run.trials - 3);
        assert!(!tree.is_finished());
    }

    #[test]
    fn a_run_that_says_what_is_wrong_is_believed_and_any_other_is_diagnosed() {
        let folder = tempfile::tempdir().unwrap();
        let mut example = Example::mixed();
        let said = Diagnosis { unexplained: vec!["as/it-was".to_owned()], ..Default::default() };
        example.run.cores[0].diagnosis = Some(said.clone());
        example.write_records(folder.path());
        let tree = RunTree::load(folder.path()).unwrap();
        let [(_, builtin), (_, textbook)] = tree.diagnoses()[..] else { panic!("two cores") };
        assert_eq!(*builtin, said);
        assert!(textbook.unexplained.contains(&"shape/the-nearer-root-wins".to_owned()));
    }

    #[test]
    fn a_folder_without_a_run_is_called_that() {
        let folder = tempfile::tempdir().unwrap();
        assert!(refusal(folder.path()).contains("has no run.json"));
    }

    #[test]
    fn another_version_is_refused_by_name_whatever_else_it_holds() {
        let folder = mixed();
        let path = sidecar(&folder);
        edit(&path, "\"version\": 2", "\"version\": 3, \"novelty\": 3");
        let message = refusal(folder.path());
        assert!(message.contains(&path.display().to_string()), "{message}");
        assert!(message.contains("version 3"), "{message}");
    }

    #[test]
    fn an_unknown_word_is_refused_and_the_file_named() {
        let folder = mixed();
        let path = sidecar(&folder);
        edit(&path, "\"kind\": \"judged\"", "\"kind\": \"waved-through\"");
        let message = refusal(folder.path());
        assert!(message.contains(&path.display().to_string()), "{message}");
        assert!(message.contains("waved-through"), "{message}");
    }

    #[test]
    fn a_sidecar_in_the_wrong_place_is_refused() {
        let folder = mixed();
        let path = sidecar(&folder);
        std::fs::copy(&path, path.with_file_name("other.json")).unwrap();
        assert!(refusal(folder.path()).contains("other.json does not belong"));
    }

    #[test]
    fn a_core_that_was_not_asked_is_refused() {
        let folder = mixed();
        let mut run = Example::mixed().run;
        run.cores.truncate(1);
        write_json(&folder.path().join("run.json"), &run).unwrap();
        assert!(refusal(folder.path()).contains("names no core `textbook`"));
    }

    #[test]
    fn a_picture_cannot_reach_out_of_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let mut example = Example::mixed();
        let pictures = example.trials.iter_mut().flat_map(|trial| &mut trial.pictures);
        pictures.for_each(|picture| picture.file = "../../../elsewhere.exr".to_owned());
        example.write_records(folder.path());
        assert!(refusal(folder.path()).contains("is not a file beside it"));
    }
}
