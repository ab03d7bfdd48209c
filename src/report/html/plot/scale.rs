//! From numbers to places along an axis, and the round numbers that are written at it.

use crate::text::number::{significant, to_step};

/// Along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    is_log: bool,
    /// Where the low and the high end are drawn.
    ends: [f64; 2],
}

impl Scale {
    /// Equal steps, equal lengths. Of values that are finite; one value alone has room around it.
    pub(super) fn linear(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let [low, high] = range(values)?;
        let room = if low == high { if low == 0.0 { 1.0 } else { 0.1 * low.abs() } } else { 0.0 };
        Some(Self { low: low - room, high: high + room, is_log: false, ends: [0.0, 1.0] })
    }

    /// Equal factors, equal lengths. Of values that are finite and above 0.
    pub(super) fn log(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let [low, high] = range(values.into_iter().filter(|value| *value > 0.0))?;
        let room = if high / low < 1.2 { 1.1 } else { 1.0 };
        Some(Self { low: low / room, high: high * room, is_log: true, ends: [0.0, 1.0] })
    }

    /// The same with a share of its length as room at both ends.
    pub(super) fn with_room(self, share: f64) -> Self {
        match self.is_log {
            true => {
                let room = (self.high / self.low).powf(share);
                Self { low: self.low / room, high: self.high * room, ..self }
            }
            false => {
                let room = share * (self.high - self.low);
                Self { low: self.low - room, high: self.high + room, ..self }
            }
        }
    }

    pub(super) const fn between(self, ends: [f64; 2]) -> Self {
        Self { ends, ..self }
    }

    /// Where a value is drawn; none for what is not finite, or has no logarithm.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let share = match self.is_log {
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        };
        // What is beyond the axis by a hair is drawn at its end.
        let within = share.clamp(-0.02, 1.02);
        share.is_finite().then(|| self.ends[0] + within * (self.ends[1] - self.ends[0]))
    }

    /// Round numbers within the range, and as they are written: about so many.
    pub(super) fn ticks(&self, about: usize) -> Vec<(f64, String)> {
        let values = if self.is_log { self.powers(about) } else { self.steps(about) };
        // Neighbours that are close need the digits in which they differ.
        let step = values.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        values.into_iter().map(|value| (value, label(value, step))).collect()
    }

    fn steps(&self, about: usize) -> Vec<f64> {
        let wanted = (self.high - self.low) / about as f64;
        let power = 10f64.powf(wanted.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
        let step = step.into_iter().find(|step| *step >= wanted).unwrap_or(wanted);
        let first = (self.low / step - 1e-9).ceil();
        let values = (0..=2 * about).map(|number| (first + number as f64) * step);
        let slack = 1e-9 * step;
        // Multiples of a decimal step carry its rounding; eleven digits are free of it.
        let clean = |value: f64| format!("{value:.10e}").parse().unwrap_or(value);
        values.take_while(|value| *value <= self.high + slack).map(clean).collect()
    }

    /// Powers of ten, thinned out if they are many; with 2 and 5 between them if they are few.
    fn powers(&self, about: usize) -> Vec<f64> {
        let exponents = [self.low.log10().floor(), self.high.log10().ceil()];
        let decades = (exponents[1] - exponents[0]).max(1.0);
        let stride = (decades / about as f64).ceil().max(1.0);
        let is_few = (self.high / self.low).log10() * 3.0 <= about as f64 + 1.0;
        let between: &[f64] = if is_few { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let powers = (0..).map(|number| exponents[0] + f64::from(number) * stride);
        let powers = powers.take_while(|exponent| *exponent <= exponents[1]);
        let values = powers.flat_map(|exponent| between.iter().map(move |one| (*one, exponent)));
        let value = |(one, exponent): (f64, f64)| format!("{one}e{exponent}").parse().ok();
        let is_within = |value: &f64| self.low * 0.999 <= *value && *value <= self.high * 1.001;
        values.filter_map(value).filter(is_within).collect()
    }
}

/// A number at an axis: `0.05`, `1.0002`, `20 k`.
fn label(value: f64, step: f64) -> String {
    match value.abs() {
        size if (1e4..1e6).contains(&size) => format!("{} k", significant(value / 1e3, 3)),
        size if (1e6..1e9).contains(&size) => format!("{} M", significant(value / 1e6, 3)),
        size if step < 1e-3 * size => to_step(value, 10.0 * step),
        _ => significant(value, 3),
    }
}

fn range(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |range: Option<[f64; 2]>, value| {
        let [low, high] = range.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Option<Scale>) -> Vec<String> {
        scale.unwrap().ticks(5).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(labels(Scale::linear([0.0, 1.0])), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(labels(Scale::linear([-0.3, 0.31])), ["-0.2", "0", "0.2"]);
        assert_eq!(labels(Scale::log([4.0, 4096.0])), ["10", "100", "1000"]);
        assert_eq!(labels(Scale::log([320.0, 40_000.0])), ["1000", "10 k"]);
        assert_eq!(labels(Scale::log([0.8, 12.0])), ["1", "2", "5", "10"]);
        assert_eq!(
            labels(Scale::linear([0.999_95, 1.000_17])),
            ["0.99995", "1.00000", "1.00005", "1.00010", "1.00015"]
        );
        assert!(labels(Scale::log([1e-12, 1.0])).len() <= 6);
        assert_eq!(labels(Scale::linear([3.0])), ["2.8", "3", "3.2"]);
    }

    #[test]
    fn what_has_no_place_gets_none() {
        let scale = Scale::log([1.0, 100.0, f64::NAN, 0.0]).unwrap().between([0.0, 200.0]);
        assert_eq!(scale.place(10.0), Some(100.0));
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(scale.place(value), None, "{value}");
        }
        assert!(Scale::linear([f64::NAN, f64::INFINITY]).is_none());
        assert!(Scale::log([0.0, -1.0]).is_none());
    }
}
