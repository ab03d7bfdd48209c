//! The course's stopping rule, and the rules that common mistakes amount to.

use crate::cause::{Cause, adaptive};

/// The number of a normal distribution's standard deviations that hold 95 %.
const NORMAL_95: f64 = 1.96;

/// Whether to stop after some samples, step by step.
#[derive(Clone, Copy)]
pub(crate) struct Rule {
    variance: fn(&Sums) -> f64,
    /// Half the width of the interval of the mean, from the variance and the number of samples.
    half_width: fn(f64, f64) -> f64,
    /// What that may be, from the tolerance and the mean.
    limit: fn(f64, f64) -> f64,
}

impl Rule {
    /// The course's rule.
    pub(crate) const RIGHT: Self = Self {
        variance: Sums::variance,
        half_width: |variance, n| NORMAL_95 * (variance / n).sqrt(),
        limit: |tolerance, mean| tolerance * mean,
    };

    pub(crate) fn stops(&self, sums: &Sums, tolerance: f64) -> bool {
        let half_width = (self.half_width)((self.variance)(sums), sums.n);
        half_width <= (self.limit)(tolerance, sums.mean())
    }

    /// The tolerance with which the course's rule stops such samples after about so many.
    pub(crate) fn tolerance_to_stop_after(count: f64, samples: &Sums) -> f64 {
        NORMAL_95 * (samples.variance() / count).sqrt() / samples.mean()
    }
}

/// What a mistake makes of a rule.
pub(crate) type InRule = fn(Rule) -> Rule;

/// The mistakes that students make in the rule.
pub(crate) const WRONG_RULES: &[(&Cause, InRule)] = &[
    (&adaptive::POPULATION_VARIANCE, |rule| Rule { variance: Sums::population_variance, ..rule }),
    (&adaptive::SIGMA_OVER_N, |rule| Rule {
        half_width: |variance, n| NORMAL_95 * variance.sqrt() / n,
        ..rule
    }),
    (&adaptive::WITHOUT_1_96, |rule| Rule {
        half_width: |variance, n| (variance / n).sqrt(),
        ..rule
    }),
    (&adaptive::VARIANCE_FOR_SIGMA, |rule| Rule {
        half_width: |variance, n| NORMAL_95 * variance / n.sqrt(),
        ..rule
    }),
    (&adaptive::HALF_WIDTH_SQUARED, |rule| Rule {
        half_width: |variance, n| NORMAL_95 * NORMAL_95 * variance / n,
        ..rule
    }),
    (&adaptive::TOLERANCE_ABSOLUTE, |rule| Rule { limit: |tolerance, _| tolerance, ..rule }),
    (&adaptive::COUNT_ONE_SHORT, |rule| Rule {
        variance: |s| (s.squares - s.sum * s.sum / (s.n - 1.0)) / (s.n - 2.0),
        ..rule
    }),
    // Nothing is at most NaN.
    (&adaptive::NEVER_STOPS, |rule| Rule { limit: |_, _| f64::NAN, ..rule }),
];

/// What the rule needs of the samples so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Sums {
    pub(crate) fn of(samples: &[f64]) -> Self {
        let squares = samples.iter().map(|x| x * x).sum();
        Self { n: samples.len() as f64, sum: samples.iter().sum(), squares }
    }

    /// Of `n` samples of which `highs` have the value `high`, and the others `low`.
    pub(crate) fn of_two_values(n: usize, highs: usize, low: f64, high: f64) -> Self {
        let (lows, highs) = ((n - highs) as f64, highs as f64);
        let squares = lows * low * low + highs * high * high;
        Self { n: n as f64, sum: lows * low + highs * high, squares }
    }

    pub(crate) fn push(&mut self, sample: f64) {
        self.n += 1.0;
        self.sum += sample;
        self.squares += sample * sample;
    }

    pub(crate) fn mean(&self) -> f64 {
        self.sum / self.n
    }

    fn population_variance(&self) -> f64 {
        (self.squares / self.n - self.mean() * self.mean()).max(0.0)
    }

    fn variance(&self) -> f64 {
        self.population_variance() * self.n / (self.n - 1.0)
    }
}
