//! Part 5: how many samples a pixel needs.

use super::change::Change;
use crate::contract::{AdaptiveMean, AdaptiveSettings};

/// Half width of the 95 % interval of a normal variable, in standard deviations.
const Z_95: f64 = 1.96;

/// The sums a pixel keeps: s₁ and s₂ of the course.
///
/// The textbook formula for the variance loses digits where σ is far below μ; a rule that compares
/// σ with a few percent of μ cannot notice.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    count: u32,
    sum: f64,
    sum_of_squares: f64,
    /// Both, as a careless core keeps them.
    in_single: [f32; 2],
}

impl Tally {
    /// Adds one sample's luminance.
    pub fn add(&mut self, luminance: f64) {
        self.count += 1;
        self.sum += luminance;
        self.sum_of_squares += luminance * luminance;
        self.in_single[0] += luminance as f32;
        self.in_single[1] += (luminance * luminance) as f32;
    }

    /// Samples so far.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Mean of the samples so far.
    pub fn mean(&self) -> f64 {
        self.sum / f64::from(self.count)
    }

    /// Sample variance: over n − 1, not a number for a single sample.
    fn variance(&self, change: Change) -> f64 {
        let n = f64::from(self.count);
        if change == Change::CountOneShort {
            return (self.sum_of_squares - self.sum * self.sum / (n - 1.0)) / (n - 2.0);
        }
        if change == Change::SumsInSingle {
            let [sum, sum_of_squares] = self.in_single;
            return f64::from(sum_of_squares - sum * sum / self.count as f32) / (n - 1.0);
        }
        let squared_deviations = (self.sum_of_squares - self.sum * self.sum / n).max(0.0);
        match change {
            Change::PopulationVariance => squared_deviations / n,
            _ => squared_deviations / (n - 1.0),
        }
    }

    /// Half width of the 95 % interval of the mean.
    fn half_width(&self, change: Change) -> f64 {
        let (n, variance) = (f64::from(self.count), self.variance(change));
        match change {
            Change::SigmaOverN => Z_95 * variance.sqrt() / n,
            Change::Without196 => (variance / n).sqrt(),
            Change::VarianceForSigma => Z_95 * variance / n.sqrt(),
            _ => Z_95 * (variance / n).sqrt(),
        }
    }

    /// Whether the mean is known well enough. A black pixel is; a pixel that is not a number never
    /// is.
    fn has_converged(&self, max_tolerance: f64, change: Change) -> bool {
        let half_width = self.half_width(change);
        match change {
            Change::ToleranceAbsolute => half_width <= max_tolerance,
            _ => half_width <= max_tolerance * self.mean(),
        }
    }
}

/// Draws luminances from `next` until the rule says stop, at most `cap` of them.
pub fn sample_until_converged(
    settings: AdaptiveSettings,
    cap: u32,
    change: Change,
    mut next: impl FnMut(u32) -> f64,
) -> Tally {
    let batch = match change {
        Change::LooksAfterEverySample => 1,
        Change::BatchIgnored => 32,
        _ => settings.samples_per_batch.max(1),
    };
    let cap = match change {
        Change::RestOfBatchDropped => (cap - cap % batch).max(1),
        _ => cap,
    };
    let mut tally = Tally::default();
    while tally.count() < cap {
        tally.add(next(tally.count()));
        let ends_batch = tally.count().is_multiple_of(batch);
        if ends_batch && tally.has_converged(settings.max_tolerance, change) {
            break;
        }
    }
    tally
}

/// Draws all `cap` luminances: what adaptive sampling is compared with.
pub fn sample_all(cap: u32, next: impl FnMut(u32) -> f64) -> Tally {
    let mut tally = Tally::default();
    (0..cap).map(next).for_each(|luminance| tally.add(luminance));
    tally
}

/// What the sum of `count` samples is divided by.
pub fn divisor(count: u32, cap: u32, change: Change) -> f64 {
    f64::from(match change {
        Change::DividedByCap => cap,
        Change::DividedByOneMore => count + 1,
        _ => count,
    })
}

/// How many samples a pixel says it has taken. Without a batch it has taken them all.
pub fn reported(count: u32, cap: u32, batch: Option<u32>, change: Change) -> u32 {
    match (change, batch) {
        (Change::CountsAreCap, _) => cap,
        (Change::CountWithoutLastBatch, Some(batch)) => count.saturating_sub(batch),
        _ => count,
    }
}

/// What the rule makes of a given stream, which is as long as the cap.
pub fn mean_of_stream(settings: AdaptiveSettings, stream: &[f64], change: Change) -> AdaptiveMean {
    let cap = u32::try_from(stream.len()).unwrap_or(u32::MAX);
    let tally = sample_until_converged(settings, cap, change, |index| stream[index as usize]);
    let mean = tally.sum / divisor(tally.count(), cap, change);
    let used = reported(tally.count(), cap, Some(settings.samples_per_batch), change);
    AdaptiveMean { mean, used, reserved: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(period: &[f64], samples_per_batch: u32, max_tolerance: f64) -> AdaptiveMean {
        let stream: Vec<f64> = period.iter().copied().cycle().take(2048).collect();
        mean_of_stream(AdaptiveSettings { samples_per_batch, max_tolerance }, &stream, Change::None)
    }

    /// Variants of the rule stop elsewhere: population variance at 8, σ/n at 4, no 1.96 at 2,
    /// variance for σ at 6, absolute tolerance at 14, a look after every sample at 9.
    #[test]
    fn a_stream_that_tells_all_formulas_apart_stops_at_10() {
        let answer = run(&[1.0, 3.0, 0.5, 1.0, 1.0], 2, 0.5);
        assert_eq!((answer.used, answer.mean), (10, 1.3));
    }

    #[test]
    fn alternating_samples_stop_at_416() {
        let answer = run(&[0.5, 1.5], 32, 0.05);
        assert_eq!((answer.used, answer.mean), (416, 1.0));
    }

    #[test]
    fn a_constant_and_a_black_pixel_stop_after_one_batch() {
        assert_eq!(run(&[0.7], 32, 0.05).used, 32);
        assert_eq!(run(&[0.0], 32, 0.05).used, 32);
    }

    #[test]
    fn a_pixel_that_is_not_a_number_runs_to_the_cap() {
        assert_eq!(run(&[f64::NAN], 32, 0.05).used, 2048);
    }

    #[test]
    fn the_last_batch_is_cut_off_at_the_cap() {
        let settings = AdaptiveSettings { samples_per_batch: 4, max_tolerance: 0.0 };
        assert_eq!(mean_of_stream(settings, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], Change::None).used, 6);
    }

    #[test]
    fn a_single_sample_is_no_interval() {
        let settings = AdaptiveSettings { samples_per_batch: 1, max_tolerance: 0.05 };
        assert_eq!(mean_of_stream(settings, &[1.0; 8], Change::None).used, 2);
    }
}
