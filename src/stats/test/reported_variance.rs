//! Variances that a renderer reports of its pixels, against those that its pictures have.
//!
//! Both are estimates, and of both only the mean over many pixels is used. They are compared by the
//! logarithm of their ratio to base 2: a factor of two either way is forgiven
//! ([`Band::FACTOR_OF_TWO`]). The logarithm of a ratio of means is too small by 0.7 over the degrees
//! of freedom of what is measured, which with a few hundred of them is nothing beside a band of 1.

use crate::stats::law::Spread;
use crate::stats::{Band, Claim};

/// No ratio counts for more: a reported 0 is wrong by this many powers of two, and not by infinity.
const LARGEST: f64 = 64.0;

/// What a renderer reports and what it does, over pictures that differ in nothing but their seed.
#[derive(Clone, Debug, Default)]
pub(crate) struct ReportedVariance {
    /// Of the values of pictures.
    spread: Spread,
    /// Means over pixels of what was reported, one for each picture and channel.
    reported: Vec<[f64; 3]>,
}

/// The two of one channel: means over pixels, of the variance of a pixel's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TwoVariances {
    /// As the renderer says.
    pub(crate) reported: f64,
    /// Between pictures.
    pub(crate) measured: f64,
    /// Mean of the values themselves.
    pub(crate) mean: f64,
}

impl ReportedVariance {
    /// Takes in a picture and the variances that came with it.
    pub(crate) fn push(&mut self, pixels: &[[f32; 3]], variances: &[[f32; 3]]) {
        let values: Vec<f64> = pixels.as_flattened().iter().map(|v| f64::from(*v)).collect();
        self.spread.push(&values);
        let mean = |channel: usize| {
            let sum: f64 = variances.iter().map(|variance| f64::from(variance[channel])).sum();
            sum / variances.len() as f64
        };
        self.reported.push([0, 1, 2].map(mean));
    }

    /// What was reported and what is so, channel by channel; NaN of fewer than two pictures.
    pub(crate) fn variances(&self) -> [TwoVariances; 3] {
        [0, 1, 2].map(|channel| {
            let pixels = (channel..self.spread.len()).step_by(3);
            let count = (self.spread.len() / 3) as f64;
            let of_pixels = pixels.clone().map(|index| self.spread.deviation(index).powi(2));
            let reported = self.reported.iter().map(|reported| reported[channel]);
            TwoVariances {
                reported: reported.sum::<f64>() / self.reported.len() as f64,
                measured: of_pixels.sum::<f64>() / count,
                mean: pixels.map(|index| self.spread.mean(index)).sum::<f64>() / count,
            }
        })
    }
}

impl TwoVariances {
    /// By how many powers of two too much is reported; 0 where both variances are 0.
    pub(crate) fn log_ratio(&self) -> f64 {
        if self.reported == 0.0 && self.measured == 0.0 {
            return 0.0;
        }
        (self.reported / self.measured).log2().clamp(-LARGEST, LARGEST)
    }

    pub(crate) fn mean_of(groups: &[Self]) -> Self {
        let mean =
            |part: fn(&Self) -> f64| groups.iter().map(part).sum::<f64>() / groups.len() as f64;
        Self {
            reported: mean(|group| group.reported),
            measured: mean(|group| group.measured),
            mean: mean(|group| group.mean),
        }
    }
}

impl Claim {
    /// A reported variance is the real one: the mean of [`TwoVariances::log_ratio`] is 0.
    pub(crate) fn reported_variance() -> Self {
        Self::difference(1.0, Band::FACTOR_OF_TWO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, Stream, uniform};
    use crate::stats::{Effort, MeanReport, Verdict, judge_means};

    /// Pixels that are means of 8 samples with the long tail of 1/u^0.25, and of each the variance of
    /// the mean by those samples.
    fn picture(stream: &mut Stream, factor: f64) -> [Vec<[f32; 3]>; 2] {
        let pixel = |stream: &mut Stream| {
            let samples: Vec<f64> = (0..8).map(|_| uniform(stream).powf(-0.25)).collect();
            let mean = samples.iter().sum::<f64>() / 8.0;
            let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
            [mean, factor * squares / 7.0 / 8.0].map(|value| [value as f32; 3])
        };
        let pixels: Vec<_> = (0..48).map(|_| pixel(stream)).collect();
        [0, 1].map(|part| pixels.iter().map(|pixel| pixel[part]).collect())
    }

    fn of_group(seed: Seed, factor: f64) -> TwoVariances {
        let mut stream = seed.stream();
        let mut group = ReportedVariance::default();
        for _ in 0..8 {
            let [pixels, variances] = picture(&mut stream, factor);
            group.push(&pixels, &variances);
        }
        group.variances()[0]
    }

    fn judge(factor: f64) -> MeanReport {
        let effort = Effort::new(1.4).with_runs(32).in_steps_of(8 * 48 * 8);
        judge_means(&[Claim::reported_variance()], &effort, &mut |draw| {
            Ok::<_, std::convert::Infallible>(vec![
                of_group(draw.seed(Seed(5)), factor).log_ratio(),
            ])
        })
        .unwrap()
        .remove(0)
    }

    #[test]
    fn the_logarithm_is_hardly_biased_although_both_are_estimates_with_long_tails() {
        let mean: f64 = (0..400).map(|n| of_group(Seed(n), 1.0).log_ratio()).sum::<f64>() / 400.0;
        assert!(mean.abs() < 0.05, "{mean}");
    }

    #[test]
    fn half_and_twice_are_forgiven_and_a_third_and_three_times_are_not() {
        for factor in [0.6, 1.0, 1.8] {
            assert_eq!(judge(factor).verdict, Verdict::Pass, "{factor}");
        }
        for factor in [0.0, 0.35, 3.0, f64::NAN] {
            assert_eq!(judge(factor).verdict, Verdict::Fail, "{factor}");
        }
    }

    #[test]
    fn by_hand() {
        let mut both = ReportedVariance::default();
        both.push(&[[1.0; 3], [5.0; 3]], &[[2.0; 3], [6.0; 3]]);
        both.push(&[[3.0; 3], [5.0; 3]], &[[2.0; 3], [6.0; 3]]);
        // Variances 2 and 0 between pictures, 2 and 6 reported.
        let found = both.variances()[2];
        assert_eq!((found.reported, found.mean), (4.0, 3.5));
        assert!((found.log_ratio() - 2.0).abs() < 1e-12, "{found:?}");
    }
}
