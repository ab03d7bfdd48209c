//! Why a core could not answer. Each variant is the core's own doing and says so.

use super::{Breach, Capabilities};
use std::time::Duration;

/// What every request to a core gives.
pub type Result<T> = std::result::Result<T, CoreError>;

/// Why a core could not answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoreError {
    /// The method's capability was not declared.
    #[error("the core does not support {}", .0.names().join(", "))]
    Unsupported(Capabilities),
    /// This one request is beyond the core, in words: a material it does not know, a bounce range it cannot
    /// isolate. It is skipped, as with a missing capability.
    #[error("beyond the core: {0}")]
    Beyond(String),
    /// The core reported a problem in its own words.
    #[error("the core refused: {0}")]
    Refused(String),
    /// The core answered, but not in the form the contract asks.
    #[error("the core broke the contract: {0}")]
    BrokeContract(Box<Breach>),
    /// The core stopped working while it was answering.
    #[error("the core crashed ({how}) during {during}{}", numbers_of(.element.as_deref()))]
    Crashed {
        /// A signal, an exit code, a panic's message.
        how: String,
        /// The request it was answering.
        during: String,
        /// The one element of its batch that it dies of, if there is one.
        element: Option<Box<Culprit>>,
    },
    /// No answer came in time.
    #[error("no answer within {limit:?} during {during}")]
    TimedOut {
        /// The time it had.
        limit: Duration,
        /// The request it was answering.
        during: String,
    },
}

/// The element of a batch that a core dies of.
#[derive(Clone, Debug, PartialEq)]
pub struct Culprit {
    /// From 0.
    pub(crate) index: usize,
    /// What it is, in numbers.
    pub(crate) numbers: String,
}

/// What follows the request in a sentence.
pub(crate) fn numbers_of(culprit: Option<&Culprit>) -> String {
    culprit.map_or(String::new(), |culprit| format!(": {}", culprit.numbers))
}

impl From<Breach> for CoreError {
    fn from(breach: Breach) -> Self {
        Self::BrokeContract(Box::new(breach))
    }
}

impl CoreError {
    /// An answer that is not what was asked for, in words.
    pub(crate) fn breach(words: impl Into<String>) -> Self {
        Breach::other(words).into()
    }
}
