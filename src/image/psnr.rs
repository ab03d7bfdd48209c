//! Peak signal-to-noise ratio.

use super::metric::Metric;
use super::pair::Pair;

/// Ten times the decimal logarithm of white squared over the mean squared difference, both pictures
/// as a screen shows them in grey.
pub(super) struct PeakSignalToNoise;

impl Metric for PeakSignalToNoise {
    fn name(&self) -> &'static str {
        "PSNR"
    }

    fn meaning(&self) -> &'static str {
        "white over the difference as a screen shows both, decibels; more is better, infinite if equal"
    }

    fn of_equals(&self) -> f64 {
        f64::INFINITY
    }

    fn measure(&self, pair: &Pair<'_>) -> f64 {
        let [image, reference] = pair.grey();
        let pairs = image.values.iter().zip(&reference.values);
        let squares: f64 = pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
        -10.0 * (squares / image.values.len() as f64).log10()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;
    use crate::image::tonemap::encode_srgb;

    #[test]
    fn twice_the_light_is_off_by_what_the_curve_makes_of_it() {
        let (dim, grey) = (Image::new(4, 4, [0.5; 3]), Image::new(4, 4, [1.0; 3]));
        let found = PeakSignalToNoise.measure(&Pair::new(&dim, &grey).unwrap());
        let difference = f64::from(encode_srgb(0.8) - encode_srgb(0.4));
        assert!((found + 20.0 * difference.log10()).abs() < 1e-3, "{found}");
    }
}
