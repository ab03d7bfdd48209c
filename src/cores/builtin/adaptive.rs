//! Adaptive sampling: the variance of a pixel, and the course's stopping rule; in double precision.

use crate::contract::{AdaptiveMean, AdaptiveSettings};

/// Half the width of a 95 % interval in standard errors.
const HALF_WIDTH: f64 = 1.96;

/// Running mean and variance of the samples of one pixel (Welford 1962), which unlike sums of squares
/// gives exactly zero for a constant.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Running {
    count: u32,
    mean: f64,
    squares: f64,
}

impl Running {
    /// Takes one more sample in: a luminance, or the light of a channel.
    pub(crate) fn add(&mut self, value: f64) {
        self.count += 1;
        let deviation = value - self.mean;
        self.mean += deviation / f64::from(self.count);
        self.squares += deviation * (value - self.mean);
    }

    /// Variance of the mean so far; 0 before the second sample, when nothing is known of it.
    pub(crate) fn variance_of_mean(&self) -> f64 {
        match self.count {
            0 | 1 => 0.0,
            _ => self.standard_error().powi(2),
        }
    }

    /// Whether a batch is complete and 1.96 σ/√n ≤ tolerance · μ, with σ over n − 1.
    pub(crate) fn suffice(&self, settings: AdaptiveSettings) -> bool {
        let at_end_of_batch = self.count.is_multiple_of(settings.samples_per_batch.max(1));
        at_end_of_batch && self.half_interval() <= settings.max_tolerance * self.mean
    }

    /// 1.96 standard errors of the mean; unknown (NaN) before the second sample.
    fn half_interval(&self) -> f64 {
        HALF_WIDTH * self.standard_error()
    }

    /// Of the mean, by the variance of the samples over n − 1.
    fn standard_error(&self) -> f64 {
        let count = f64::from(self.count);
        (self.squares / (count - 1.0) / count).sqrt()
    }
}

/// Luminance of linear RGB, by the weights of Rec. 709.
pub(crate) fn luminance([red, green, blue]: [f64; 3]) -> f64 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// What the rule makes of one stream of luminances that ends at the sample cap.
pub(crate) fn mean_of_stream(settings: AdaptiveSettings, stream: &[f64]) -> AdaptiveMean {
    let mut luminances = Running::default();
    let mut sum = 0.0;
    for &sample in stream {
        luminances.add(sample);
        sum += sample;
        if luminances.suffice(settings) {
            break;
        }
    }
    let used = luminances.count;
    AdaptiveMean { mean: sum / f64::from(used.max(1)), used, reserved: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn used(pattern: &[f64], max_tolerance: f64, samples_per_batch: u32) -> AdaptiveMean {
        let stream: Vec<f64> = pattern.iter().copied().cycle().take(2048).collect();
        mean_of_stream(AdaptiveSettings { samples_per_batch, max_tolerance }, &stream)
    }

    #[test]
    fn a_stream_that_never_settles_is_used_up() {
        let answer = used(&[0.0, 10.0], 1e-9, 32);
        assert_eq!((answer.used, answer.mean), (2048, 5.0));
    }

    #[test]
    fn black_suffices_and_not_a_number_never() {
        assert_eq!(used(&[0.0], 0.05, 32).used, 32);
        assert_eq!(used(&[f64::NAN], 0.05, 32).used, 2048);
    }
}
