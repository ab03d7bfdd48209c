//! What a result counts for.

use serde::{Deserialize, Serialize};

/// What a result counts for.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Tier {
    /// A renderer that fails it is wrong.
    #[default]
    Graded,
    /// Where even textbook code goes wrong: shown, and nothing is held against the core.
    Robustness,
    /// What the contract leaves free, such as noise and time: told, and nothing is held against the core.
    Informational,
}

impl Tier {
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Graded => "graded",
            Self::Robustness => "robustness",
            Self::Informational => "informational",
        }
    }

    /// Whether a failure is held against a core.
    pub const fn is_graded(self) -> bool {
        matches!(self, Self::Graded)
    }
}
