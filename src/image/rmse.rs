//! Root mean square error.

use super::Image;
use super::metric::Metric;

/// Root of the mean over pixels and channels of the squared difference, in units of radiance.
pub(super) struct RootMeanSquare;

impl Metric for RootMeanSquare {
    fn name(&self) -> &'static str {
        "RMSE"
    }

    fn meaning(&self) -> &'static str {
        "root mean square error in units of radiance; halves with four times the samples"
    }

    fn measure(&self, image: &Image, reference: &Image) -> f64 {
        let values = image.pixels.as_flattened().iter().zip(reference.pixels.as_flattened());
        let squares: f64 = values.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
        (squares / (3 * image.pixels.len()) as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_channel_of_one_pixel_off_by_six_among_four_pixels() {
        let reference = Image::new(2, 2, [1.0; 3]);
        let mut image = reference.clone();
        image.pixels[3][2] += 6.0;
        // √(36 / 12)
        assert!((RootMeanSquare.measure(&image, &reference) - 3f64.sqrt()).abs() < 1e-12);
    }
}
