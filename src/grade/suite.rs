//! `suites/<name>.toml`: parts, their points, and which cases each consists of.

use crate::case::{Case, Filter, NothingSelected};
use crate::cores::CoreSpec;
use crate::math::rng::{Seed, shuffle};
use crate::project::Project;
use crate::run::{Plan, Request};
use crate::stats::Budget;
use crate::text::{Diagnostic, Source, all_of, fingerprint, hint};
use serde::{Deserialize, Deserializer};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Suite {
    /// Its file's, without `.toml`.
    #[serde(skip)]
    pub(crate) name: String,
    /// As the user named it.
    #[serde(skip)]
    pub(crate) word: String,
    /// Of its file's text.
    #[serde(skip)]
    pub(crate) hash: String,
    /// What tables and reports call it.
    pub(crate) title: String,
    /// A new one draws other random numbers and other hidden cases.
    pub(crate) version: String,
    #[serde(default)]
    pub(crate) budget: Budget,
    /// What a whole run may take; none: as long as it takes.
    #[serde(default, deserialize_with = "duration")]
    pub(crate) time: Option<Duration>,
    /// Capabilities, or words of a core's own, without which a case is left out and not lost.
    #[serde(default)]
    pub(crate) optional: Vec<String>,
    /// What there are points for, in the order of the table.
    #[serde(rename = "part")]
    pub(crate) parts: Vec<Part>,
    /// How a folder that was handed in becomes a core.
    #[serde(default)]
    pub(crate) build: Option<Build>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Part {
    pub(crate) name: String,
    /// Shared equally by its cases.
    pub(crate) points: f64,
    /// As after `furnace run`.
    pub(crate) cases: Vec<String>,
    /// How many of its cases, drawn by lot, stay hidden until grades are published.
    #[serde(default)]
    pub(crate) hidden: usize,
    #[serde(default)]
    pub(crate) partial: Partial,
    /// Whether what rests on something broken is judged with the bench's own in its place.
    #[serde(default = "yes")]
    pub(crate) transplants: bool,
}

const fn yes() -> bool {
    true
}

/// What a failing case is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Partial {
    /// The share of its rows that pass.
    #[default]
    Rows,
    /// Nothing.
    None,
}

/// The commands by which a submission is built. `{submission}`, `{build}` and `{bench}` stand for folders.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Build {
    /// Programs with their arguments, one after another; `{submission}`, `{build}` and `{bench}` stand for folders.
    pub(crate) commands: Vec<Vec<String>>,
    /// What each of them may take.
    #[serde(default = "ten_minutes", deserialize_with = "short")]
    pub(crate) time: Duration,
    /// The library that they make, below `{build}`, without `.so`, `.dylib` or `.dll`.
    pub(crate) makes: String,
}

/// Why there is no suite to grade by.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SuiteError {
    #[error("there is no suite `{name}`\nhint: {hint}")]
    Unknown { name: String, hint: String },
    #[error("cannot read {path}: {error}")]
    Io { path: PathBuf, error: std::io::Error },
    #[error("{0}")]
    Malformed(Box<Diagnostic>),
    #[error("{path}: part `{part}`: {problem}")]
    Part { path: PathBuf, part: String, problem: String },
}

impl Build {
    /// What a command may take where nobody says otherwise.
    pub(crate) const TIME: Duration = Duration::from_secs(600);
}

const fn ten_minutes() -> Duration {
    Build::TIME
}

fn short<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Duration, D::Error> {
    Ok(duration(deserializer)?.unwrap_or(Build::TIME))
}

fn duration<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Duration>, D::Error> {
    let words = String::deserialize(deserializer)?;
    let wrong = |_| serde::de::Error::custom("not a duration: write \"90 s\" or \"20 min\"");
    humantime::parse_duration(&words).map(Some).map_err(wrong)
}

impl Suite {
    /// A suite of the project or of the bench, or the file of a path that ends in `.toml`.
    pub(crate) fn find(project: &Project, name: &str) -> Result<Self, SuiteError> {
        let suite = Self::read(&Self::file(project, name)?)?;
        Ok(Self { word: name.to_owned(), ..suite })
    }

    fn file(project: &Project, name: &str) -> Result<PathBuf, SuiteError> {
        if Path::new(name).extension().is_some_and(|ending| ending == "toml") {
            return Ok(PathBuf::from(name));
        }
        let folders = project.layers("suites");
        let files = folders.iter().map(|folder| folder.join(format!("{name}.toml")));
        match files.into_iter().find(|file| file.is_file()) {
            Some(file) => Ok(file),
            None => {
                let known = names(&folders);
                let known = || known.iter().map(String::as_str);
                let hint = hint(name, known(), || all_of(known()));
                Err(SuiteError::Unknown { name: name.to_owned(), hint })
            }
        }
    }

    fn read(path: &Path) -> Result<Self, SuiteError> {
        let source =
            Source::read(path).map_err(|error| SuiteError::Io { path: path.to_owned(), error })?;
        let suite: Self =
            source.parse_toml().map_err(|error| SuiteError::Malformed(Box::new(error)))?;
        let wrong = suite.parts.iter().find(|part| !(part.points > 0.0 && part.points.is_finite()));
        if let Some(part) = wrong {
            let (part, problem) = (part.name.clone(), "its points are not positive".to_owned());
            return Err(SuiteError::Part { path: path.to_owned(), part, problem });
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let hash = fingerprint(source.text.as_bytes());
        Ok(Self { name, hash, ..suite })
    }

    /// The cases of each part. A case counts in one part only.
    pub(crate) fn select(&self, cases: &[Arc<Case>]) -> Result<Selected, SuiteError> {
        let mut parts: Vec<Vec<Arc<Case>>> = Vec::new();
        let mut owner: BTreeMap<String, &str> = BTreeMap::new();
        for part in &self.parts {
            let wrong = |problem: String| SuiteError::Part {
                path: PathBuf::from(format!("suites/{}.toml", self.name)),
                part: part.name.clone(),
                problem,
            };
            let nothing = |nothing: NothingSelected| wrong(nothing.to_string());
            let selected = Filter::new(&part.cases).select(cases).map_err(nothing)?;
            for case in &selected {
                if let Some(other) = owner.insert(case.id.clone(), &part.name) {
                    return Err(wrong(format!("`{}` belongs to `{other}` already", case.id)));
                }
            }
            let graded = selected.iter().filter(|case| case.tier.is_graded()).count();
            if graded == 0 || part.hidden > graded {
                return Err(wrong(format!("has {graded} graded cases, {} hidden", part.hidden)));
            }
            parts.push(selected.into_iter().cloned().collect());
        }
        Ok(Selected { parts })
    }

    /// Its cases on a core, with the random numbers of its version and salt.
    pub(crate) fn plan(
        &self,
        project: &Project,
        selected: &Selected,
        salt: &str,
        core: CoreSpec,
        jobs: usize,
    ) -> Result<Plan, NothingSelected> {
        let request = Request {
            cores: vec![core],
            budget: self.budget,
            seed: self.seed(salt),
            jobs,
            ..Request::default()
        };
        let plan = Plan::new(project.clone(), request, &selected.cases())?;
        let plan = plan.of_suite(self.word.clone(), selected.as_they_are(self));
        Ok(plan.salted(salt.to_owned()).within(self.time))
    }

    /// The seed of its random numbers: no other version or salt has the same.
    pub(crate) fn seed(&self, salt: &str) -> Seed {
        Seed::SUITE.child("suite").child(&self.name).child(&self.version).child(salt)
    }

    /// The cases of a part that stay hidden.
    fn hidden(&self, part: &Part, cases: &[Arc<Case>], salt: &str) -> BTreeSet<String> {
        let graded = cases.iter().filter(|case| case.tier.is_graded());
        let mut ids: Vec<_> = graded.map(|case| case.id.clone()).collect();
        ids.sort_unstable();
        shuffle(&mut ids, &mut self.seed(salt).child("hidden").child(&part.name).stream());
        ids.into_iter().take(part.hidden).collect()
    }
}

/// The cases of each part of a suite, in its order.
pub(crate) struct Selected {
    parts: Vec<Vec<Arc<Case>>>,
}

impl Selected {
    pub(crate) fn cases(&self) -> Vec<Arc<Case>> {
        self.parts.iter().flatten().cloned().collect()
    }

    /// The cases of parts without transplants.
    fn as_they_are(&self, suite: &Suite) -> BTreeSet<String> {
        let parts = suite.parts.iter().zip(&self.parts).filter(|(part, _)| !part.transplants);
        parts.flat_map(|(_, cases)| cases).map(|case| case.id.clone()).collect()
    }

    /// Each part with its cases, and which of them are hidden.
    pub(super) fn parts<'a>(
        &'a self,
        suite: &'a Suite,
        salt: &'a str,
    ) -> impl Iterator<Item = (&'a Part, &'a [Arc<Case>], BTreeSet<String>)> {
        let parts = suite.parts.iter().zip(&self.parts);
        parts.map(|(part, cases)| (part, cases.as_slice(), suite.hidden(part, cases, salt)))
    }
}

fn names(folders: &[PathBuf]) -> Vec<String> {
    let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok());
    let paths = entries.flatten().flatten().map(|entry| entry.path());
    let suites = paths.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let names = suites.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()));
    names.collect::<BTreeSet<_>>().into_iter().collect()
}
