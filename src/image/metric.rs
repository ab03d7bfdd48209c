//! Numbers that say how far apart two images are. They inform and never grade: a metric has no
//! null hypothesis.

use super::pair::{Pair, Values};
use super::{flip, ms_ssim, pixel_error, ssim};

/// A distance between an image and its reference, or a likeness.
pub struct Metric {
    /// As written in reports.
    pub name: &'static str,
    /// The number for two equal images.
    pub of_equals: f64,
    /// Whether it takes much longer than to read the images.
    pub is_slow: bool,
    /// Whether it says something of linear light alone: 8-bit images hold none beyond white.
    needs_radiance: bool,
    measure: fn(&Pair<'_>) -> f64,
}

/// Every metric.
pub static METRICS: &[Metric] = &[
    Metric::error("RMSE", pixel_error::root_mean_square),
    Metric::error("MAE", pixel_error::mean_absolute),
    Metric::radiance("relMSE", pixel_error::relative_mean_square),
    Metric::radiance("relMSE, trimmed", pixel_error::trimmed_relative_mean_square),
    Metric::radiance("SMAPE", pixel_error::symmetric_relative),
    Metric { of_equals: f64::INFINITY, ..Metric::error("PSNR", pixel_error::peak_signal_to_noise) },
    Metric { of_equals: 1.0, ..Metric::error("SSIM", ssim::structural_similarity) },
    Metric { of_equals: 1.0, ..Metric::error("MS-SSIM", ms_ssim::multi_scale_similarity) },
    Metric { is_slow: true, ..Metric::error("FLIP", flip::mean_flip) },
    Metric { is_slow: true, ..Metric::radiance("HDR-FLIP", flip::mean_high_dynamic_range_flip) },
];

impl Metric {
    /// One that is zero for equal images.
    const fn error(name: &'static str, measure: fn(&Pair<'_>) -> f64) -> Self {
        Self { name, of_equals: 0.0, is_slow: false, needs_radiance: false, measure }
    }

    /// The same of linear light alone.
    const fn radiance(name: &'static str, measure: fn(&Pair<'_>) -> f64) -> Self {
        Self { needs_radiance: true, ..Self::error(name, measure) }
    }

    /// Whether it says something of this pair.
    pub(crate) fn suits(&self, pair: &Pair<'_>) -> bool {
        !self.needs_radiance || pair.values == Values::Radiance
    }

    /// The number. A pixel that is not a number makes it NaN, or counts as the largest error there is.
    pub fn measure(&self, pair: &Pair<'_>) -> f64 {
        (self.measure)(pair)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;
    use std::collections::BTreeSet;

    #[test]
    fn every_metric_knows_equal_pictures_and_overlooks_no_nan() {
        let image = Image::from_fn(48, 32, |x, y| [x as f32 * 0.1, y as f32, 0.5]);
        let mut broken = image.clone();
        broken.pixels[700][1] = f32::NAN;
        for metric in METRICS {
            let measure = |image, reference| metric.measure(&Pair::new(image, reference).unwrap());
            let equals = metric.of_equals;
            let found = measure(&image, &image);
            assert!(found == equals || (found - equals).abs() < 1e-6, "{}", metric.name);
            for found in [measure(&broken, &image), measure(&image, &broken)] {
                assert!(found.is_nan() || found != equals, "{}: {found}", metric.name);
            }
        }
    }

    #[test]
    fn names_are_unique() {
        let names: BTreeSet<_> = METRICS.iter().map(|metric| metric.name).collect();
        assert_eq!(names.len(), METRICS.len());
    }
}
