//! Where an adaptive stopping rule stops, and what it makes of the mean: the exact law, for streams
//! of two values.
//!
//! A rule that looks at the samples so far may stop because they happen to be alike, so the mean
//! it returns is biased by construction: a pixel that is lit once in a hundred samples comes out 71
//! % too dark under the course's rule. Comparing it with the true mean would fail a correct core;
//! here is what a correct core's mean is instead.
//!
//! The samples so far are summed up by how many of them were high: dynamic programming over that
//! count, batch by batch, gives the law to rounding.

use super::CellProbabilities;
use crate::math::quadrature::Integral;

/// A stream of independent samples that are either low or high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoValues {
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// The probability of `high`.
    pub(crate) chance: f64,
}

/// When a rule stops, and with what mean.
#[derive(Clone, Debug, PartialEq)]
pub struct StoppingLaw {
    /// The probability of stopping after n samples, for n from 0 to the cap.
    pub(crate) stops: Vec<f64>,
    /// Expectation of the returned mean.
    pub(crate) mean: f64,
    /// Standard deviation of the returned mean.
    pub(crate) deviation: f64,
}

impl TwoValues {
    pub(crate) fn mean(&self) -> f64 {
        self.low + self.chance * (self.high - self.low)
    }

    /// The mean of n samples of which some were high.
    fn mean_of(&self, n: usize, highs: usize) -> f64 {
        self.low + (self.high - self.low) * highs as f64 / n as f64
    }

    /// The probability of each number of high samples among n.
    fn binomial(&self, n: usize) -> Vec<f64> {
        let (mut one_more, others) = (Vec::from([1.0]), 1.0 - self.chance);
        for _ in 0..n {
            one_more = convolved(&one_more, &[others, self.chance]);
        }
        one_more
    }
}

impl StoppingLaw {
    /// Of a rule that looks after every `batch` samples, up to `cap`, and is asked for the number of
    /// samples and of high ones among them.
    pub(crate) fn new(
        stream: TwoValues,
        batch: usize,
        cap: usize,
        rule: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let batch = batch.clamp(1, cap.max(1));
        let whole_batch = stream.binomial(batch);
        let mut stops = vec![0.0; cap + 1];
        let (mut first_moment, mut second_moment) = (0.0, 0.0);
        // The probability of having come to this look with so many high samples.
        let mut going = Vec::from([1.0]);
        let mut n = 0;
        while n < cap {
            let step = batch.min(cap - n);
            let law = if step == batch { &whole_batch } else { &stream.binomial(step) };
            going = convolved(&going, law);
            n += step;
            for (highs, probability) in going.iter_mut().enumerate() {
                if n == cap || rule(n, highs) {
                    let mean = stream.mean_of(n, highs);
                    stops[n] += *probability;
                    first_moment += *probability * mean;
                    second_moment += *probability * mean * mean;
                    *probability = 0.0;
                }
            }
        }
        let variance = (second_moment - first_moment * first_moment).max(0.0);
        Self { stops, mean: first_moment, deviation: variance.sqrt() }
    }

    pub(crate) fn expected_count(&self) -> f64 {
        self.stops.iter().enumerate().map(|(n, probability)| n as f64 * probability).sum()
    }

    /// As cells to count in: cell n is stopping after n samples. How far it is from `other` bounds
    /// the error of each, where the two are the same law but for rounding.
    pub(crate) fn cells(&self, other: &Self) -> CellProbabilities {
        let pairs = self.stops.iter().zip(&other.stops);
        let cell = |(p, q): (&f64, &f64)| Integral { value: *p, error: (p - q).abs() };
        CellProbabilities::new(pairs.map(cell).collect())
    }
}

/// The law of a sum. Terms that have died out are skipped.
fn convolved(law: &[f64], step: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; law.len() + step.len() - 1];
    for (i, p) in law.iter().enumerate().filter(|(_, p)| **p > 0.0) {
        for (j, q) in step.iter().enumerate() {
            sum[i + j] += p * q;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    /// The course's rule.
    fn law(low: f64, chance: f64) -> StoppingLaw {
        let stream = TwoValues { low, high: 1.0, chance };
        StoppingLaw::new(stream, 32, 2048, |n, highs| stops(stream, n, highs))
    }

    fn stops(stream: TwoValues, n: usize, highs: usize) -> bool {
        let (count, high) = (n as f64, highs as f64);
        let spread = (stream.high - stream.low).powi(2);
        let variance = spread * high * (count - high) / (count * (count - 1.0));
        1.96 * (variance / count).sqrt() <= 0.05 * stream.mean_of(n, highs)
    }

    /// Computed by another program, in another language, from binomial coefficients.
    #[test]
    fn the_laws_are_those_of_the_table() {
        for (low, chance, count, bias) in [
            (0.0, 0.01, 586.4, -0.713_65),
            (0.0, 0.05, 1657.5, -0.190_68),
            (0.0, 0.2, 2046.4, -0.000_78),
            (0.0, 0.5, 1554.4, 0.001_28),
            (0.0, 0.8, 398.5, 0.003_46),
            (0.0, 0.95, 90.0, 0.011_50),
            (0.2, 0.03, 372.2, -0.041_50),
        ] {
            let law = law(low, chance);
            let truth = low + (1.0 - low) * chance;
            assert!((law.expected_count() - count).abs() < 0.051, "{chance}: {law:?}");
            assert!((law.mean / truth - 1.0 - bias).abs() < 6e-6, "{chance}: {}", law.mean);
            assert!((law.stops.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_law_is_that_of_simulated_streams() {
        let stream = TwoValues { low: 0.2, high: 1.0, chance: 0.3 };
        let (batch, cap) = (20, 130);
        let rule = |n: usize, highs: usize| (n + 7 * highs).is_multiple_of(3);
        let law = StoppingLaw::new(stream, batch, cap, rule);
        let mut draws = Seed(5).stream();
        let runs = 40_000;
        let (mut counts, mut means) = (vec![0.0; cap + 1], 0.0);
        for _ in 0..runs {
            let (mut n, mut highs) = (0, 0);
            loop {
                let step = batch.min(cap - n);
                highs += (0..step).filter(|_| uniform(&mut draws) < stream.chance).count();
                n += step;
                if n == cap || rule(n, highs) {
                    break;
                }
            }
            counts[n] += 1.0 / f64::from(runs);
            means += stream.mean_of(n, highs) / f64::from(runs);
        }
        // Five standard errors of a share, and of the mean.
        for (n, (found, expected)) in counts.iter().zip(&law.stops).enumerate() {
            assert!((found - expected).abs() < 5.0 * 0.5 / 200.0, "{n}: {found} {expected}");
        }
        assert!((means - law.mean).abs() < 5.0 * law.deviation / 200.0);
    }

    #[test]
    fn a_rule_that_never_stops_has_the_binomial_mean() {
        let stream = TwoValues { low: 1.0, high: 3.0, chance: 0.25 };
        let law = StoppingLaw::new(stream, 7, 50, |_, _| false);
        assert!((law.stops[50] - 1.0).abs() < 1e-12);
        assert!((law.mean - stream.mean()).abs() < 1e-12);
        let deviation = 2.0 * (0.25 * 0.75 / 50.0f64).sqrt();
        assert!((law.deviation - deviation).abs() < 1e-7);
    }

    #[test]
    fn laws_that_differ_by_rounding_bound_the_error_of_the_cells() {
        let stream = TwoValues { low: 0.0, high: 1.0, chance: 0.5 };
        let early = StoppingLaw::new(stream, 1, 3, |n, highs| n == 2 && highs == 1);
        let late = StoppingLaw::new(stream, 1, 3, |_, _| false);
        let cells = early.cells(&late);
        assert_eq!(cells.cells, [0.0, 0.0, 0.5, 0.5]);
        assert_eq!(cells.errors, [0.0, 0.0, 0.5, 0.5]);
    }
}
