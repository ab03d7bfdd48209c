//! The on-disk contract of a run: `run.json` and one JSON sidecar a trial, both versioned.
//!
//! ```text
//! reports/runs/<run>/run.json                       who, what, when, and what is wrong
//!                   /<core>/<folder>/<claim>.json   one trial
//!                   /<core>/<folder>/<claim>.0.exr  its pictures
//! ```
//!
//! A reader sees all of a file or nothing ([`disk::replace`]). One that meets a version or a word it does not know stops with an error. The same run twice gives the same sidecars but for
//! `timing`.

use super::outcome::{Outcome, Status};
use super::tally::Counts;
use crate::case::{Foundation, Role, Tier};
use crate::checks::series::Series;
use crate::checks::{PictureRole, RejectedCell, number};
use crate::contract::{Circumstances, Components, Conventions, CoreInfo, Precision};
use crate::diagnosis::Diagnosis;
use crate::disk;
use crate::stats::Budget;
use crate::worker::Confinement;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of both files. It changes when something existing does.
pub(crate) const VERSION: u32 = 2;

/// `run.json`: who was asked what, when, on which machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunRecord {
    /// [`VERSION`]
    pub(crate) version: u32,
    pub(crate) furnace: String,
    /// The cores, in the order they were asked.
    pub(crate) cores: Vec<CoreRecord>,
    /// What was selected, as the user typed it.
    pub(crate) filters: Vec<String>,
    /// The suite whose cases these are, as the user named it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) suite: Option<String>,
    /// How much was spent, and so how small an error was looked for.
    pub(crate) budget: Budget,
    pub(crate) seed: u64,
    pub(crate) trials: usize,
    /// What became of them. None while the run has not ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) counts: Option<Counts>,
    /// Whether the run was to stop at the first graded failure. Trials without a sidecar were not run then.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) fail_fast: bool,
    /// What every core was to take from the bench.
    #[serde(default, skip_serializing_if = "Components::is_empty")]
    pub(crate) with: Components,
    pub(crate) machine: Machine,
    pub(crate) timing: RunTiming,
}

impl RunRecord {
    pub(crate) fn is_absent(&self, spec: &str) -> bool {
        self.cores.iter().any(|core| core.spec == spec && core.problem.is_some())
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunTiming {
    /// Seconds since 1970, UTC.
    pub(crate) started: u64,
    /// Wall time of the run so far, seconds; a resumed run adds up. None while it has not ended.
    pub(crate) seconds: Option<f64>,
}

/// A core, as the report shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CoreRecord {
    /// What the user typed after `--core`; also the folder's name.
    pub(crate) spec: String,
    pub(crate) name: String,
    pub(crate) version: String,
    pub(crate) precision: Precision,
    pub(crate) capabilities: Vec<String>,
    /// What it can take from the bench.
    #[serde(default, skip_serializing_if = "Components::is_empty")]
    pub(crate) components: Components,
    /// What it has freely chosen.
    pub(crate) conventions: Conventions,
    /// What the system enforces on it; none for a core that lives in the bench's own process.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) confinement: Option<Confinement>,
    /// Why nothing is known of it, if it died before it said who it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) problem: Option<String>,
    /// What is wrong with it. None while the run has not ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) diagnosis: Option<Diagnosis>,
    /// Which components of the bench mend its failures, if that was tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) transplants: Option<Transplants>,
    /// What later runs are held against. None while the run has not ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) score: Option<Score>,
}

/// What a core has reached in a run, in a few numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Score {
    /// Graded trials that pass.
    pub(crate) passes: usize,
    /// All graded trials.
    pub(crate) graded: usize,
    /// Time of all trials, added up, seconds.
    pub(crate) seconds: f64,
    /// What is worth comparing over runs: tests a ray, a speed-up, an error.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) numbers: Vec<Number>,
}

/// A number of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Number {
    pub(crate) case: String,
    /// What it is, with its unit: `tests a ray, 32768 triangles`.
    pub(crate) what: String,
    #[serde(with = "number")]
    pub(crate) value: f64,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) more_is_better: bool,
}

impl Score {
    /// Of all trials of one core.
    pub(crate) fn of<'a>(trials: impl Iterator<Item = &'a TrialRecord> + Clone) -> Self {
        let graded = || trials.clone().filter(|trial| trial.tier.is_graded());
        let passes = |trial: &&TrialRecord| trial.outcome.status() == Status::Pass;
        Self {
            passes: graded().filter(passes).count(),
            graded: graded().count(),
            seconds: trials.clone().map(|trial| trial.timing.seconds).sum(),
            numbers: trials.clone().flat_map(Number::of).collect(),
        }
    }
}

impl Number {
    fn of(trial: &TrialRecord) -> impl Iterator<Item = Self> {
        let series = trial.outcome.finding().map(|finding| &finding.series);
        let number = |series: &Series| {
            let (what, value) = series.headline()?;
            let more_is_better = series.more_is_better();
            Some(Self { case: trial.case.clone(), what, value, more_is_better })
        };
        series.into_iter().flatten().filter_map(number)
    }
}

impl CoreRecord {
    pub(crate) fn new(spec: &str, info: &CoreInfo) -> Self {
        Self {
            spec: spec.to_owned(),
            name: info.name.clone(),
            version: info.version.clone(),
            precision: info.precision,
            capabilities: info.capabilities.names(),
            components: info.components,
            conventions: info.conventions,
            confinement: None,
            problem: None,
            diagnosis: None,
            transplants: None,
            score: None,
        }
    }

    /// The record of a core that failed to start.
    pub(crate) fn unknown(spec: &str, problem: String) -> Self {
        let (name, precision) = (spec.to_owned(), Precision::Double);
        let info = CoreInfo { name, precision, ..CoreInfo::default() };
        Self { problem: Some(problem), ..Self::new(spec, &info) }
    }
}

/// What taking components from the bench has shown of a core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Transplants {
    /// How many failing cases were tried again.
    pub(crate) failures: usize,
    /// The smallest set of components found, the one that mends the most first.
    pub(crate) components: Vec<Transplanted>,
    /// Failing cases that pass with all of them.
    pub(crate) mended: usize,
    /// Failing cases that fail with everything that the core can take.
    pub(crate) unmended: Vec<String>,
    /// Failing cases of which the time was too short to tell, or that cannot be asked with what mends others.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) untried: usize,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
const fn is_zero(number: &usize) -> bool {
    *number == 0
}

/// One component that mends failures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Transplanted {
    /// It.
    pub(crate) component: Components,
    /// Failing cases that pass with it alone.
    pub(crate) alone: usize,
    /// Failing cases that need it and pass with the whole set.
    pub(crate) together: usize,
    /// Cases above that were judged with it in the run.
    pub(crate) judged: usize,
    /// Failing cases that need it, and nothing above it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) cases: Vec<String>,
}

impl Transplants {
    /// The highest component that a failing case needs so that it passes.
    pub(crate) fn place_of(&self, case: &str) -> Option<Components> {
        let needs = |one: &&Transplanted| one.cases.iter().any(|known| known == case);
        self.components.iter().find(needs).map(|one| one.component)
    }

    /// What has to stand beside the only component that mends nothing alone: what no failure needs for itself.
    pub(crate) fn beside(&self, own: Components) -> Components {
        let mut not_alone = self.components.iter().filter(|one| one.alone == 0 && one.together > 0);
        let is_only = not_alone.next().is_some_and(|one| one.component == own);
        let is_needed = |one: &&Transplanted| one.alone + one.together == 0;
        match (is_only, not_alone.next()) {
            (true, None) => {
                self.components.iter().filter(is_needed).map(|one| one.component).collect()
            }
            _ => Components::empty(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Machine {
    /// `linux`, `macos`, `windows`
    pub(crate) system: String,
    /// `x86_64`, `aarch64`
    pub(crate) architecture: String,
    pub(crate) threads: usize,
}

impl Machine {
    pub(crate) fn this() -> Self {
        Self {
            system: std::env::consts::OS.to_owned(),
            architecture: std::env::consts::ARCH.to_owned(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

/// The sidecar of one trial: one case on one core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialRecord {
    /// [`VERSION`]
    pub version: u32,
    /// Folder and claim: `shape/rays-meet-a-triangle`.
    pub case: String,
    /// The core's specification, as in [`CoreRecord::spec`].
    pub core: String,
    /// The claim in words.
    pub title: String,
    /// What a student should remember.
    pub teaches: String,
    /// Why the expected number is true.
    pub source: String,
    /// The check that judged.
    pub check: String,
    /// What the result counts for.
    #[serde(default)]
    pub tier: Tier,
    /// What the case shows to the rules of the diagnosis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
    /// What it rests on, by its file and its scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) rests_on: Vec<Foundation>,
    /// What is proven where it passes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) proves: Vec<Foundation>,
    /// SHA-256 of the case file's text, hex.
    pub case_hash: String,
    /// The scene it names, if it names one.
    pub scene: Option<SceneStamp>,
    /// What it took from the bench, since its own failed where the case rests on it.
    #[serde(default, skip_serializing_if = "Components::is_empty")]
    pub with: Components,
    /// How much was spent.
    pub budget: Budget,
    /// Seed of this trial.
    pub seed: u64,
    /// How it ended.
    pub outcome: Outcome,
    /// How much the core was asked, in the work of a ray.
    #[serde(default)]
    pub(crate) work: u64,
    /// What was in its scenes and settings.
    #[serde(default, skip_serializing_if = "Circumstances::is_empty")]
    pub(crate) circumstances: Circumstances,
    /// Files beside this one.
    pub pictures: Vec<PictureFile>,
    /// The end of what the core printed, if it lives in a worker and did not pass.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub printed: String,
    /// The command that repeats this trial alone.
    pub rerun: String,
    /// The only part that differs between equal runs.
    pub timing: TrialTiming,
}

impl TrialRecord {
    pub(crate) fn fails_the_core(&self) -> bool {
        self.tier.is_graded() && self.outcome.status().is_failure()
    }
}

/// How much of what a core printed a sidecar keeps, bytes.
const PRINTED: usize = 8 << 10;

impl TrialRecord {
    /// Keeps the end of what the core printed, where somebody will ask for it.
    pub(crate) fn keep_printed(&mut self, printed: &str) {
        let asked_for = !matches!(self.outcome.status(), Status::Pass | Status::Skipped);
        if asked_for {
            let first = printed.len().saturating_sub(PRINTED);
            let start = (first..printed.len()).find(|place| printed.is_char_boundary(*place));
            printed[start.unwrap_or(printed.len())..].clone_into(&mut self.printed);
        }
    }
}

/// Which scene was rendered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneStamp {
    /// File name without `.toml`.
    pub(crate) name: String,
    /// Content hash of the resolved scene, hex.
    pub(crate) hash: String,
    /// The coordinates that the core saw, by those of the scene's file: `[-y, x, z]`. Everything else that is told is as
    /// in the file.
    pub(crate) shown: String,
    /// Whether one of its surfaces is a mirror or smooth glass.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) is_specular: bool,
}

/// How long a trial took.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialTiming {
    /// Wall time, seconds.
    pub seconds: f64,
}

/// A picture of a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureFile {
    /// What it shows.
    pub role: PictureRole,
    /// A few words below it.
    pub caption: String,
    /// File name, in the folder of the sidecar. EXR, linear RGB; with channels `se.R` and so on where the standard
    /// errors are known, `bounce.0.R` and so on of bounces that were rendered alone, `light-sampling.R` and
    /// `hemisphere-sampling.R` of one run by each.
    pub file: String,
    /// Where it is not what it should be, if its check looks at places.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) rejected: Vec<RejectedCell>,
}

/// Why a file of a run could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// An I/O error.
    #[error("{path}: {error}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// The file is not what it should be.
    #[error("{path} is not a file of this version of furnace: {error}")]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What the parser said.
        error: String,
    },
}

/// The file name that no core, case or user can reach out of the folder with.
pub(crate) fn folder_of_core(spec: &str) -> String {
    spec.chars()
        .map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' })
        .collect()
}

/// Where the sidecar of a trial stands in the folder of its run.
pub(crate) fn sidecar_path(run: &Path, core: &str, case: &str) -> PathBuf {
    run.join(folder_of_core(core)).join(format!("{case}.json"))
}

/// Writes `value` as JSON, whole or not at all. Fails on an I/O error.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), RecordError> {
    let failed = |error: std::io::Error| RecordError::Io { path: path.to_owned(), error };
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|error| failed(error.into()))?;
    bytes.push(b'\n');
    disk::replace(path, &bytes).map_err(failed)
}

/// Reads a JSON file of this version.
///
/// # Errors
/// If it cannot be read, or is of another version, or has words that are not known.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, RecordError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| RecordError::Io { path: path.to_owned(), error })?;
    serde_json::from_str(&text)
        .map_err(|error| RecordError::Malformed { path: path.to_owned(), error: error.to_string() })
}
