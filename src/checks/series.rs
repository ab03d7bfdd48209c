//! The numbers behind a finding that a plot shows: what was counted where, the error at each sample count. Sidecars keep
//! them, so that a report draws them without a core; what a measure already says is not here.

use super::finding::number;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::fmt::Display;
use std::str::FromStr;

/// What one plot shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Series {
    /// Samples of a distribution in cells of the sphere, as χ² has counted them.
    Directions(SphereCounts),
    /// How the error falls with the number of samples.
    Convergence(Convergence),
    /// Tests a ray against the size of a mesh.
    TestsBySize(TestsBySize),
    /// How much faster a BVH is than brute force.
    SpeedUp(SpeedUps),
    /// How many samples an adaptive rule has stopped after.
    Stops(StopCounts),
    /// Which share of paths Russian roulette lets get how far.
    Survival(Survival),
}

impl Series {
    /// The one number of it that is worth comparing over runs, with its unit.
    pub(crate) fn headline(&self) -> Option<(String, f64)> {
        match self {
            Self::Convergence(errors) => {
                let (samples, error) = (errors.samples.last()?, errors.error.last()?);
                Some((format!("error / mean luminance, {samples} samples per pixel"), *error))
            }
            Self::TestsBySize(tests) => {
                let (triangles, closest) = (tests.triangles.last()?, tests.closest.last()?);
                Some((format!("tests a ray, {triangles} triangles"), *closest))
            }
            Self::SpeedUp(times) => Some(("times as fast as brute force".to_owned(), times.median)),
            Self::Directions(_) | Self::Stops(_) | Self::Survival(_) => None,
        }
    }

    /// Whether [`Self::headline`] is better where it is larger.
    pub(crate) const fn more_is_better(&self) -> bool {
        matches!(self, Self::SpeedUp(_))
    }
}

/// Errors of pictures, root mean square over pixels and pictures, as shares of the mean luminance that is right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Convergence {
    /// Samples per pixel, growing.
    pub(crate) samples: OneLine<u64>,
    pub(crate) error: OneLine<f64>,
    /// Standard error of each; NaN of one picture alone.
    pub(crate) uncertainty: OneLine<f64>,
    /// How much pictures of so many samples differ from each other: the error without bias.
    pub(crate) noise: OneLine<f64>,
    /// Of what is held to be right; 0 for a closed form.
    #[serde(with = "number")]
    pub(crate) reference_noise: f64,
}

/// Primitives that are tested a ray, in meshes of growing size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TestsBySize {
    /// Triangles of the mesh: what brute force tests.
    pub(crate) triangles: OneLine<u64>,
    /// For the closest hit.
    pub(crate) closest: OneLine<f64>,
    /// For any hit.
    pub(crate) any: OneLine<f64>,
    /// Boxes for the closest hit; 0 where the core does not count them.
    pub(crate) boxes: OneLine<f64>,
    /// A plain median BVH, for the closest hit.
    pub(crate) plain: OneLine<f64>,
}

/// Times of brute force over times with a BVH, for the same rays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpeedUps {
    /// Of each pair of times.
    pub(crate) ratios: OneLine<f64>,
    #[serde(with = "number")]
    pub(crate) median: f64,
    /// 95 % interval of the median.
    #[serde(with = "number::interval")]
    pub(crate) interval: Option<[f64; 2]>,
    pub(crate) at_least: f64,
}

/// Streams by the number of samples that they were stopped after.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StopCounts {
    /// Which streams: `0 or 1 with 10 %`.
    pub(crate) of: String,
    /// Numbers of samples, ascending; left out is what neither came nor should have.
    pub(crate) samples: OneLine<u64>,
    pub(crate) observed: OneLine<u64>,
    pub(crate) expected: OneLine<f64>,
    /// Those of `samples` that are rejected for themselves.
    pub(crate) rejected: OneLine<u64>,
}

/// Shares of paths that bring light at an isolated bounce of a furnace, which are those that roulette has not stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Survival {
    /// Which roulette: `stop 0.3, 1 guaranteed`.
    pub(crate) of: String,
    pub(crate) bounces: OneLine<u32>,
    pub(crate) share: OneLine<f64>,
    /// Ends of the interval of each.
    pub(crate) low: OneLine<f64>,
    pub(crate) high: OneLine<f64>,
    pub(crate) expected: OneLine<f64>,
}

/// Samples in cells of the sphere: ring by ring from −z to +z, sector by sector within.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SphereCounts {
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
pub(crate) struct OneLine<T>(Vec<T>);

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
