//! Measured over expected, with the interval that comparisons are made in.

use super::evidence::measure;
use crate::checks::{Finding, Measure};
use crate::image::CHANNELS;
use crate::stats::Band;
use crate::text::number::{apart, figure, plus_minus};

/// Relative error that a comparison forgives on top of an interval: what is forgiven of a radiance, once for what was
/// measured and once for what a rule predicts from the radiance of another question.
const SLACK: f64 = 2.0 * Band::RADIANCE.relative();

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reading {
    /// Measured over expected.
    pub(crate) ratio: f64,
    /// Holds the true ratio with 99.9 % confidence, and a little more for rounding.
    pub(crate) interval: [f64; 2],
}

impl Reading {
    /// The reading of a measure; none where nothing was expected, or a number is NaN.
    pub(crate) fn of(measure: &Measure) -> Option<Self> {
        let ratio = measure.measured / measure.expected;
        let around = |value: f64| [value - SLACK * value.abs(), value + SLACK * value.abs()];
        let interval = match measure.interval {
            Some([low, high]) => {
                let ends = [low / measure.expected, high / measure.expected];
                [
                    around(ends[0])[0].min(around(ends[1])[0]),
                    around(ends[1])[1].max(around(ends[0])[1]),
                ]
            }
            None => around(ratio),
        };
        let is_proper = ratio.is_finite() && interval.iter().all(|end| end.is_finite());
        is_proper.then_some(Self { ratio, interval })
    }

    pub(crate) fn admits(&self, prediction: f64) -> bool {
        self.interval[0] <= prediction && prediction <= self.interval[1]
    }

    pub(crate) fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }

    /// The ratio, with the digits that tell it from 1 where it is not 1: `1.0025`.
    pub(crate) fn told_from_one(&self) -> String {
        let [told, _] = apart([self.ratio, 1.0]);
        if self.admits(1.0) { figure(self.ratio) } else { told }
    }

    /// With its uncertainty, and what a rule predicts.
    pub(crate) fn beside(&self, predicted: f64) -> String {
        let measured = plus_minus(self.ratio, self.half_width());
        format!("{measured} (predicted {})", figure(predicted))
    }
}

/// Whether all that failed of a finding admits one ratio.
pub(crate) fn fails_as(finding: &Finding, ratio: f64) -> bool {
    let mut wrong = finding.failed_measures().filter_map(Reading::of).peekable();
    wrong.peek().is_some() && wrong.all(|reading| reading.admits(ratio))
}

/// The readings of a row of a finding, channel by channel; `None` for a channel that expects nothing.
pub(crate) fn channels(finding: &Finding, row: &str) -> [Option<Reading>; 3] {
    CHANNELS.map(|channel| measure(finding, row, channel).and_then(Reading::of))
}
