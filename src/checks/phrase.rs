//! What statements and measures of different checks have in common.

use super::Measure;
use crate::stats::{ExactReport, Verdict};
use crate::text::number::{ratio, with_interval};

pub use crate::text::number::{degrees, figure, percent};

/// `12 of 53 rays are`, `1 of 53 rays is`: the beginning of most failing statements.
pub fn some_are(some: usize, all: usize, noun: &str) -> String {
    format!("{some} of {all} {noun} {}", if some == 1 { "is" } else { "are" })
}

/// `0.318 (99.9 % CI 0.316 to 0.320)`: what was measured over what it should be.
pub fn ratio_of(measure: &Measure) -> String {
    let over = |value: f64| value / measure.expected;
    match measure.interval {
        Some(ends) => with_interval(over(measure.measured), ends.map(over)),
        None => ratio(over(measure.measured)),
    }
}

/// The worst element of a comparison as a measure. Of many, the name says which it was, counted from 1.
pub fn worst_measure(name: impl Into<String>, report: &ExactReport) -> Measure {
    let name = name.into();
    let name = match (report.compared, report.worst) {
        (all @ 2.., Some(worst)) => format!("{name}, worst of {all} (number {})", worst.index + 1),
        _ => name,
    };
    Measure::of(name, report)
}

/// A measure without noise that only has to stay below a limit. NaN fails.
pub fn at_most(name: impl Into<String>, measured: f64, limit: f64) -> Measure {
    let name = format!("{} (at most)", name.into());
    Measure {
        verdict: Verdict::pass_if(measured <= limit),
        resolution: None,
        ..Measure::exact(name, measured, limit, 0.0)
    }
}

/// `would have caught an error of 0.42 %`: by the weakest of some measures. Empty if none has a resolution.
pub fn would_have_caught(measures: &[Measure]) -> String {
    let weakest = measures.iter().filter_map(|measure| measure.resolution).reduce(f64::max);
    weakest.map_or_else(String::new, |r| format!("would have caught an error of {}", percent(r)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Compared, judge_exact};

    #[test]
    fn one_is_and_two_are() {
        assert_eq!(some_are(1, 9, "rays"), "1 of 9 rays is");
        assert_eq!(some_are(2, 9, "rays"), "2 of 9 rays are");
    }

    #[test]
    fn the_worst_element_is_shown_with_the_verdict_on_all() {
        let report =
            judge_exact([Compared::within(1.0, 1.0, 0.1), Compared::within(3.0, 1.0, 0.1)]);
        let measure = worst_measure("t", &report);
        assert_eq!(measure.name, "t, worst of 2 (number 2)");
        assert_eq!((measure.measured, measure.verdict), (3.0, Verdict::Fail));
        assert_eq!(worst_measure("t", &judge_exact([])).verdict, Verdict::Inconclusive);
    }
}
