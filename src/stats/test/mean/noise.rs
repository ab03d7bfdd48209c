//! What a test of means knows of the spread of single samples.

use crate::stats::Moments;

/// The variance of one sample, pooled over stages.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Noise {
    pub(super) freedom: f64,
    weighted_variance: f64,
}

impl Noise {
    pub(super) fn take(&mut self, moments: &Moments, samples: u64) {
        let freedom = (moments.count() - 1) as f64;
        self.weighted_variance += freedom * sample_variance(moments, samples);
        self.freedom += freedom;
    }

    pub(super) fn variance(&self) -> f64 {
        self.weighted_variance / self.freedom
    }
}

/// The variance of one sample, from the spread of means over runs of `samples` in all.
pub(super) fn sample_variance(moments: &Moments, samples: u64) -> f64 {
    moments.variance() * samples as f64 / moments.count() as f64
}
