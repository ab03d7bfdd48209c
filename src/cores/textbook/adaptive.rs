//! Part 5: how many samples a pixel needs.

use super::steps::Steps;
use crate::contract::{AdaptiveMean, AdaptiveSettings};

/// Half width of the 95 % interval of a normal variable, in standard deviations.
pub(crate) const Z_95: f64 = 1.96;

/// The sums a pixel keeps: s₁ and s₂ of the course.
///
/// The textbook formula for the variance loses digits where σ is far below μ; a rule that compares
/// σ with a few percent of μ cannot notice.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) count: u32,
    /// s₁, of their luminances.
    pub(crate) sum: f64,
    /// s₂.
    pub(crate) sum_of_squares: f64,
}

pub(crate) fn count_in(tally: &mut Tally, luminance: f64) {
    tally.count += 1;
    tally.sum += luminance;
    tally.sum_of_squares += luminance * luminance;
}

/// Sample variance: over n − 1, not a number for a single sample.
pub(crate) fn variance(tally: &Tally) -> f64 {
    let n = f64::from(tally.count);
    squared_deviations(tally) / (n - 1.0)
}

/// From the mean.
pub(crate) fn squared_deviations(tally: &Tally) -> f64 {
    (tally.sum_of_squares - tally.sum * tally.sum / f64::from(tally.count)).max(0.0)
}

/// Half width of the 95 % interval of the mean of `n` samples.
pub(crate) fn half_width(variance: f64, n: f64) -> f64 {
    Z_95 * (variance / n).sqrt()
}

pub(crate) fn tolerance(max_tolerance: f64, mean: f64) -> f64 {
    max_tolerance * mean
}

/// Whether the mean is known well enough. A black pixel is; a pixel that is not a number never is.
fn has_converged(tally: &Tally, max_tolerance: f64, steps: &Steps) -> bool {
    let n = f64::from(tally.count);
    let half_width = steps.half_width(steps.variance(tally), n);
    half_width <= steps.tolerance(max_tolerance, tally.sum / n)
}

/// Draws luminances from `next` until the rule says stop, at most `cap` of them.
pub(crate) fn sample_until_converged(
    settings: AdaptiveSettings,
    cap: u32,
    steps: &Steps,
    mut next: impl FnMut(u32) -> f64,
) -> Tally {
    let batch = steps.batch_size(settings);
    let limit = steps.sample_limit(cap, batch);
    let mut tally = Tally::default();
    while tally.count < limit {
        let luminance = next(tally.count);
        steps.count_in(&mut tally, luminance);
        let ends_batch = tally.count.is_multiple_of(batch);
        if ends_batch && has_converged(&tally, settings.max_tolerance, steps) {
            break;
        }
    }
    tally
}

/// The rule is applied after so many samples, and so many more.
pub(crate) fn batch_size(settings: AdaptiveSettings) -> u32 {
    settings.samples_per_batch.max(1)
}

/// All samples of the cap may be drawn; the last batch may be a part of one.
pub(crate) fn sample_limit(cap: u32, _batch: u32) -> u32 {
    cap
}

/// Draws all `cap` luminances: what adaptive sampling is compared with.
pub(crate) fn sample_all(cap: u32, steps: &Steps, next: impl FnMut(u32) -> f64) -> Tally {
    let mut tally = Tally::default();
    (0..cap).map(next).for_each(|luminance| steps.count_in(&mut tally, luminance));
    tally
}

/// What the sum of `count` samples is divided by.
pub(crate) fn divisor(count: u32, _cap: u32) -> f64 {
    f64::from(count)
}

/// How many samples a pixel says it has taken. Without a batch it has taken them all.
pub(crate) fn reported_count(count: u32, _cap: u32, _batch: Option<u32>) -> u32 {
    count
}

/// What the rule makes of a given stream, which is as long as the cap.
pub(crate) fn mean_of_stream(
    settings: AdaptiveSettings,
    stream: &[f64],
    steps: &Steps,
) -> AdaptiveMean {
    let cap = u32::try_from(stream.len()).unwrap_or(u32::MAX);
    let mut total = 0.0;
    let tally = sample_until_converged(settings, cap, steps, |index| {
        total += stream[index as usize];
        stream[index as usize]
    });
    let mean = total / steps.divisor(tally.count, cap);
    let used = steps.reported_count(tally.count, cap, Some(settings.samples_per_batch));
    AdaptiveMean { mean, used, reserved: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;

    fn run(period: &[f64], samples_per_batch: u32, max_tolerance: f64) -> AdaptiveMean {
        let stream: Vec<f64> = period.iter().copied().cycle().take(2048).collect();
        mean_of_stream(AdaptiveSettings { samples_per_batch, max_tolerance }, &stream, &LESSON)
    }

    #[test]
    fn a_black_pixel_stops_and_one_that_is_not_a_number_does_not() {
        assert_eq!(run(&[0.0], 32, 0.05).used, 32);
        assert_eq!(run(&[f64::NAN], 32, 0.05).used, 2048);
    }

    #[test]
    fn the_last_batch_is_cut_off_at_the_cap() {
        let settings = AdaptiveSettings { samples_per_batch: 4, max_tolerance: 0.0 };
        assert_eq!(mean_of_stream(settings, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], &LESSON).used, 6);
    }

    #[test]
    fn a_single_sample_is_no_interval() {
        let settings = AdaptiveSettings { samples_per_batch: 1, max_tolerance: 0.05 };
        assert_eq!(mean_of_stream(settings, &[1.0; 8], &LESSON).used, 2);
    }
}
