//! Times, which have outliers: medians, and bootstrap intervals of the ratio of paired times.
//!
//! Times inform and never fail a core. Measure in interleaved pairs, so that a busy machine slows
//! both.

use crate::math::rng::{Seed, Stream};
use crate::stats::{Verdict, binomial_at_least};
use rand::Rng;

const RESAMPLES: usize = 2000;
const CONFIDENCE: f64 = 0.95;

/// How much faster one of two things is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeedUp {
    /// Median over the pairs of the time of the first over the time of the second.
    pub(crate) ratio: f64,
    /// 95 % bootstrap interval of that median.
    pub(crate) interval: [f64; 2],
    pub(crate) pairs: usize,
    /// Pairs in which the second was faster.
    pub(crate) wins: usize,
}

/// The median; NaN of nothing. The mean of the middle two of an even number.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

/// How much faster the second of each pair of times is. Deterministic for equal times.
pub(crate) fn speed_up(pairs: &[(f64, f64)]) -> SpeedUp {
    let ratios: Vec<f64> = pairs.iter().map(|(first, second)| first / second).collect();
    SpeedUp {
        ratio: median(&ratios),
        interval: bootstrap_interval(&ratios),
        pairs: pairs.len(),
        wins: ratios.iter().filter(|ratio| **ratio > 1.0).count(),
    }
}

/// Level of a sign test: 15 pairs that all agree are below it, 14 of 15 are not.
const SIGN_LEVEL: f64 = 1e-4;

/// Whether one of two things is so many times as fast as the other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Faster {
    pub(crate) speed_up: SpeedUp,
    /// Time of the first over the time of the second, pair by pair.
    pub(crate) ratios: Vec<f64>,
    /// Pairs in which it is by more than what was asked.
    pub(crate) above: usize,
    /// Probability of as many such pairs, were it so in half of them: the sign test, which knows no
    /// law of times.
    pub(crate) p_value: f64,
    /// A pass, or inconclusive: times never fail a core.
    pub(crate) verdict: Verdict,
}

/// Whether the second of each pair of times is more than `at_least` times as fast as the first.
pub(crate) fn judge_faster(pairs: &[(f64, f64)], at_least: f64) -> Faster {
    let is_above = |(first, second): &&(f64, f64)| first / second > at_least;
    let above = pairs.iter().filter(is_above).count();
    let p_value = binomial_at_least(above as u64, pairs.len() as u64, 0.5);
    let shown = p_value < SIGN_LEVEL;
    let verdict = if shown { Verdict::Pass } else { Verdict::Inconclusive };
    let ratios = pairs.iter().map(|(first, second)| first / second).collect();
    Faster { speed_up: speed_up(pairs), ratios, above, p_value, verdict }
}

/// Percentile bootstrap of the median (Efron 1979).
fn bootstrap_interval(values: &[f64]) -> [f64; 2] {
    if values.is_empty() {
        return [f64::NAN; 2];
    }
    let mut stream = Seed::SUITE.child("bootstrap").stream();
    let mut medians: Vec<f64> =
        (0..RESAMPLES).map(|_| median(&resample(values, &mut stream))).collect();
    medians.sort_by(f64::total_cmp);
    let tail = (0.5 * (1.0 - CONFIDENCE) * RESAMPLES as f64) as usize;
    [medians[tail], medians[RESAMPLES - 1 - tail]]
}

fn resample(values: &[f64], stream: &mut Stream) -> Vec<f64> {
    let count = values.len() as u64;
    // The remainder of 64 random bits favours small numbers by less than one part in 10¹⁷.
    (0..count).map(|_| values[(stream.next_u64() % count) as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::uniform;

    #[test]
    fn medians_do_not_mind_outliers() {
        assert_eq!(median(&[3.0, 1.0, 1e9]), 3.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn the_interval_holds_the_ratio_in_about_95_of_100_cases() {
        let mut stream = Seed(6).stream();
        let mut held = 0;
        for _ in 0..200 {
            let mut noise = || 1.0 + 0.2 * uniform(&mut stream);
            let pairs: Vec<_> = (0..25).map(|_| (3.0 * noise(), noise())).collect();
            let found = speed_up(&pairs);
            held += u32::from(found.interval[0] <= 3.0 && 3.0 <= found.interval[1]);
        }
        assert!((180..=199).contains(&held), "{held} of 200");
    }

    #[test]
    fn all_of_fifteen_pairs_have_to_agree() {
        let mut pairs = [(4.0, 1.0); 15];
        assert_eq!(judge_faster(&pairs, 2.0).verdict, Verdict::Pass);
        assert!((judge_faster(&pairs, 2.0).p_value - 0.5_f64.powi(15)).abs() < 1e-12);
        pairs[3] = (1.0, 1.0);
        assert_eq!(judge_faster(&pairs, 2.0).verdict, Verdict::Inconclusive);
        assert_eq!(judge_faster(&[], 2.0).verdict, Verdict::Inconclusive);
    }

    #[test]
    fn wins_are_counted_and_the_answer_is_always_the_same() {
        let pairs = [(2.0, 1.0), (3.0, 1.0), (0.5, 1.0)];
        assert_eq!(speed_up(&pairs).wins, 2);
        assert_eq!(speed_up(&pairs), speed_up(&pairs));
    }
}
