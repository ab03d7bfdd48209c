//! Numbers that say how far apart two pictures are. They inform and never grade: a metric has no
//! null hypothesis.

use super::relmse::RelativeMeanSquare;
use super::rmse::RootMeanSquare;
use super::{Image, ImageError};

/// A distance between a picture and its reference.
pub trait Metric: Sync {
    /// As written in reports.
    fn name(&self) -> &'static str;
    /// What a larger or smaller number means, in a sentence.
    fn meaning(&self) -> &'static str;
    /// The number, for pictures of the same size. NaN where a pixel is NaN.
    fn measure(&self, image: &Image, reference: &Image) -> f64;
}

/// Every metric.
pub static METRICS: &[&dyn Metric] = &[&RootMeanSquare, &RelativeMeanSquare];

/// A metric's name and number.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Of the metric.
    pub name: &'static str,
    /// The number.
    pub value: f64,
}

/// Every metric of a pair of pictures of the same size.
pub fn measure_all(image: &Image, reference: &Image) -> Result<Vec<Measured>, ImageError> {
    if !image.same_size(reference) {
        return Err(ImageError::WrongLength {
            channel: "R".to_owned(),
            values: image.pixels.len(),
            pixels: reference.pixels.len(),
        });
    }
    let measured = METRICS
        .iter()
        .map(|metric| Measured { name: metric.name(), value: metric.measure(image, reference) });
    Ok(measured.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metric_is_zero_for_equal_pictures_and_nan_for_nan() {
        let image = Image::from_fn(16, 16, |x, y| [x as f32, y as f32, 0.5]);
        let mut broken = image.clone();
        broken.pixels[100][1] = f32::NAN;
        for metric in METRICS {
            assert_eq!(metric.measure(&image, &image), 0.0, "{}", metric.name());
            assert!(metric.measure(&broken, &image).is_nan(), "{}", metric.name());
        }
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = METRICS.iter().map(|metric| metric.name()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), METRICS.len());
    }

    #[test]
    fn pictures_of_different_size_have_no_distance() {
        let (small, large) = (Image::new(2, 2, [0.0; 3]), Image::new(4, 4, [0.0; 3]));
        assert!(measure_all(&small, &large).is_err());
    }
}
