//! Numbers that say how far apart two pictures are. They inform and never grade: a metric has no
//! null hypothesis.

use super::flip::{Flip, HighDynamicRangeFlip};
use super::mae::MeanAbsolute;
use super::ms_ssim::MultiScaleSimilarity;
use super::pair::Pair;
use super::psnr::PeakSignalToNoise;
use super::relmse::{RelativeMeanSquare, TrimmedRelativeMeanSquare};
use super::rmse::RootMeanSquare;
use super::smape::SymmetricRelative;
use super::ssim::StructuralSimilarity;

/// A distance between a picture and its reference, or a likeness.
pub trait Metric: Sync {
    /// As written in reports.
    fn name(&self) -> &'static str;
    /// What a larger or smaller number means, in a sentence.
    fn meaning(&self) -> &'static str;
    /// The number for two equal pictures.
    fn of_equals(&self) -> f64 {
        0.0
    }
    /// Whether it takes much longer than to read the pictures.
    fn is_slow(&self) -> bool {
        false
    }
    /// The number. A pixel that is no number makes it NaN, or counts as the largest error there is.
    fn measure(&self, pair: &Pair<'_>) -> f64;
}

/// Every metric.
pub static METRICS: &[&dyn Metric] = &[
    &RootMeanSquare,
    &MeanAbsolute,
    &RelativeMeanSquare,
    &TrimmedRelativeMeanSquare,
    &SymmetricRelative,
    &PeakSignalToNoise,
    &StructuralSimilarity,
    &MultiScaleSimilarity,
    &Flip,
    &HighDynamicRangeFlip,
];

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
            let equals = metric.of_equals();
            let found = measure(&image, &image);
            assert!(found == equals || (found - equals).abs() < 1e-6, "{}", metric.name());
            for found in [measure(&broken, &image), measure(&image, &broken)] {
                assert!(found.is_nan() || found != equals, "{}: {found}", metric.name());
            }
        }
    }

    #[test]
    fn names_are_unique() {
        let names: BTreeSet<_> = METRICS.iter().map(|metric| metric.name()).collect();
        assert_eq!(names.len(), METRICS.len());
    }
}
