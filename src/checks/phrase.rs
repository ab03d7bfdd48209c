//! What statements and measures of different checks have in common.

use super::Measure;
use crate::text::number::{ratio, with_interval};

pub(crate) use crate::text::number::{degrees, figure, percent};

/// `12 of 53 rays are`, `1 of 53 rays is`: the beginning of most failing statements.
pub(crate) fn some_are(some: usize, all: usize, noun: &str) -> String {
    format!("{some} of {all} {noun} {}", if some == 1 { "is" } else { "are" })
}

/// `t is 3 instead of 2`
pub(crate) fn instead(measure: &Measure) -> String {
    let (found, right) = (figure(measure.measured), figure(measure.expected));
    format!("{} is {found} instead of {right}", measure.name())
}

/// `2895`: of 20000 that are right, the `one in so many` that would have shown a wrong one.
pub(crate) fn one_in(right: usize) -> String {
    // 6.9 = −ln 0.001: so rare a mistake shows in none of them once in a thousand times.
    figure((right as f64 / 6.9).floor())
}

/// `0.318 (99.9 % CI 0.316 to 0.320)`: what was measured over what it should be.
pub(crate) fn ratio_of(measure: &Measure) -> String {
    let over = |value: f64| value / measure.expected;
    match measure.interval {
        Some(ends) => with_interval(over(measure.measured), ends.map(over)),
        None => ratio(over(measure.measured)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_and_two_are() {
        assert_eq!(some_are(1, 9, "rays"), "1 of 9 rays is");
        assert_eq!(some_are(2, 9, "rays"), "2 of 9 rays are");
    }
}
