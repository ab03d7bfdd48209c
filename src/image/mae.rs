//! Mean absolute error.

use super::metric::Metric;
use super::pair::Pair;

/// Mean over pixels and channels of the absolute difference, in units of radiance.
pub(super) struct MeanAbsolute;

impl Metric for MeanAbsolute {
    fn name(&self) -> &'static str {
        "MAE"
    }

    fn meaning(&self) -> &'static str {
        "mean absolute error in units of radiance; a few very wrong pixels move it less than RMSE"
    }

    fn measure(&self, pair: &Pair<'_>) -> f64 {
        let absolute = |a: f32, b: f32| (f64::from(a) - f64::from(b)).abs();
        let pixel = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| absolute(a[i], b[i])).sum::<f64>();
        pair.mean(pixel) / 3.0
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
        image.pixels[1][0] -= 6.0;
        let found = MeanAbsolute.measure(&Pair::new(&image, &reference).unwrap());
        assert!((found - 0.5).abs() < 1e-12);
    }
}
