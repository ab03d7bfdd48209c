//! Times, which have outliers: medians of the ratios of paired times, and where those of another run lie.
//!
//! Times inform and never fail a core. Measure in interleaved pairs, so that a busy machine slows
//! both. How busy it is drifts: two pairs in a row tell hardly more than one, and an interval of many
//! such is too narrow. Pairs that lie far apart in time are nearly independent.

use crate::stats::{Verdict, binomial_at_least};
use statrs::distribution::{DiscreteCDF, Hypergeometric};

const CONFIDENCE: f64 = 0.95;

/// How much faster one of two things is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeedUp {
    /// Median over the pairs of the time of the first over the time of the second.
    pub(crate) ratio: f64,
    /// In which the median of as many pairs again lies, 19 times of 20; everything for fewer than nine pairs.
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
        interval: interval_of_another_median(&ratios),
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

/// Where the median of as many values again lies: between two order statistics, as near to the middle as the confidence
/// allows. Any order of both samples' values is as likely as any other, whatever their law. Fligner and Wolfe,
/// "Some applications of sample analogues to the probability integral transformation and a coverage property",
/// The American Statistician 30, 1976.
fn interval_of_another_median(values: &[f64]) -> [f64; 2] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    let holds = |few: &usize| 2.0 * chance_of_a_median_below(*few, count) <= 1.0 - CONFIDENCE;
    match (0..count / 2).take_while(holds).last() {
        Some(few) => [sorted[few], sorted[count - 1 - few]],
        None => [0.0, f64::INFINITY],
    }
}

/// Probability that the median of `count` values lies below all but `few` of `count` others: more than half of them are then
/// among so many that are least of all. An even number counts by the lower of its middle two, whose probability is higher.
fn chance_of_a_median_below(few: usize, count: usize) -> f64 {
    let half = count.div_ceil(2);
    let [count, half, few] = [count, half, few].map(|number| number as u64);
    let own = Hypergeometric::new(2 * count, count, half + few);
    own.map_or(f64::NAN, |own| own.sf(half - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    #[test]
    fn medians_do_not_mind_outliers() {
        assert_eq!(median(&[3.0, 1.0, 1e9]), 3.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn an_interval_lies_between_order_statistics() {
        let values: Vec<f64> = (1..=18).map(f64::from).collect();
        assert_eq!(interval_of_another_median(&values), [3.0, 16.0]);
        assert_eq!(interval_of_another_median(&values[..9]), [1.0, 9.0]);
        assert_eq!(interval_of_another_median(&values[..8]), [0.0, f64::INFINITY]);
        assert_eq!(interval_of_another_median(&[]), [0.0, f64::INFINITY]);
    }

    /// C(9, 5) of the C(18, 5) choices of the least five of eighteen.
    #[test]
    fn the_chance_is_that_of_a_draw_without_replacement() {
        assert!((chance_of_a_median_below(0, 9) - 126.0 / 8568.0).abs() < 1e-12);
    }

    /// How often the figure of another run lies in the interval, of 1000 times. A run has rounds: of some turns in a row the
    /// fastest, then a pause. Both times have noise and outliers of their own, and what slows them drifts, each in its own
    /// way, with a memory of thirty turns.
    fn lies_within(rounds: usize, turns: usize, pause: i32) -> usize {
        let mut stream = Seed(6).stream();
        let mut normal = || -> f64 { (0..12).map(|_| uniform(&mut stream)).sum::<f64>() - 6.0 };
        let mut run = || {
            let mut slow = [normal(), normal()];
            let mut after = |steps: i32| {
                let kept = (-f64::from(steps) / 30.0).exp();
                slow = slow.map(|slow| kept * slow + (1.0 - kept * kept).sqrt() * normal());
                slow.map(|slow| {
                    let outlier = if normal() > 2.0 { 0.5 } else { 0.0 };
                    (0.1 * slow + 0.03 * normal() + outlier).exp()
                })
            };
            let mut round = || {
                let first = after(1 + pause);
                let fastest = (1..turns).fold(first, |[a, b], _| {
                    let [c, d] = after(1);
                    [a.min(c), b.min(d)]
                });
                (3.0 * fastest[0], fastest[1])
            };
            speed_up(&(0..rounds).map(|_| round()).collect::<Vec<_>>())
        };
        let mut is_within = || {
            let ([low, high], again) = (run().interval, run().ratio);
            low <= again && again <= high
        };
        (0..1000).filter(|_| is_within()).count()
    }

    /// Turns in a row all see the machine in one mood: their interval is of that mood. So a round goes over all meshes
    /// before the next turns on the same one.
    #[test]
    fn another_run_lies_in_the_interval_of_spread_rounds_while_the_machine_drifts() {
        let (in_a_row, spread) = (lies_within(27, 1, 0), lies_within(9, 3, 100));
        assert!(in_a_row < 800, "{in_a_row} of 1000");
        assert!((945..=995).contains(&spread), "{spread} of 1000");
        let twice_as_many = lies_within(18, 3, 100);
        assert!((945..=995).contains(&twice_as_many), "{twice_as_many} of 1000");
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
