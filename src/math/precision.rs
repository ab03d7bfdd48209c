//! Single or double: what a computation was done in decides how exact it can be.

use serde::{Deserialize, Serialize};

/// The arithmetic a core computes in; tolerances of deterministic checks scale by it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// f32
    Single,
    /// f64
    #[default]
    Double,
}

impl Precision {
    /// The distance from 1 to the next number.
    pub(crate) const fn epsilon(self) -> f64 {
        match self {
            Self::Single => f32::EPSILON as f64,
            Self::Double => f64::EPSILON,
        }
    }
}
