//! What the rows of a case would be if a known mistake had been made: `mistaken = { no-shadows = [1, 2, 3] }`. The
//! mistake that predicts every row of a failing case is left as a clue. A row that does not name it is right with it.

use crate::cause::{self, Cause};
use crate::checks::Measure;
use crate::text::{Colour, did_you_mean};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

/// How far a number without noise may be from what a mistake predicts, relative.
const SAME: f64 = 1e-4;

/// Radiances by the name of the mistake that gives them.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(transparent)]
pub struct Mistaken(BTreeMap<String, Colour>);

impl Mistaken {
    /// What is wrong with it.
    ///
    /// # Errors
    /// If a name is not in the glossary.
    pub fn validate(&self) -> Result<(), String> {
        let unknown = self.0.keys().find(|name| cause::find(name).is_none());
        unknown.map_or(Ok(()), |name| {
            let names = cause::all().map(|cause| cause.name);
            let hint = did_you_mean(name, names).unwrap_or_default();
            Err(format!("`{name}` is no cause of the glossary; {hint}"))
        })
    }
}

/// A row and what was measured of it.
pub struct Measured<'a> {
    /// What mistakes make of it.
    pub mistaken: &'a Mistaken,
    /// What is right.
    pub right: [f64; 3],
    /// Channels that are not dark, or all three of a dark row.
    pub measures: Vec<(usize, &'a Measure)>,
}

impl Measured<'_> {
    fn is_predicted_by(&self, name: &str) -> bool {
        let predicted = self.mistaken.0.get(name).map_or(self.right, |colour| colour.0);
        self.measures.iter().all(|(channel, measure)| admits(measure, predicted[*channel]))
    }
}

/// Whether a measure is what was predicted, but for noise. Where darkness is asked for, the brightest sample was
/// measured, and any light will do.
fn admits(measure: &Measure, predicted: f64) -> bool {
    match measure.interval {
        Some([low, high]) => {
            low - measure.allowed <= predicted && predicted <= high + measure.allowed
        }
        None if measure.expected == 0.0 => (measure.measured > 0.0) == (predicted > 0.0),
        None => (measure.measured - predicted).abs() <= SAME * predicted.abs(),
    }
}

/// The mistakes that predict every row.
pub fn explanations(rows: &[Measured<'_>]) -> Vec<&'static Cause> {
    let named: BTreeSet<_> = rows.iter().flat_map(|row| row.mistaken.0.keys()).collect();
    let predicts = |name: &&String| rows.iter().all(|row| row.is_predicted_by(name));
    named.into_iter().filter(predicts).filter_map(|name| cause::find(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mistaken(words: &str) -> Mistaken {
        toml::from_str(words).unwrap()
    }

    #[test]
    fn names_come_from_the_glossary() {
        assert!(mistaken("no-shadows = 1").validate().is_ok());
        let error = mistaken("no-shadow = 1").validate().unwrap_err();
        assert!(error.contains("did you mean `no-shadows`?"), "{error}");
    }

    #[test]
    fn a_mistake_has_to_predict_every_row() {
        let (lit, dark) = (mistaken("no-shadows = 2"), mistaken("no-shadows = 1"));
        let told = |bright: f64, hidden: f64| {
            let bright = Measure {
                interval: Some([bright - 0.1, bright + 0.1]),
                ..Measure::exact("bright", bright, 1.0, 0.001)
            };
            let hidden = Measure::exact("hidden", hidden, 0.0, 0.0);
            let row = |mistaken, right, measure| Measured {
                mistaken,
                right,
                measures: vec![(0, measure)],
            };
            let rows = [row(&lit, [1.0; 3], &bright), row(&dark, [0.0; 3], &hidden)];
            !explanations(&rows).is_empty()
        };
        assert!(told(2.05, 7.0));
        assert!(!told(2.05, 0.0), "the hidden row is dark");
        assert!(!told(1.5, 7.0), "the bright row is something else");
    }
}
