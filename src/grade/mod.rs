//! From a run to points: what a suite asks, and what it is worth.
//!
//! A [`Suite`] is a file: parts with points, and the cases of each. A [`Grade`] is a pure function of a suite and the
//! folder of a run, and each format in which it is told (`text`, `gradescope`, `junit`, `github`, `csv`) a pure function of
//! a grade. Where a submission was built, what the compiler warned of is added. Verdicts are the run's: nothing is judged
//! here. What each verdict is worth stands in `score`, and for teachers in `docs/book/src/grading.md`.

pub(crate) mod class;
pub(crate) mod csv;
pub(crate) mod github;
pub(crate) mod gradescope;
pub(crate) mod junit;
mod markdown;
mod score;
mod submission;
mod suite;
pub(crate) mod text;
mod warning;

pub(crate) use submission::{Built, NoCore, Submission, Workshop};
pub(crate) use suite::{Suite, SuiteError};
pub use warning::Warning;

use crate::diagnosis::Degree;
use serde::{Deserialize, Serialize};

/// The variable with a secret by which a grader's scenes are moved, so that nobody has seen them. No core is told it,
/// no build, and no result.
pub(crate) const SALT_VARIABLE: &str = "FURNACE_SALT";

/// What a core has earned of a suite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grade {
    /// Of this format.
    pub version: u32,
    /// The suite's file name without `.toml`.
    pub suite: String,
    /// Another one draws other random numbers.
    pub suite_version: String,
    /// The suite in words.
    pub title: String,
    /// As the user typed it.
    pub core: String,
    /// Of all parts.
    pub points: Points,
    /// In the order of the suite.
    pub parts: Vec<PartGrade>,
    /// What is wrong, as far as it does not tell of hidden cases.
    pub causes: Vec<Told>,
    /// What a compiler warned of where a submission was built.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// Numbers that cores are compared by.
    pub leaderboard: Vec<Entry>,
    /// Why the core could not be asked at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// Of the run, wall time; none where it was cut off.
    pub seconds: Option<f64>,
}

/// Of the format of a [`Grade`] as JSON.
pub(crate) const VERSION: u32 = 2;

/// What can be earned, and what became of it. What is neither earned nor open is lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Points {
    /// All that can be earned.
    pub of: f64,
    /// Proven.
    pub earned: f64,
    /// Neither proven right nor proven wrong: not earned, and somebody may decide.
    pub open: f64,
}

/// A part of a suite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartGrade {
    /// As the suite has it.
    pub name: String,
    /// Of all its cases.
    pub points: Points,
    /// Those that are graded.
    pub cases: Vec<CaseGrade>,
}

/// A case of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseGrade {
    /// Folder and claim.
    pub case: String,
    /// The claim in words.
    pub title: String,
    /// What a student should keep in mind.
    pub teaches: String,
    /// What became of it.
    pub standing: Standing,
    /// Nothing can be earned where it does not count for this core.
    pub points: Points,
    /// Not to be told before grades are published.
    pub hidden: bool,
    /// How many of its rows pass, of how many.
    pub rows: [usize; 2],
    /// Components that were the bench's own, since the core's failed elsewhere.
    pub with: Vec<String>,
    /// What was found, in a sentence.
    pub statement: String,
    /// The command that repeats it.
    pub rerun: String,
    /// Wall time.
    pub seconds: f64,
}

/// How a case stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// Proven right.
    Pass,
    /// Proven wrong.
    Fail,
    /// Neither.
    Inconclusive,
    /// The core lacks what is asked for.
    Missing,
    /// The core lacks what the suite does not ask for, or the contract leaves it free: it does not count.
    LeftOut,
    /// What it rests on failed.
    Blocked,
    /// The core stopped working.
    Crashed,
    /// The core did not answer in time.
    TimedOut,
    /// The case's or the bench's own fault.
    Broken,
    /// The time of the suite was up.
    NotTried,
}

impl Standing {
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::Missing => "missing",
            Self::LeftOut => "left out",
            Self::Blocked => "blocked",
            Self::Crashed => "crashed",
            Self::TimedOut => "timed out",
            Self::Broken => "broken",
            Self::NotTried => "not tried",
        }
    }
}

/// A headline of the diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Told {
    /// Its name in the glossary; empty where there is none.
    pub cause: String,
    /// How sure that is. What merely differs is a place, and no cause.
    pub degree: Degree,
    /// In a sentence.
    pub mistake: String,
    /// What was seen.
    pub evidence: Vec<String>,
    /// Where in a path tracer.
    pub look_at: String,
    /// What to do about it.
    pub fix: String,
    /// What repeats it.
    pub command: String,
    /// The failing cases that it explains.
    pub explains: Vec<String>,
}

/// A number that cores are compared by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// What it is, with its unit.
    pub name: String,
    /// It.
    pub value: f64,
    /// Whether more is better.
    pub more_is_better: bool,
}

impl Told {
    /// The mistake, or what it looks like, or what differs.
    pub(crate) fn in_words(&self) -> String {
        match self.degree {
            Degree::Named => self.mistake.clone(),
            Degree::LooksLike => format!("looks like: {}", self.mistake),
            Degree::DiffersHere => format!("{}; no cause is known", self.mistake),
        }
    }
}

impl Points {
    fn and(self, other: Self) -> Self {
        Self {
            of: self.of + other.of,
            earned: self.earned + other.earned,
            open: self.open + other.open,
        }
    }

    /// Whether something was proven wrong or missing.
    pub(crate) fn are_lost(self) -> bool {
        self.of - self.earned - self.open > 1e-9
    }

    /// `18.3 of 20`, and what is open.
    pub(crate) fn words(self) -> String {
        let open = match hundredths(self.open) {
            open if open > 0.0 => format!(", {open} open"),
            _ => String::new(),
        };
        format!("{} of {}{open}", hundredths(self.earned), hundredths(self.of))
    }
}

/// Points as they are told.
pub(crate) fn hundredths(points: f64) -> f64 {
    (points * 100.0).round() / 100.0
}

impl Grade {
    pub(crate) fn cases(&self) -> impl Iterator<Item = (&PartGrade, &CaseGrade)> {
        self.parts.iter().flat_map(|part| part.cases.iter().map(move |case| (part, case)))
    }

    pub(crate) fn count(&self, standing: Standing) -> usize {
        self.cases().filter(|(_, case)| case.standing == standing).count()
    }
}

#[cfg(test)]
mod tests;
