//! Metrics that add up what each pixel is off by.

use super::pair::Pair;
use super::ssim::mean_of_planes;

/// Keeps dark pixels from dividing by nothing in a relative square (Rousselle et al., "Adaptive Sampling and
/// Reconstruction using Greedy Error Minimization", 2011).
const OF_SQUARES: f64 = 0.01;
/// Keeps two black pixels from dividing nothing by nothing in a symmetric ratio.
const OF_SUMS: f64 = 0.01;
/// Share of the worst pixels that a trimmed mean leaves out.
const TRIMMED: f64 = 0.001;

/// Mean over pixels and channels of |a − b|, in units of radiance, or of codes over the largest. A few very wrong pixels move it less than the root
/// mean square.
pub(super) fn mean_absolute(pair: &Pair<'_>) -> f64 {
    mean(pair, |a, b| (a - b).abs())
}

/// Root of the mean over pixels and channels of (a − b)², in the same units. Halves with four times the samples.
pub(super) fn root_mean_square(pair: &Pair<'_>) -> f64 {
    mean(pair, |a, b| (a - b).powi(2)).sqrt()
}

/// Mean over pixels and channels of (a − b)² / (b² + 0.01). A single firefly can decide it.
pub(super) fn relative_mean_square(pair: &Pair<'_>) -> f64 {
    pair.mean(relative_square)
}

/// The same, the worst 0.1 % of pixels left out.
pub(super) fn trimmed_relative_mean_square(pair: &Pair<'_>) -> f64 {
    let mut errors = pair.each(relative_square);
    if errors.iter().any(|error| error.is_nan()) {
        return f64::NAN;
    }
    let kept = errors.len() - (TRIMMED * errors.len() as f64) as usize;
    errors.select_nth_unstable_by(kept - 1, f64::total_cmp);
    // In the order that selection leaves: the same every time for the same images.
    errors[..kept].iter().sum::<f64>() / kept as f64
}

/// Symmetric mean absolute percentage error: mean over pixels and channels of |a − b| / (|a| + |b| + 0.01), from 0
/// to 1. Too dark and too bright weigh alike.
pub(super) fn symmetric_relative(pair: &Pair<'_>) -> f64 {
    mean(pair, |a, b| (a - b).abs() / (a.abs() + b.abs() + OF_SUMS))
}

/// Peak signal-to-noise ratio, decibels: white squared over the mean squared difference, both images as a screen
/// shows them: codes as they are, radiance in grey. More is better.
pub(super) fn peak_signal_to_noise(pair: &Pair<'_>) -> f64 {
    let mean_square = mean_of_planes(pair, |image, reference| {
        let pairs = image.values.iter().zip(&reference.values);
        let squares: f64 = pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
        squares / image.values.len() as f64
    });
    -10.0 * mean_square.log10()
}

fn mean(pair: &Pair<'_>, error: impl Fn(f64, f64) -> f64 + Sync) -> f64 {
    pair.mean(|a, b| sum(a, b, &error)) / 3.0
}

fn relative_square(pixel: [f32; 3], reference: [f32; 3]) -> f64 {
    sum(pixel, reference, |a, b| (a - b).powi(2) / (b * b + OF_SQUARES)) / 3.0
}

fn sum(pixel: [f32; 3], reference: [f32; 3], error: impl Fn(f64, f64) -> f64) -> f64 {
    (0..3).map(|c| error(f64::from(pixel[c]), f64::from(reference[c]))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;
    use crate::image::tonemap::encode_srgb;

    type Metric = fn(&Pair<'_>) -> f64;

    fn between(metric: Metric, level: f32, reference: f32) -> f64 {
        let [image, reference] = [level, reference].map(|level| Image::new(8, 8, [level; 3]));
        metric(&Pair::new(&image, &reference).unwrap())
    }

    #[test]
    fn one_channel_of_one_pixel_off_by_six_among_four_pixels() {
        let reference = Image::new(2, 2, [1.0; 3]);
        let mut image = reference.clone();
        image.pixels[3][2] += 6.0;
        let pair = Pair::new(&image, &reference).unwrap();
        assert!((mean_absolute(&pair) - 6.0 / 12.0).abs() < 1e-12);
        assert!((root_mean_square(&pair) - (36.0 / 12.0f64).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn ten_per_cent_everywhere_is_about_a_hundredth_whatever_the_brightness() {
        for level in [10.0, 1000.0] {
            let found = between(relative_mean_square, 1.1 * level, level);
            assert!((found - 0.01).abs() < 1e-4, "{found}");
        }
    }

    #[test]
    fn one_firefly_in_two_thousand_pixels_does_not_count() {
        let reference = Image::new(50, 40, [1.0; 3]);
        let mut image = reference.clone();
        image.pixels[17] = [1e6; 3];
        let pair = Pair::new(&image, &reference).unwrap();
        assert_eq!(trimmed_relative_mean_square(&pair), 0.0);
        assert!(relative_mean_square(&pair) > 1e8);
    }

    #[test]
    fn half_and_double_are_equally_far() {
        // 0.5 / 1.51 and 1 / 3.01
        assert!((between(symmetric_relative, 0.5, 1.0) - 0.331_125_8).abs() < 1e-6);
        assert!((between(symmetric_relative, 2.0, 1.0) - 0.332_225_9).abs() < 1e-6);
    }

    #[test]
    fn twice_the_light_is_off_by_what_the_curve_makes_of_it() {
        let found = between(peak_signal_to_noise, 0.5, 1.0);
        let difference = f64::from(encode_srgb(0.8) - encode_srgb(0.4));
        assert!((found + 20.0 * difference.log10()).abs() < 1e-3, "{found}");
    }
}
