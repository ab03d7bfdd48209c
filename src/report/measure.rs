//! A measure in words: every number with the digits that its tolerance makes meaningful.

use crate::checks::Measure;
use crate::stats::Verdict;
use crate::text::number::{apart, percent, signed_percent, sixth_digit, to_step};

/// The numbers of a [`Measure`], ready to be shown side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MeasureWords {
    pub(crate) name: String,
    pub(crate) measured: String,
    pub(crate) expected: String,
    /// How far from `expected` is still right; empty where the interval decides.
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
        let [measured, expected] = side_by_side(measure, step);
        Self {
            name: match measure.unit.as_str() {
                "" => measure.name(),
                unit => format!("{} ({unit})", measure.name()),
            },
            measured,
            expected,
            allowed: match measure.interval {
                Some(_) if measure.allowed == 0.0 => String::new(),
                _ => format!("±{}", to_step(measure.allowed, measure.allowed)),
            },
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

/// What was measured and what is expected, with six digits at most, unless they would read the same although they
/// differ.
fn side_by_side(measure: &Measure, step: f64) -> [String; 2] {
    let values = [measure.measured, measure.expected];
    let largest = values.map(f64::abs).into_iter().fold(0.0, f64::max);
    let step = coarser(step, largest);
    let words = values.map(|value| to_step(value, step));
    let is_told = words[0] != words[1] || measure.verdict != Verdict::Fail;
    let words = if is_told { words } else { apart(values) };
    let differ = words[0] != words[1] || values[0].to_bits() == values[1].to_bits();
    if differ || is_told { words } else { values.map(|value| value.to_string()) }
}

/// The step, unless it shows more than six digits of the value.
fn coarser(step: f64, value: f64) -> f64 {
    if step > 0.0 { step.max(sixth_digit(value)) } else { step }
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
    format!("{sign}{}", to_step(difference, coarser(step, difference)))
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

/// The worst of the measures, as many as that, in the order in which they were measured: bounce by bounce.
pub(crate) fn worst_in_order(measures: &[Measure], most: usize) -> Vec<&Measure> {
    let worst: Vec<_> = worst_first(measures).into_iter().take(most).collect();
    let is_shown = |measure: &&Measure| worst.iter().any(|shown| std::ptr::eq(*shown, *measure));
    measures.iter().filter(is_shown).collect()
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
