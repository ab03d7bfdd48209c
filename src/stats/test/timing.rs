//! Times, which have outliers: medians, and intervals of the median ratio of paired times.
//!
//! Times inform and never fail a core. Measure in interleaved pairs, so that a busy machine slows
//! both. How busy it is drifts: two pairs in a row tell hardly more than one, and an interval of many
//! such is too narrow. Pairs that lie far apart in time are nearly independent.

use crate::stats::{Verdict, binomial_at_least};

const CONFIDENCE: f64 = 0.95;

/// How much faster one of two things is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeedUp {
    /// Median over the pairs of the time of the first over the time of the second.
    pub(crate) ratio: f64,
    /// 95 % interval of that median; all there is of fewer than six pairs.
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
        interval: interval_of_median(&ratios),
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

/// Between two order statistics, as near to the middle as the confidence allows: as many values are
/// below the median as heads fall, whatever the law of the values.
fn interval_of_median(values: &[f64]) -> [f64; 2] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    // So few below the median, or so few above it.
    let chance = |few: usize| 2.0 * binomial_at_least((count - few) as u64, count as u64, 0.5);
    match (0..count / 2).take_while(|few| chance(*few) <= 1.0 - CONFIDENCE).last() {
        Some(few) => [sorted[few], sorted[count - 1 - few]],
        None => [0.0, f64::INFINITY],
    }
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
        let values: Vec<f64> = (1..=9).map(f64::from).collect();
        assert_eq!(interval_of_median(&values), [2.0, 8.0]);
        assert_eq!(interval_of_median(&values[..6]), [1.0, 6.0]);
        assert_eq!(interval_of_median(&values[..5]), [0.0, f64::INFINITY]);
    }

    /// How often the interval holds the ratio 3, of 1000 times: of some turns in a row the fastest, then a pause. Both
    /// times have noise and outliers of their own, and what slows them drifts, each in its own way, with a memory of
    /// thirty turns.
    fn holds(rounds: usize, turns: usize, pause: i32) -> usize {
        let mut stream = Seed(6).stream();
        let mut normal = || -> f64 { (0..12).map(|_| uniform(&mut stream)).sum::<f64>() - 6.0 };
        let mut is_held = || {
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
            let [low, high] = speed_up(&(0..rounds).map(|_| round()).collect::<Vec<_>>()).interval;
            low <= 3.0 && 3.0 <= high
        };
        (0..1000).filter(|_| is_held()).count()
    }

    /// Turns in a row all see the machine in one mood: their interval is of that mood. So a round goes over all meshes
    /// before the next turns on the same one.
    #[test]
    fn intervals_of_spread_rounds_hold_the_ratio_while_the_machine_drifts() {
        let (in_a_row, spread) = (holds(18, 1, 0), holds(6, 3, 100));
        assert!(in_a_row < 800, "{in_a_row} of 1000");
        assert!((945..=995).contains(&spread), "{spread} of 1000");
    }

    /// The median of another run has noise of its own. The bench says less of its rows: all of a mesh share the time of brute
    /// force, and machines drift.
    #[test]
    fn another_run_lies_in_the_interval_seven_times_of_eight_and_its_own_overlaps() {
        let mut stream = Seed(8).stream();
        let mut run = |rounds: usize| {
            let mut noise = || (0..12).map(|_| uniform(&mut stream)).sum::<f64>() - 6.0;
            speed_up(&(0..rounds).map(|_| ((0.03 * noise()).exp(), 1.0)).collect::<Vec<_>>())
        };
        for (rounds, inside) in [(6, 870..=930), (12, 840..=905)] {
            let (mut within, mut overlapping) = (0, 0);
            for _ in 0..1000 {
                let [first, second] = [run(rounds), run(rounds)];
                let [low, high] = first.interval;
                within += u32::from((low..=high).contains(&second.ratio));
                overlapping += u32::from(low <= second.interval[1] && second.interval[0] <= high);
            }
            assert!(inside.contains(&within), "{within} of 1000 medians of {rounds}");
            assert!(overlapping >= 990, "{overlapping} of 1000 intervals of {rounds}");
        }
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
