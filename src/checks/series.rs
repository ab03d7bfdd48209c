//! The numbers behind a finding that a plot shows: what was counted where, the error at each sample count. Sidecars keep
//! them, so that a report draws them without a core; what a measure already says is not here.

use super::finding::number;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::fmt::Display;
use std::str::FromStr;

/// What one plot shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Series {
    /// Samples of a distribution in cells of the sphere, as χ² has counted them.
    Directions(SphereCounts),
}

/// Samples in cells of the sphere: ring by ring from −z to +z, sector by sector within.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereCounts {
    /// Whose: `the cosine hemisphere`.
    pub(crate) of: String,
    /// Edges of the rings in cos θ, ascending from −1 to 1.
    pub(crate) rings: OneLine<f64>,
    pub(crate) sectors: usize,
    /// Azimuth at which the first sector begins, radians.
    pub(crate) offset: f64,
    /// Samples in each cell.
    pub(crate) observed: OneLine<u64>,
    /// Samples that the pdf promises each cell.
    pub(crate) expected: OneLine<f64>,
    /// Samples that failed, and that should have.
    pub(crate) failed: OneLine<f64>,
    /// Numbers of the cells that are rejected for themselves.
    pub(crate) rejected: OneLine<usize>,
    #[serde(with = "number")]
    pub(crate) chi_square: f64,
    pub(crate) degrees_of_freedom: f64,
    /// What χ² has to exceed to be rejected.
    #[serde(with = "number")]
    pub(crate) critical: f64,
}

/// Many numbers in one line of a sidecar: `12 0.35 NaN`.
#[derive(Clone, Debug, PartialEq)]
pub struct OneLine<T>(Vec<T>);

impl OneLine<f64> {
    /// Keeps five digits of each, which no eye tells from all of them.
    pub(crate) fn rounded(values: impl IntoIterator<Item = f64>) -> Self {
        let rounded = |value: f64| format!("{value:.4e}").parse().unwrap_or(value);
        values.into_iter().map(rounded).collect()
    }
}

impl<T> FromIterator<T> for OneLine<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl<T> std::ops::Deref for OneLine<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T: Display> Serialize for OneLine<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let words: Vec<_> = self.0.iter().map(T::to_string).collect();
        serializer.serialize_str(&words.join(" "))
    }
}

impl<'de, T: FromStr<Err: Display>> Deserialize<'de> for OneLine<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let line = String::deserialize(deserializer)?;
        let number =
            |word: &str| word.parse().map_err(|why| D::Error::custom(format!("`{word}`: {why}")));
        line.split_whitespace().map(number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_survive_one_line_of_json_even_where_they_are_none() {
        let line = OneLine::rounded([0.1 + 0.2, 1e-300, 12_345_678.0, f64::INFINITY, -0.0]);
        let text = serde_json::to_string(&line).unwrap();
        assert_eq!(serde_json::from_str::<OneLine<f64>>(&text).unwrap(), line, "{text}");
        assert_eq!(line[0], 0.3);
        let nan = serde_json::to_string(&OneLine::rounded([f64::NAN])).unwrap();
        assert!(serde_json::from_str::<OneLine<f64>>(&nan).unwrap()[0].is_nan());
        assert!(serde_json::from_str::<OneLine<u64>>("\"1 two\"").is_err());
    }
}
