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

/// How pointed the distribution of runs is, pooled over stages: infinite variance shows in runs that few carry, and in
/// a spread that grows with their length.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tail {
    runs: f64,
    squares: f64,
    fourths: f64,
}

impl Tail {
    /// The means of one stage's runs, each over so many samples.
    pub(super) fn take(&mut self, means: &[f64], per_run: u64) {
        let mean = means.iter().copied().collect::<Moments>().mean();
        let squares = means.iter().map(|run| per_run as f64 * (run - mean).powi(2));
        self.runs += means.len() as f64;
        self.squares += squares.clone().sum::<f64>();
        self.fourths += squares.map(|square| square * square).sum::<f64>();
    }

    /// The kurtosis over that of normal runs; NaN of runs that are all the same.
    pub(super) fn pointedness(&self) -> f64 {
        self.runs * self.fourths / self.squares.powi(2) / 3.0
    }
}

/// The variance of one sample, from the spread of means over runs of `samples` in all.
pub(super) fn sample_variance(moments: &Moments, samples: u64) -> f64 {
    moments.variance() * samples as f64 / moments.count() as f64
}
