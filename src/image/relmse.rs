//! Relative mean square error, with and without the fireflies that drown everything else.

use super::metric::Metric;
use super::pair::Pair;

/// Keeps dark pixels from dividing by nothing (Rousselle et al., "Adaptive Sampling and
/// Reconstruction using Greedy Error Minimization", 2011).
const REGULARISER: f64 = 0.01;
/// Share of the worst pixels left out.
const TRIMMED: f64 = 0.001;

/// Mean over pixels and channels of (a − b)² / (b² + 0.01).
pub(super) struct RelativeMeanSquare;

/// The same, the worst 0.1 % of pixels left out.
pub(super) struct TrimmedRelativeMeanSquare;

impl Metric for RelativeMeanSquare {
    fn name(&self) -> &'static str {
        "relMSE"
    }

    fn meaning(&self) -> &'static str {
        "mean square error relative to the reference; a single firefly can decide it"
    }

    fn measure(&self, pair: &Pair<'_>) -> f64 {
        pair.mean(pixel_error)
    }
}

impl Metric for TrimmedRelativeMeanSquare {
    fn name(&self) -> &'static str {
        "relMSE, trimmed"
    }

    fn meaning(&self) -> &'static str {
        "mean square error relative to the reference, without the worst 0.1 % of pixels"
    }

    fn measure(&self, pair: &Pair<'_>) -> f64 {
        let mut errors = pair.each(pixel_error);
        if errors.iter().any(|error| error.is_nan()) {
            return f64::NAN;
        }
        let kept = errors.len() - (TRIMMED * errors.len() as f64) as usize;
        errors.select_nth_unstable_by(kept - 1, f64::total_cmp);
        // In the order that selection leaves: the same every time for the same pictures.
        errors[..kept].iter().sum::<f64>() / kept as f64
    }
}

fn pixel_error(pixel: [f32; 3], reference: [f32; 3]) -> f64 {
    let channel = |i: usize| {
        let (a, b) = (f64::from(pixel[i]), f64::from(reference[i]));
        (a - b).powi(2) / (b * b + REGULARISER)
    };
    (0..3).map(channel).sum::<f64>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;

    #[test]
    fn ten_per_cent_everywhere_is_about_a_hundredth_whatever_the_brightness() {
        for level in [10.0, 1000.0] {
            let reference = Image::new(8, 8, [level; 3]);
            let image = Image::new(8, 8, [1.1 * level; 3]);
            let found = RelativeMeanSquare.measure(&Pair::new(&image, &reference).unwrap());
            assert!((found - 0.01).abs() < 1e-4, "{found}");
        }
    }

    #[test]
    fn one_firefly_in_two_thousand_pixels_does_not_count() {
        let reference = Image::new(50, 40, [1.0; 3]);
        let mut image = reference.clone();
        image.pixels[17] = [1e6; 3];
        let pair = Pair::new(&image, &reference).unwrap();
        assert_eq!(TrimmedRelativeMeanSquare.measure(&pair), 0.0);
        assert!(RelativeMeanSquare.measure(&pair) > 1e8);
    }
}
