//! A crash narrowed to one element of its batch, by halving.

use std::ops::Range;

/// The smallest part of a batch of `count` that still crashes: one element, as a rule. None if the
/// batch alone does not, for then the crash depends on what came before it; `crashes` answers none
/// where it has run out of time, and what is known by then is the answer.
pub(crate) fn narrow(
    count: usize,
    mut crashes: impl FnMut(Range<usize>) -> Option<bool>,
) -> Option<Range<usize>> {
    let mut culprit = 0..count;
    if crashes(culprit.clone()) != Some(true) {
        return None;
    }
    while culprit.len() > 1 {
        let middle = culprit.start + culprit.len() / 2;
        let (first, second) = (culprit.start..middle, middle..culprit.end);
        match crashes(first.clone()) {
            Some(true) => culprit = first,
            Some(false) if crashes(second.clone()) == Some(true) => culprit = second,
            // Neither half alone: only together, or the time is up.
            _ => break,
        }
    }
    Some(culprit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_element_is_found_in_few_steps() {
        let mut asked = 0;
        let found = narrow(1000, |range| {
            asked += 1;
            Some(range.contains(&617))
        });
        assert_eq!(found, Some(617..618));
        assert!(asked <= 21, "{asked} workers");
    }

    #[test]
    fn what_crashes_is_told_as_one_element_or_a_range_or_not_at_all() {
        type Crashes = fn(Range<usize>) -> Option<bool>;
        let rows: [(Crashes, Option<Range<usize>>); 4] = [
            (|range| Some(range.contains(&3) || range.contains(&6)), Some(3..4)),
            (|range| Some(range.contains(&5) && range.contains(&6)), Some(4..8)),
            (|_| Some(false), None),
            (|_| None, None),
        ];
        for (row, (crashes, found)) in rows.into_iter().enumerate() {
            assert_eq!(narrow(8, crashes), found, "row {row}");
        }
    }

    #[test]
    fn what_is_known_when_the_time_is_up_is_kept() {
        let mut left = 3;
        let found = narrow(1000, |range| {
            left -= 1;
            (left >= 0).then(|| range.contains(&10))
        });
        assert_eq!(found, Some(0..250));
    }
}
