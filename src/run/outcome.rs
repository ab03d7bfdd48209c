//! How a trial ended. Absence of evidence is never success: each way of not being judged has its own name.

use crate::case::Foundation;
use crate::checks::{CheckError, Finding, breach};
use crate::contract::{Capabilities, CoreError, numbers_of};
use crate::stats::Verdict;
use serde::{Deserialize, Serialize};

/// How a trial ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Outcome {
    /// The check came to a finding.
    Judged {
        /// What it found.
        finding: Finding,
    },
    /// The core lacks what the check needs.
    Skipped {
        /// The capabilities it lacks, or else what is beyond it.
        missing: Vec<String>,
    },
    /// What the case rests on failed, so that its own failure would say nothing.
    Blocked {
        /// The case that failed.
        by: String,
    },
    /// The core gave no answer, and said why.
    Refused {
        /// In its own words.
        why: String,
    },
    /// The core stopped working.
    Crashed {
        /// A signal, an exit code, a panic's message.
        how: String,
        /// The request it was answering.
        during: String,
    },
    /// The core did not answer in time.
    TimedOut {
        /// The time it had, seconds.
        limit: f64,
        /// The request it was answering.
        during: String,
    },
    /// The case's or the harness's own fault: nothing is known about the core.
    Broken {
        /// What is wrong, and what to do.
        why: String,
    },
}

/// The few words by which reports, counts and exit codes know an outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Judged: pass.
    Pass,
    /// Judged: fail.
    Fail,
    /// Judged: the budget did not suffice.
    Inconclusive,
    /// The core lacks a capability.
    Skipped,
    /// What it rests on failed.
    Blocked,
    /// The core stopped working.
    Crashed,
    /// The core did not answer in time.
    TimedOut,
    /// The case's or the harness's own fault.
    Broken,
}

impl Status {
    /// Every status, the good one first.
    pub(crate) const ALL: [Status; 8] = [
        Status::Pass,
        Status::Fail,
        Status::Inconclusive,
        Status::Skipped,
        Status::Blocked,
        Status::Crashed,
        Status::TimedOut,
        Status::Broken,
    ];

    /// As people read it.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::Skipped => "skipped",
            Self::Blocked => "blocked",
            Self::Crashed => "crashed",
            Self::TimedOut => "timed out",
            Self::Broken => "broken",
        }
    }

    pub(crate) const fn is_failure(self) -> bool {
        matches!(self, Self::Fail | Self::Crashed | Self::TimedOut)
    }
}

impl From<Verdict> for Status {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Pass => Self::Pass,
            Verdict::Fail => Self::Fail,
            Verdict::Inconclusive => Self::Inconclusive,
        }
    }
}

impl Outcome {
    /// The outcome of a check that ran, or did not come to its end.
    pub(crate) fn of(result: Result<Finding, CheckError>) -> Self {
        match result {
            Ok(finding) => Self::Judged { finding },
            Err(CheckError::Broken(why)) => Self::Broken { why },
            Err(CheckError::Core(error)) => Self::of_core_error(error),
        }
    }

    /// A core that answers wrongly in form, or refuses, has been judged: it fails.
    fn of_core_error(error: CoreError) -> Self {
        match error {
            CoreError::Unsupported(missing) => Self::Skipped { missing: missing.names() },
            CoreError::Beyond(what) => Self::Skipped { missing: vec![what] },
            CoreError::Crashed { how, during, element } => {
                Self::Crashed { how, during: format!("{during}{}", numbers_of(element.as_deref())) }
            }
            CoreError::TimedOut { limit, during } => {
                Self::TimedOut { limit: limit.as_secs_f64(), during }
            }
            CoreError::Refused(why) => Self::Refused { why },
            CoreError::BrokeContract(breach) => Self::Judged { finding: breach::failure(&breach) },
        }
    }

    /// The one word for it.
    pub fn status(&self) -> Status {
        match self {
            Self::Judged { finding } => finding.verdict.into(),
            Self::Skipped { .. } => Status::Skipped,
            Self::Blocked { .. } => Status::Blocked,
            Self::Refused { .. } => Status::Fail,
            Self::Crashed { .. } => Status::Crashed,
            Self::TimedOut { .. } => Status::TimedOut,
            Self::Broken { .. } => Status::Broken,
        }
    }

    /// One sentence for lists and messages.
    pub fn statement(&self) -> String {
        match self {
            Self::Judged { finding } => finding.statement.clone(),
            Self::Skipped { missing } => match Capabilities::from_names(missing) {
                Ok(_) => format!("the core has no {}", missing.join(", ")),
                // In its own words.
                Err(_) => format!("unsupported by the core: {}", missing.join(", ")),
            },
            Self::Blocked { by } => format!("{by} failed, and this rests on it"),
            Self::Refused { why } => CoreError::Refused(why.clone()).to_string(),
            Self::Crashed { how, during } => format!("the core crashed ({how}) during {during}"),
            Self::TimedOut { limit, during } => format!("no answer in {limit} s during {during}"),
            Self::Broken { why } => why.clone(),
        }
    }

    /// Whether a case that proves these foundations found them broken. A renderer that dies on its way, or whose picture has
    /// not the contract's form, says nothing of its random numbers, and all that is judged by a mean rests on them: they
    /// have to be measured.
    pub(super) fn breaks(&self, proven: &[Foundation]) -> bool {
        match proven {
            [Foundation::Seeds] => {
                self.finding().is_some_and(|finding| finding.failed_measures().next().is_some())
            }
            _ => self.status().is_failure(),
        }
    }

    /// The finding, if the check came to one.
    pub fn finding(&self) -> Option<&Finding> {
        match self {
            Self::Judged { finding } => Some(finding),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_contract_is_a_failure_of_the_core() {
        let error = CoreError::breach("its picture has 8 pixels");
        assert_eq!(Outcome::of(Err(error.into())).status(), Status::Fail);
    }

    #[test]
    fn a_missing_reference_is_broken_not_failed() {
        let outcome = Outcome::of(Err(CheckError::Broken("no reference".into())));
        assert_eq!(outcome.status(), Status::Broken);
        assert!(!outcome.status().is_failure());
    }

    #[test]
    fn an_unsupported_request_is_skipped() {
        let error = CoreError::Unsupported(Capabilities::RENDER);
        assert_eq!(Outcome::of(Err(error.into())).status(), Status::Skipped);
        let error = CoreError::Beyond("a sky".to_owned());
        let skipped = Outcome::Skipped { missing: vec!["a sky".to_owned()] };
        assert_eq!(Outcome::of(Err(error.into())), skipped);
        assert_eq!(skipped.statement(), "unsupported by the core: a sky");
    }
}
