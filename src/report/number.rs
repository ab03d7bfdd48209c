//! Numbers as people read them: as many digits as mean something, and no more.
//!
//! A number never stands for another: NaN and the infinities keep their names.

/// Digits beyond these are noise of the arithmetic itself.
const MOST_DIGITS: i32 = 15;

/// `value` with two digits below the leading one of `step`: the finest difference that matters.
/// Without a usable step, six significant digits.
pub fn to_step(value: f64, step: f64) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if !(step.is_finite() && step > 0.0) {
        return significant(value, 6);
    }
    if is_whole(value) && is_whole(step) {
        return value.to_string();
    }
    let places = 1 - exponent(step);
    if is_plain(value.abs().max(step)) && places <= MOST_DIGITS {
        let places = usize::try_from(places.max(0)).unwrap_or(0);
        return without_negative_zero(format!("{value:.places$}"));
    }
    significant(value, (exponent(value) + places + 1).clamp(2, MOST_DIGITS))
}

/// `value` with so many significant digits, plain where that is short, else as `1.5e-7`. Whole
/// numbers stay whole.
pub fn significant(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if is_whole(value) {
        return without_negative_zero(value.to_string());
    }
    let places = |count: i32| usize::try_from(count.max(0)).unwrap_or(0);
    if is_plain(value) {
        return format!("{value:.*}", places(digits - 1 - exponent(value)));
    }
    format!("{value:.*e}", places(digits - 1))
}

/// A share as per cent, two significant digits, with its sign.
pub fn signed_percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(share))
}

/// A share as per cent, two significant digits: `9.5 %`, `0.0021 %`.
pub fn percent(share: f64) -> String {
    let hundredfold = share * 100.0;
    if !hundredfold.is_finite() {
        return hundredfold.to_string();
    }
    if hundredfold.abs() >= 100.0 {
        return format!("{hundredfold:.0} %");
    }
    format!("{} %", significant(hundredfold, 2))
}

/// A probability: `1.8e-7`; nothing spent is `0`.
pub fn probability(value: f64) -> String {
    if value > 0.0 && value < 0.01 { format!("{value:.1e}") } else { significant(value, 2) }
}

/// A duration: `12 ms`, `1.4 s`, `2 m 49 s`, `1 h 03 m`.
pub fn duration(seconds: f64) -> String {
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
pub fn count(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
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
    value == 0.0 || (1e-4..1e7).contains(&value.abs())
}

fn without_negative_zero(text: String) -> String {
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_digits_as_the_step_makes_meaningful() {
        assert_eq!(to_step(0.370_012_3, 0.001), "0.3700");
        assert_eq!(to_step(1.0, 2e-5), "1.000000");
        assert_eq!(to_step(12_345.678, 50.0), "12346");
        assert_eq!(to_step(3.2e-6, 1e-8), "3.200e-6");
        assert_eq!(to_step(-0.000_001, 0.01), "0.000");
    }

    #[test]
    fn two_numbers_that_differ_by_more_than_the_step_look_different() {
        assert_ne!(to_step(1.0, 1e-13), to_step(1.0 + 2e-13, 1e-13));
    }

    #[test]
    fn what_is_not_a_number_is_called_so() {
        assert_eq!(to_step(f64::NAN, 1.0), "NaN");
        assert_eq!(to_step(f64::NEG_INFINITY, 1.0), "-inf");
        assert_eq!(significant(f64::INFINITY, 3), "inf");
        assert_eq!(percent(f64::NAN), "NaN");
        assert_eq!(duration(f64::NAN), "NaN s");
    }

    #[test]
    fn whole_numbers_stay_whole() {
        assert_eq!(to_step(887.0, 0.0), "887");
        assert_eq!(significant(-0.0, 3), "0");
        assert_eq!(to_step(3.0, 3.0), "3");
    }

    #[test]
    fn per_cents_keep_two_digits() {
        assert_eq!(percent(0.095), "9.5 %");
        assert_eq!(percent(0.000_021), "0.0021 %");
        assert_eq!(signed_percent(0.3), "+30 %");
        assert_eq!(signed_percent(-0.095), "-9.5 %");
        assert_eq!(percent(12.0), "1200 %");
    }

    #[test]
    fn durations_change_their_unit() {
        let read: Vec<_> = [0.0123, 1.42, 99.9, 169.0, 3780.0].map(duration).into();
        assert_eq!(read, ["12 ms", "1.4 s", "99.9 s", "2 m 49 s", "1 h 03 m"]);
    }

    #[test]
    fn probabilities_show_their_power_of_ten() {
        assert_eq!(probability(1.83e-7), "1.8e-7");
        assert_eq!(probability(0.0), "0");
    }
}
