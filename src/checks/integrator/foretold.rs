//! What known mistakes would give in place of what is right, as a case foretells it.

use crate::cause::{self, Cause};
use crate::checks::Measure;
use crate::checks::phrase::figure;
use crate::math::ratios::names_of;
use crate::stats::Band;
use crate::text::{Colour, did_you_mean};
use serde::Deserialize;

/// `{ cause = "delta-divided", gives = [0.5, 0.25] }`: one colour for each row of the case.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct MistakeEntry {
    /// Its name in the glossary.
    cause: String,
    /// What each row would be.
    gives: Vec<Colour>,
}

impl MistakeEntry {
    /// What is wrong with it, in a case of so many rows.
    pub(crate) fn validate(&self, rows: usize) -> Result<(), String> {
        if cause::find(&self.cause).is_none() {
            let known = did_you_mean(&self.cause, cause::all().map(|cause| cause.name));
            let hint = known.map_or_else(String::new, |hint| format!("; {hint}"));
            return Err(format!("there is no cause `{}` in the glossary{hint}", self.cause));
        }
        match self.gives.len() == rows {
            true => Ok(()),
            false => Err(format!("mistake `{}` needs a colour for each row", self.cause)),
        }
    }

    /// The cause and what speaks for it, if something is wrong and every number of every row is as foretold.
    pub(crate) fn explains(&self, rows: &[Vec<Measure>]) -> Option<(&'static Cause, String)> {
        let measures = || {
            let of_row = |(row, Colour(colour)): (&'_ Vec<Measure>, &Colour)| {
                let pair = |m: &Measure| Some((m.clone(), colour[m.channel?.index()]));
                row.iter().filter_map(pair).collect::<Vec<_>>()
            };
            rows.iter().zip(&self.gives).flat_map(of_row)
        };
        let (worst, foretold) = measures().find(|(measure, _)| measure.failed())?;
        let all = measures().count();
        if !measures().all(|(measure, foretold)| is_foretold(&measure, foretold)) {
            return None;
        }
        let (would, right) = (figure(foretold), figure(worst.expected));
        let evidence =
            format!("foretells all {all} numbers; {}: {would} instead of {right}", worst.name());
        Some((cause::find(&self.cause)?, evidence))
    }
}

/// Whether a number is what was foretold, and known well enough to say so. Of a row that has to be dark only the
/// largest sample is known.
fn is_foretold(measure: &Measure, foretold: f64) -> bool {
    const NAME: &str = "as foretold";
    let expected = measure.expected;
    if expected == 0.0 {
        return measure.failed() == (foretold > 0.0);
    }
    let slack = Band::RADIANCE.relative() * foretold;
    let [low, high] = measure.interval.unwrap_or([measure.measured; 2]);
    let ratio = [(low - slack) / expected, (high + slack) / expected];
    let names = names_of(ratio, &[(foretold / expected, NAME)]);
    names.iter().any(|ratio| ratio.name == NAME)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Channel;

    fn entry(cause: &str, gives: &[f64]) -> MistakeEntry {
        let gives = gives.iter().map(|value| Colour([*value; 3])).collect();
        MistakeEntry { cause: cause.to_owned(), gives }
    }

    fn row(measured: f64, half_width: f64) -> Vec<Measure> {
        let interval = Some([measured - half_width, measured + half_width]);
        let right = Measure::exact("a row", measured, 1.0, 0.01).of_channel(Channel::Red);
        vec![Measure { interval, ..right }]
    }

    #[test]
    fn what_is_foretold_in_every_row_is_explained() {
        let mistake = entry("divided-by-lights", &[0.5, 1.0]);
        let (cause, evidence) = mistake.explains(&[row(0.501, 0.01), row(1.0, 0.01)]).unwrap();
        assert_eq!(cause.name, "divided-by-lights");
        assert_eq!(evidence, "foretells all 2 numbers; a row, red: 0.5 instead of 1");
        assert!(mistake.explains(&[row(0.501, 0.01), row(1.1, 0.01)]).is_none());
    }

    #[test]
    fn nothing_wrong_and_nothing_known_explain_nothing() {
        assert!(entry("divided-by-lights", &[1.0]).explains(&[row(1.0, 0.01)]).is_none());
        assert!(entry("divided-by-lights", &[0.5]).explains(&[row(0.5, 0.4)]).is_none());
        assert!(entry("divided-by-lights", &[0.0]).explains(&[row(0.0, 0.0)]).is_some());
    }

    #[test]
    fn a_dark_row_is_foretold_to_be_lit_or_not() {
        let dark =
            |measured| vec![Measure::exact("dark", measured, 0.0, 0.0).of_channel(Channel::Red)];
        assert!(entry("divided-by-lights", &[0.3]).explains(&[dark(0.1)]).is_some());
        assert!(entry("divided-by-lights", &[0.0]).explains(&[dark(0.1)]).is_none());
    }

    #[test]
    fn words_that_are_not_in_the_glossary_are_refused() {
        let error = entry("divided-by-lihgts", &[0.5]).validate(1).unwrap_err();
        assert!(error.contains("divided-by-lights"), "{error}");
        assert!(entry("divided-by-lights", &[0.5]).validate(2).is_err());
    }
}
