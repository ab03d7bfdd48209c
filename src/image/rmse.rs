//! Root mean square error.

use super::metric::Metric;
use super::pair::Pair;

/// Root of the mean over pixels and channels of the squared difference, in units of radiance.
pub(super) struct RootMeanSquare;

impl Metric for RootMeanSquare {
    fn name(&self) -> &'static str {
        "RMSE"
    }

    fn meaning(&self) -> &'static str {
        "root mean square error in units of radiance; halves with four times the samples"
    }

    fn measure(&self, pair: &Pair<'_>) -> f64 {
        let square = |a: f32, b: f32| (f64::from(a) - f64::from(b)).powi(2);
        let pixel = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| square(a[i], b[i])).sum::<f64>();
        (pair.mean(pixel) / 3.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;

    #[test]
    fn one_channel_of_one_pixel_off_by_six_among_four_pixels() {
        let reference = Image::new(2, 2, [1.0; 3]);
        let mut image = reference.clone();
        image.pixels[3][2] += 6.0;
        let found = RootMeanSquare.measure(&Pair::new(&image, &reference).unwrap());
        // √(36 / 12)
        assert!((found - 3f64.sqrt()).abs() < 1e-12);
    }
}
