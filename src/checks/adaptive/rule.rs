//! The course's stopping rule, and the rules that common mistakes amount to.

use crate::cause::{Cause, adaptive};

/// The number of a normal distribution's standard deviations that hold 95 %.
const NORMAL_95: f64 = 1.96;

/// A stopping rule: whether to stop after these samples.
pub(crate) type Rule = fn(&Sums, f64) -> bool;

/// The mistakes that students make in the rule, each with the rule it amounts to.
pub(crate) const WRONG_RULES: &[(&Cause, Rule)] = &[
    (&adaptive::POPULATION_VARIANCE, |s, tolerance| {
        NORMAL_95 * (s.population_variance() / s.n).sqrt() <= tolerance * s.mean()
    }),
    (&adaptive::SIGMA_OVER_N, |s, tolerance| {
        NORMAL_95 * s.variance().sqrt() / s.n <= tolerance * s.mean()
    }),
    (&adaptive::WITHOUT_1_96, |s, tolerance| (s.variance() / s.n).sqrt() <= tolerance * s.mean()),
    (&adaptive::VARIANCE_FOR_SIGMA, |s, tolerance| {
        NORMAL_95 * s.variance() / s.n.sqrt() <= tolerance * s.mean()
    }),
    (&adaptive::TOLERANCE_ABSOLUTE, |s, tolerance| {
        NORMAL_95 * (s.variance() / s.n).sqrt() <= tolerance
    }),
    (&adaptive::COUNT_ONE_SHORT, |s, tolerance| {
        let variance = (s.squares - s.sum * s.sum / (s.n - 1.0)) / (s.n - 2.0);
        NORMAL_95 * (variance / s.n).sqrt() <= tolerance * s.mean()
    }),
    (&adaptive::NEVER_STOPS, |_, _| false),
];

/// The course's rule.
pub(crate) fn stops(sums: &Sums, tolerance: f64) -> bool {
    NORMAL_95 * (sums.variance() / sums.n).sqrt() <= tolerance * sums.mean()
}

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
