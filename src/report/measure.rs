//! A measure in words: every number with the digits that its tolerance makes meaningful.

use crate::checks::Measure;
use crate::stats::Verdict;
use crate::text::number::{percent, signed_percent, to_step};

/// The numbers of a [`Measure`], ready to be shown side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MeasureWords {
    pub(crate) name: String,
    pub(crate) measured: String,
    pub(crate) expected: String,
    /// How far from `expected` is still right.
    pub(crate) allowed: String,
    /// 99.9 % interval of what was measured; empty without noise.
    pub(crate) interval: String,
    /// Measured over expected; empty where nothing is expected.
    pub(crate) ratio: String,
    /// How far off the core is: in per cent of what is expected, or absolutely where that is zero.
    pub(crate) off_by: String,
    /// The smallest relative error that would have been caught; empty if not known.
    pub(crate) resolution: String,
}

impl MeasureWords {
    pub(crate) fn of(measure: &Measure) -> Self {
        let step = finest_step(measure);
        let number = |value| to_step(value, step);
        Self {
            name: match measure.unit.as_str() {
                "" => measure.name(),
                unit => format!("{} ({unit})", measure.name()),
            },
            measured: number(measure.measured),
            expected: number(measure.expected),
            allowed: format!("±{}", to_step(measure.allowed, measure.allowed)),
            interval: measure
                .interval
                .map(|[low, high]| format!("[{}, {}]", number(low), number(high)))
                .unwrap_or_default(),
            ratio: ratio(measure, step),
            off_by: off_by(measure, step),
            resolution: measure.resolution.map(caught).unwrap_or_default(),
        }
    }
}

fn caught(resolution: f64) -> String {
    if resolution == 0.0 { "any".to_owned() } else { percent(resolution) }
}

/// The finest difference that matters: the tolerance or the noise, whichever is smaller; where
/// neither is, the error itself.
fn finest_step(measure: &Measure) -> f64 {
    let noise = measure.interval.map(|[low, high]| (high - low) / 2.0);
    let meaningful = |step: &f64| step.is_finite() && *step > 0.0;
    let steps = [Some(measure.allowed), noise].into_iter().flatten().filter(meaningful);
    let error = (measure.measured - measure.expected).abs();
    steps.reduce(f64::min).unwrap_or(error)
}

fn ratio(measure: &Measure, step: f64) -> String {
    if measure.expected == 0.0 {
        return String::new();
    }
    to_step(measure.measured / measure.expected, step / measure.expected.abs())
}

fn off_by(measure: &Measure, step: f64) -> String {
    let difference = measure.measured - measure.expected;
    if measure.expected != 0.0 {
        return signed_percent(difference / measure.expected.abs());
    }
    let sign = if difference > 0.0 { "+" } else { "" };
    format!("{sign}{}", to_step(difference, step))
}

/// The measures of a finding, the worst first: failures before the undecided, those before passes;
/// of equals the largest error in units of what is allowed, NaN before all.
pub(crate) fn worst_first(measures: &[Measure]) -> Vec<&Measure> {
    let mut sorted: Vec<_> = measures.iter().collect();
    sorted.sort_by(|a, b| {
        (rank(a.verdict).cmp(&rank(b.verdict))).then_with(|| excess(b).total_cmp(&excess(a)))
    });
    sorted
}

fn rank(verdict: Verdict) -> usize {
    match verdict {
        Verdict::Fail => 0,
        Verdict::Inconclusive => 1,
        Verdict::Pass => 2,
    }
}

/// The error in units of what is allowed; whatever is not a number is beyond every bound.
fn excess(measure: &Measure) -> f64 {
    let error = (measure.measured - measure.expected).abs();
    let excess = if error == 0.0 { 0.0 } else { error / measure.allowed };
    if excess.is_nan() { f64::INFINITY } else { excess }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_tolerance() {
        let words = MeasureWords::of(&Measure::exact("t", 0.362_41, 0.37, 0.001).in_unit("m"));
        assert_eq!(words.name, "t (m)");
        assert_eq!(words.measured, "0.3624");
        assert_eq!(words.expected, "0.3700");
        assert_eq!(words.allowed, "±0.0010");
        assert_eq!(words.ratio, "0.9795");
        assert_eq!(words.off_by, "-2.05 %");
    }

    #[test]
    fn an_error_of_one_bit_is_seen() {
        let next = 1.0 + f64::EPSILON;
        let words = MeasureWords::of(&Measure::exact("t", next, 1.0, 0.0));
        assert_ne!(words.measured, words.expected);
    }

    #[test]
    fn nan_stays_nan() {
        let words = MeasureWords::of(&Measure::exact("t", f64::NAN, 1.0, 0.001));
        assert_eq!([&*words.measured, &words.ratio, &words.off_by], ["NaN", "NaN", "NaN"]);
    }

    #[test]
    fn where_zero_is_expected_the_error_is_absolute() {
        let words = MeasureWords::of(&Measure::exact("count", 3.0, 0.0, 0.0));
        assert_eq!([&*words.ratio, &words.off_by], ["", "+3"]);
    }

    #[test]
    fn the_worst_comes_first_and_nan_is_the_worst() {
        let measures = [
            Measure::exact("right", 1.0, 1.0, 0.1),
            Measure::exact("wrong", 2.0, 1.0, 0.1),
            Measure::exact("not a number", f64::NAN, 1.0, 0.1),
        ];
        let names: Vec<_> = worst_first(&measures).into_iter().map(Measure::name).collect();
        assert_eq!(names, ["not a number", "wrong", "right"]);
    }
}
