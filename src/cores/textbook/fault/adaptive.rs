//! Part 5: adaptive sampling and random numbers.

use super::faults;
use crate::cause::{adaptive, image, integrator};
use crate::contract::AdaptiveSettings;
use crate::cores::textbook as lesson;
use lesson::adaptive::{Tally, Z_95, squared_deviations};
use lesson::random::Random;
use std::time::SystemTime;

const NOISE: &str = "integrator/reported-variance-matches-the-noise";
const STREAMS: &str = "adaptive/known-streams-stop-where-the-rule-says";

faults! { part 5;
    "population-variance": "the variance is divided by n",
        fails STREAMS, told adaptive::POPULATION_VARIANCE,
        variance = |tally| squared_deviations(tally) / f64::from(tally.count);
    "sums-in-single": "s1 and s2 are floats, and σ² may be below 0",
        fails STREAMS, told adaptive::VARIANCE_BELOW_ZERO,
        count_in = count_in_single,
        variance = variance_in_single;
    "sigma-over-n": "1.96 σ/n",
        fails STREAMS, told adaptive::SIGMA_OVER_N,
        half_width = |variance, n| Z_95 * variance.sqrt() / n;
    "without-1-96": "σ/√n",
        fails STREAMS, told adaptive::WITHOUT_1_96,
        half_width = |variance, n| (variance / n).sqrt();
    "variance-for-sigma": "σ² for σ",
        fails STREAMS, told adaptive::VARIANCE_FOR_SIGMA,
        half_width = |variance, n| Z_95 * variance / n.sqrt();
    "half-width-squared": "(1.96 σ)²/n against the tolerance",
        fails STREAMS, told adaptive::HALF_WIDTH_SQUARED,
        half_width = |variance, n| Z_95 * Z_95 * variance / n;
    "tolerance-absolute": "the tolerance is not multiplied by the mean",
        fails STREAMS, told adaptive::TOLERANCE_ABSOLUTE,
        tolerance = |max_tolerance, _| max_tolerance;
    "count-one-short": "n is incremented after the test",
        fails STREAMS, told adaptive::COUNT_ONE_SHORT,
        variance = |tally| {
            let n = f64::from(tally.count) - 1.0;
            (tally.sum_of_squares - tally.sum * tally.sum / n) / (n - 1.0)
        };
    "looks-after-every-sample": "the rule is applied after every sample",
        fails STREAMS, told adaptive::LOOKS_AFTER_EVERY_SAMPLE,
        batch_size = |_| 1;
    "batch-ignored": "the batch is 32, whatever -a says",
        fails STREAMS, told adaptive::BATCH_IGNORED,
        batch_size = |_| 32;
    "rest-of-batch-dropped": "the loop runs over whole batches only",
        fails STREAMS, told adaptive::REST_OF_BATCH_DROPPED,
        sample_limit = |cap, batch| (cap - cap % batch).max(1);
    "divided-by-cap": "the sum is divided by ns_aa after an early stop",
        fails STREAMS, told adaptive::DIVIDED_BY_CAP,
        divisor = |_, cap| f64::from(cap);
    "divided-by-one-more": "the loop's counter is one past the samples",
        fails STREAMS, told image::DIVIDED_BY_ONE_MORE,
        divisor = |count, _| f64::from(count + 1);
    "counts-are-cap": "sampleCountBuffer says ns_aa everywhere",
        fails STREAMS, told adaptive::COUNTS_ARE_CAP,
        reported_count = |_, cap, _| cap;
    "count-without-last-batch": "sampleCountBuffer says n − batch",
        fails STREAMS, told adaptive::LAST_BATCH_NOT_COUNTED,
        reported_count = |count, _, batch| count.saturating_sub(batch.unwrap_or(0));
    "counts-one-more": "sampleCountBuffer says the loop's counter, which is one past the samples",
        fails "camera/constant-radiance-gives-a-constant-image", told image::COUNTS_OFF_BY_ONE,
        reported_count = |count, _, _| count + 1;
    "counts-one-less": "sampleCountBuffer says the number of the last sample, which counts from 0",
        fails "camera/constant-radiance-gives-a-constant-image", told image::COUNTS_OFF_BY_ONE,
        reported_count = |count, _, _| count.saturating_sub(1);
    "adaptive-always": "adaptive sampling is on by default",
        fails "camera/constant-radiance-gives-a-constant-image", told adaptive::ADAPTIVE_ALWAYS,
        adaptive_settings = |settings| settings.adaptive.or(ADAPTIVE_DEFAULT);
    "variance-of-sample": "the variance beside the picture is over n − 1, and not over n again",
        fails NOISE, told adaptive::VARIANCE_OF_SAMPLE,
        variance_of_mean = |squared_deviations, n| squared_deviations / (n - 1.0);
    "variance-divided-twice": "the variance beside the picture is divided by n twice",
        fails NOISE, told adaptive::DIVIDED_TWICE,
        variance_of_mean = |squared_deviations, n| squared_deviations / (n - 1.0) / n / n;
    "deviation-for-variance": "σ/√n stands beside the picture, its square belongs there",
        fails NOISE, told adaptive::DEVIATION_REPORTED,
        variance_of_mean = |squared_deviations, n| {
            (squared_deviations / (n - 1.0) / n).map(f64::sqrt)
        };
    "squares-not-divided": "Welford's M2 stands beside the picture as it is",
        fails NOISE, told adaptive::SQUARES_REPORTED,
        variance_of_mean = |squared_deviations, _| squared_deviations;
    "squares-in-single": "s1 and s2 of a pixel are floats",
        fails NOISE, told adaptive::SQUARES_CANCEL,
        add = |spread, radiance| {
            lesson::spread::add(spread, radiance);
            spread.sum = spread.sum.as_vec3().as_dvec3();
            spread.sum_of_squares = spread.sum_of_squares.as_vec3().as_dvec3();
        };
    "seed-ignored": "the generator has a fixed seed",
        fails "integrator/seeds-and-pixels-have-different-noise", told integrator::SEED_IGNORED,
        seed = |_| 0;
    "seed-of-clock": "the generator is seeded by the clock",
        fails "integrator/same-seed-gives-the-same-image", told integrator::NOT_REPRODUCIBLE,
        seed = |_| {
            let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
            now.map_or(0, |now| now.as_nanos() as u64)
        };
    "same-pixel-noise": "every pixel seeds the same stream",
        fails "integrator/seeds-and-pixels-have-different-noise",
        told integrator::PIXELS_SHARE_NOISE,
        sample_stream = |seed, _, sample| Random::for_sample(seed, 0, sample);
    "sample-repeated": "every sample of a pixel seeds the same stream",
        fails "integrator/error-falls-as-one-over-root-n", told integrator::SAMPLES_REPEAT,
        sample_stream = |seed, pixel, _| Random::for_sample(seed, pixel, 0);
}

/// What is done where adaptive sampling is not asked for.
const ADAPTIVE_DEFAULT: Option<AdaptiveSettings> =
    Some(AdaptiveSettings { samples_per_batch: 32, max_tolerance: 0.05 });

fn count_in_single(tally: &mut Tally, luminance: f64) {
    tally.count += 1;
    tally.sum = f64::from(tally.sum as f32 + luminance as f32);
    let squares = tally.sum_of_squares as f32 + (luminance * luminance) as f32;
    tally.sum_of_squares = f64::from(squares);
}

fn variance_in_single(tally: &Tally) -> f64 {
    let (sum, sum_of_squares) = (tally.sum as f32, tally.sum_of_squares as f32);
    let squared_deviations = sum_of_squares - sum * sum / tally.count as f32;
    f64::from(squared_deviations) / (f64::from(tally.count) - 1.0)
}
