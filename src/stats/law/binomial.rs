//! Exact tails of the binomial law, and the interval that follows from them.

use statrs::function::beta::{beta_reg, inv_beta_reg};

/// P(X ≥ `hits`) of `trials` with this probability.
pub fn binomial_at_least(hits: u64, trials: u64, probability: f64) -> f64 {
    if hits == 0 || probability >= 1.0 {
        return 1.0;
    }
    if hits > trials || probability <= 0.0 {
        return 0.0;
    }
    beta_reg(hits as f64, (trials - hits + 1) as f64, probability)
}

/// P(X ≤ `hits`) of `trials` with this probability.
pub(crate) fn binomial_at_most(hits: u64, trials: u64, probability: f64) -> f64 {
    if hits >= trials {
        return 1.0;
    }
    binomial_at_least(trials - hits, trials, 1.0 - probability)
}

/// The interval of Clopper and Pearson (1934): holds the share with at least the probability 1 − 2
/// `level`.
pub fn share_interval(hits: u64, trials: u64, level: f64) -> [f64; 2] {
    let (k, n) = (hits as f64, trials as f64);
    let low = if hits == 0 { 0.0 } else { inv_beta_reg(k, n - k + 1.0, level) };
    let high = if hits >= trials { 1.0 } else { 1.0 - inv_beta_reg(n - k, k + 1.0, level) };
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    // scipy: binom.sf(9, 1000, .004), binom.cdf(30, 1000, .05), binom.sf(519, 1000, .5).
    #[test]
    fn tails_agree_with_another_library() {
        for (found, expected) in [
            (binomial_at_least(10, 1000, 0.004), 0.008_000_267_855_52),
            (binomial_at_most(30, 1000, 0.05), 0.001_277_067_917_48),
            (binomial_at_least(520, 1000, 0.5), 0.108_724_146_602),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-8, "{found} is not {expected}");
        }
    }

    #[test]
    fn both_tails_overlap_in_one_term_only() {
        let both = binomial_at_least(7, 20, 0.3) + binomial_at_most(6, 20, 0.3);
        assert!((both - 1.0).abs() < 1e-12);
        assert_eq!(binomial_at_least(0, 20, 0.3), 1.0);
        assert_eq!(binomial_at_most(20, 20, 0.3), 1.0);
        assert_eq!(binomial_at_least(1, 20, 0.0), 0.0);
    }

    #[test]
    fn the_interval_ends_where_the_tails_are_the_level() {
        let [low, high] = share_interval(40, 1000, 5e-4);
        assert!((binomial_at_least(40, 1000, low) / 5e-4 - 1.0).abs() < 1e-6);
        assert!((binomial_at_most(40, 1000, high) / 5e-4 - 1.0).abs() < 1e-6);
        assert_eq!(share_interval(0, 50, 5e-4)[0], 0.0);
        assert_eq!(share_interval(50, 50, 5e-4)[1], 1.0);
    }
}
