//! Names for measured ratios: whether "3.14 ± 0.02 times too bright" is π.

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, PI, SQRT_2, TAU};

/// Ratios that mistakes make, as they are written.
const NAMED: &[(f64, &str)] = &[
    (0.0, "0"),
    (PI, "π"),
    (FRAC_1_PI, "1/π"),
    (2.0, "2"),
    (0.5, "1/2"),
    (TAU, "2π"),
    (1.0 / TAU, "1/2π"),
    (4.0, "4"),
    (0.25, "1/4"),
    (FRAC_PI_2, "π/2"),
    (FRAC_2_PI, "2/π"),
    (2.0 * TAU, "4π"),
    (0.5 / TAU, "1/4π"),
    (PI * PI, "π²"),
    (FRAC_1_PI * FRAC_1_PI, "1/π²"),
    (3.0, "3"),
    (1.0 / 3.0, "1/3"),
    (2.0 / 3.0, "2/3"),
    (1.5, "3/2"),
    (SQRT_2, "√2"),
    (0.5 * SQRT_2, "1/√2"),
];

/// An interval wider than this factor contains something by chance.
const WIDEST: f64 = 1.15;

/// A ratio and what it is called.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct NamedRatio {
    pub(crate) value: f64,
    /// As it is written, such as `1/π`.
    pub(crate) name: String,
}

/// The named ratios inside an interval, the nearest to its middle first. None if the interval is so
/// wide that a name would mean nothing, or holds 1, which is no mistake. `also` adds names that only this measurement has, such as
/// the number of light samples.
pub(crate) fn names_of(interval: [f64; 2], also: &[(f64, &str)]) -> Vec<NamedRatio> {
    let [low, high] = interval;
    let is_narrow = high <= WIDEST * low || (low..=high).contains(&0.0) && high <= WIDEST - 1.0;
    if !is_narrow {
        return Vec::new();
    }
    let middle = 0.5 * (low + high);
    let named = if (low..=high).contains(&1.0) { &[] } else { NAMED };
    let inside = named.iter().chain(also).filter(|(value, _)| (low..=high).contains(value));
    let mut named: Vec<NamedRatio> =
        inside.map(|&(value, name)| NamedRatio { value, name: name.to_owned() }).collect();
    named.sort_by(|a, b| (a.value - middle).abs().total_cmp(&(b.value - middle).abs()));
    named
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_have_the_names_of_what_they_may_be_the_nearest_first() {
        for (interval, expected) in [
            ([3.12, 3.16], &["π"][..]),
            ([0.315, 0.322], &["1/π"]),
            ([0.0, 0.0], &["0"]),
            ([0.62, 0.67], &["2/π", "2/3"]),
            // Without a name, maybe right, and too wide.
            ([0.86, 0.89], &[]),
            ([0.99, 1.01], &[]),
            ([1.0, 1.0], &[]),
            ([0.4, 4.0], &[]),
            ([f64::NAN; 2], &[]),
        ] {
            let found = names_of(interval, &[]);
            let names: Vec<_> = found.iter().map(|ratio| &ratio.name).collect();
            assert_eq!(names, expected, "{interval:?}");
        }
    }

    #[test]
    fn what_only_this_measurement_has_can_be_named() {
        let named = names_of([0.142, 0.144], &[(1.0 / 7.0, "1/n with n = 7 light samples")]);
        assert_eq!(named[0].name, "1/n with n = 7 light samples");
    }

    #[test]
    fn no_two_names_are_closer_than_the_narrowest_interval_that_tells_them_apart() {
        for (i, (a, _)) in NAMED.iter().enumerate() {
            for (b, _) in &NAMED[i + 1..] {
                assert!((a - b).abs() > 0.04 * a.max(*b).min(1.0), "{a} and {b}");
            }
        }
    }
}
