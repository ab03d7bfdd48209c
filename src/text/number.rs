//! Numbers as people read them: as many digits as mean something, and no more.
//!
//! - A number never stands for another: NaN and the infinities keep their names, whole numbers stay whole.
//! - Where nothing is known of a number it has three significant digits, and no idle zeros: [`figure`], [`percent`].
//! - Two that are held against each other have digits enough to see by how much they differ: [`apart`], [`ratio`].
//! - One that is known to so much ends with the leading digit of its uncertainty, so that the ends of an interval
//!   differ: [`with_interval`], [`plus_minus`].
//! - In a table, where numbers stand below each other, all have as many: [`to_step`].

/// Digits beyond these are noise of the arithmetic itself.
const MOST_DIGITS: i32 = 15;

/// `value` with three significant digits: `7.1`, `1234`, `2e-9`.
pub(crate) fn figure(value: f64) -> String {
    significant(value, 3)
}

/// `value` with so many significant digits and no idle zeros, plain where that is short, else as `1.5e-7`.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if !value.is_finite() || is_whole(value) && is_plain(value) {
        return without_negative_zero(value.to_string());
    }
    let written = padded(value, digits);
    let (mantissa, power) = written.split_at(written.find('e').unwrap_or(written.len()));
    let mantissa = match mantissa.contains('.') {
        true => mantissa.trim_end_matches('0').trim_end_matches('.'),
        false => mantissa,
    };
    format!("{mantissa}{power}")
}

/// Two numbers that should be the same, each with two digits of what is between them, and three at least:
/// `1.0004` and `1`.
pub(crate) fn apart(values: [f64; 2]) -> [String; 2] {
    let difference = exponent(values[0] - values[1]);
    let digits = |value| (exponent(value) - difference + 2).clamp(3, MOST_DIGITS);
    values.map(|value| significant(value, if values[0] == values[1] { 3 } else { digits(value) }))
}

/// A ratio that should be one.
pub(crate) fn ratio(value: f64) -> String {
    let [value, _] = apart([value, 1.0]);
    value
}

/// `1.553 (99.9 % CI 1.552 to 1.555)`: a value, and the ends of its interval of 99.9 % confidence.
pub(crate) fn with_interval(value: f64, [low, high]: [f64; 2]) -> String {
    let half = (high - low) / 2.0;
    if !(half.is_finite() && half > 0.0) {
        return figure(value);
    }
    let [value, low, high] = [value, low, high].map(|number| at_digit(number, half, 0));
    format!("{value} (99.9 % CI {low} to {high})")
}

/// `0.7000 ± 0.0004`: a value, and half the width of its interval.
pub(crate) fn plus_minus(value: f64, half: f64) -> String {
    if !(half.is_finite() && half > 0.0) {
        return figure(value);
    }
    format!("{} ± {}", at_digit(value, half, 0), at_digit(half, half, 0))
}

/// `value` with two digits below the leading one of `step`: the finest difference that matters.
/// Without a usable step, six significant digits.
pub(crate) fn to_step(value: f64, step: f64) -> String {
    if !(step.is_finite() && step > 0.0) {
        return significant(value, 6);
    }
    if is_whole(value) && is_whole(step) {
        return value.to_string();
    }
    at_digit(value, step, 1)
}

/// The step with which [`to_step`] shows a number in six digits.
pub(crate) fn sixth_digit(value: f64) -> f64 {
    10f64.powi(exponent(value) - 4)
}

pub(crate) fn signed_percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(share))
}

/// A share as per cent: `9.52 %`, `0.0021 %`.
pub(crate) fn percent(share: f64) -> String {
    match share.is_finite() {
        true => format!("{} %", figure(share * 100.0)),
        false => share.to_string(),
    }
}

/// An angle: `7.1°`.
pub(crate) fn degrees(radians: f64) -> String {
    format!("{}°", figure(radians.to_degrees()))
}

/// A probability: `1.8e-7`; nothing spent is `0`.
pub(crate) fn probability(value: f64) -> String {
    if value > 0.0 && value < 0.01 { format!("{value:.1e}") } else { significant(value, 2) }
}

/// A duration: `12 ms`, `1.4 s`, `2 m 49 s`, `1 h 03 m`.
pub(crate) fn duration(seconds: f64) -> String {
    if !(0.0..1e9).contains(&seconds) {
        return format!("{seconds} s");
    }
    if seconds < 0.0995 {
        return format!("{:.0} ms", seconds * 1e3);
    }
    if seconds < 99.95 {
        return format!("{seconds:.1} s");
    }
    let minutes = (seconds / 60.0).floor();
    if minutes < 60.0 {
        return format!("{minutes:.0} m {:02.0} s", (seconds - minutes * 60.0).floor());
    }
    let hours = (minutes / 60.0).floor();
    format!("{hours:.0} h {:02.0} m", minutes - hours * 60.0)
}

/// `1 trial`, `2 trials`.
pub(crate) fn count(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// `value` up to the leading digit of `step`, or so many digits more.
fn at_digit(value: f64, step: f64, more: i32) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    // Half an interval of 0.02 may come out a last bit below 0.01.
    let places = more - exponent(step * (1.0 + 1e-9));
    let digits = exponent(value) + places + 1;
    match is_plain(value.abs().max(step)) {
        // As short as it can be read back unchanged.
        _ if digits > MOST_DIGITS => value.to_string(),
        true => {
            let places = usize::try_from(places.max(0)).unwrap_or(0);
            without_negative_zero(format!("{value:.places$}"))
        }
        false => padded(value, digits.max(2)),
    }
}

/// Exactly so many significant digits.
fn padded(value: f64, digits: i32) -> String {
    let places = |count: i32| usize::try_from(count.max(0)).unwrap_or(0);
    match is_plain(value) {
        true => format!("{value:.*}", places(digits - 1 - exponent(value))),
        false => format!("{value:.*e}", places(digits - 1)),
    }
}

/// The power of ten of the leading digit.
fn exponent(value: f64) -> i32 {
    if value == 0.0 {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "exponents of f64 lie within ±324")]
    let exponent = value.abs().log10().floor() as i32;
    exponent
}

fn is_whole(value: f64) -> bool {
    value.trunc() == value && value.abs() < 1e9
}

/// Whether a number is short enough without an exponent.
fn is_plain(value: f64) -> bool {
    value == 0.0 || (1e-4..1e6).contains(&value.abs())
}

fn without_negative_zero(text: String) -> String {
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each number, written one way or another, and how that reads.
    #[test]
    fn numbers_read_as_people_write_them() {
        for (written, expected) in [
            // As many digits as the step makes meaningful.
            (to_step(0.370_012_3, 0.001), "0.3700"),
            (to_step(1.0, 2e-5), "1.000000"),
            (to_step(12_345.678, 50.0), "12346"),
            (to_step(3.2e-6, 1e-8), "3.200e-6"),
            (to_step(-0.000_001, 0.01), "0.000"),
            // The ends of an interval differ.
            (with_interval(1.5534, [1.5519, 1.5549]), "1.553 (99.9 % CI 1.552 to 1.555)"),
            (with_interval(0.7, [0.699, 0.7019]), "0.700 (99.9 % CI 0.699 to 0.702)"),
            (with_interval(1e-9, [1e-9, 2e-9]), "1.0e-9 (99.9 % CI 1.0e-9 to 2.0e-9)"),
            (with_interval(0.25, [0.25, 0.25]), "0.25"),
            (plus_minus(0.7, 0.000_412), "0.7000 ± 0.0004"),
            (plus_minus(12_345.6, 78.0), "12346 ± 78"),
            // What is not a number is called so.
            (with_interval(f64::NAN, [f64::NAN; 2]), "NaN"),
            (to_step(f64::NAN, 1.0), "NaN"),
            (to_step(f64::NEG_INFINITY, 1.0), "-inf"),
            (significant(f64::INFINITY, 3), "inf"),
            (percent(f64::NAN), "NaN"),
            (duration(f64::NAN), "NaN s"),
            // Whole numbers stay whole.
            (to_step(887.0, 0.0), "887"),
            (significant(-0.0, 3), "0"),
            (to_step(3.0, 3.0), "3"),
            // Per cents are figures of hundredths.
            (percent(0.095), "9.5 %"),
            (percent(0.000_021), "0.0021 %"),
            (signed_percent(0.3), "+30 %"),
            (signed_percent(-0.095), "-9.5 %"),
            (percent(12.0), "1200 %"),
            // Probabilities show their power of ten.
            (probability(1.83e-7), "1.8e-7"),
            (probability(0.0), "0"),
        ] {
            assert_eq!(written, expected);
        }
    }

    #[test]
    fn two_numbers_that_differ_by_more_than_the_step_look_different() {
        assert_ne!(to_step(1.0, 1e-13), to_step(1.0 + 2e-13, 1e-13));
        assert_ne!(to_step(1.0, 2e-16), to_step(1.0 + f64::EPSILON, 2e-16));
    }

    #[test]
    fn figures_have_three_digits_and_no_idle_zeros() {
        let numbers = [7.0999, 0.042, 1234.4, 100.0, 1e6, 2e-9, -1.5, 0.0, 1.53e-7, 0.1 + 0.2];
        let written = ["7.1", "0.042", "1234", "100", "1e6", "2e-9", "-1.5", "0", "1.53e-7", "0.3"];
        assert_eq!(numbers.map(figure), written);
    }

    #[test]
    fn what_is_held_against_each_other_looks_different_where_it_differs() {
        for (values, written) in [
            ([0.777_12, 0.5], ["0.777", "0.5"]),
            ([1.000_412_7, 1.0], ["1.00041", "1"]),
            ([2.0, 2.0], ["2", "2"]),
            ([1e-9, 3.25], ["1e-9", "3.25"]),
            ([f64::NAN, 0.5], ["NaN", "0.5"]),
        ] {
            assert_eq!(apart(values), written);
        }
        let ratios = ["0.9932", "1.00002", "0", "3.14"];
        assert_eq!([0.993_21, 1.00002, 0.0, 3.144_59].map(ratio), ratios);
    }

    #[test]
    fn durations_change_their_unit() {
        let read: Vec<_> = [0.0123, 1.42, 99.9, 169.0, 3780.0].map(duration).into();
        assert_eq!(read, ["12 ms", "1.4 s", "99.9 s", "2 m 49 s", "1 h 03 m"]);
    }
}
