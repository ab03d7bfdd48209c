//! Upper quantiles: what a statistic exceeds with a small probability if nothing is wrong.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, Normal, StudentsT};
use statrs::function::gamma::ln_gamma;

/// What a standard normal variable exceeds with probability `level`.
pub fn normal_upper(level: f64) -> f64 {
    // From the lower tail, where small levels keep their digits.
    -Normal::standard().inverse_cdf(level)
}

/// What Student's t with `freedom` degrees of freedom exceeds with probability `level`.
/// Infinite without any freedom: one value alone proves nothing.
pub(crate) fn student_upper(level: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |law| -law.inverse_cdf(level))
}

/// The probability that Student's t with `freedom` degrees of freedom exceeds `value`; NaN for NaN.
pub(crate) fn student_tail(value: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |law| law.sf(value))
}

/// What χ² with `freedom` degrees of freedom exceeds with probability `level`. Infinite without any
/// freedom.
pub(crate) fn chi_square_upper(level: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::INFINITY, |law| law.inverse_cdf(1.0 - level))
}

/// What the ratio of two χ², each over its own `freedom`, exceeds with probability `level` (Fisher's F).
pub(crate) fn fisher_upper(level: f64, above: f64, below: f64) -> f64 {
    FisherSnedecor::new(above, below).map_or(f64::INFINITY, |law| law.inverse_cdf(1.0 - level))
}

/// The probability that χ² with `freedom` degrees of freedom exceeds `value`; NaN for NaN.
pub(crate) fn chi_square_tail(value: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |law| law.sf(value))
}

/// The probability that noncentral χ² exceeds `value`: a Poisson mixture of central ones
/// (Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions 2, section 29.3).
pub(crate) fn noncentral_chi_square_tail(value: f64, freedom: f64, noncentrality: f64) -> f64 {
    let rate = 0.5 * noncentrality;
    let spread = 12.0 * rate.sqrt() + 12.0;
    let from = (rate - spread).max(0.0).floor() as u64;
    let to = (rate + spread).ceil() as u64;
    let log_weight = |k: u64| {
        let k = k as f64;
        if rate == 0.0 {
            if k == 0.0 { 0.0 } else { f64::NEG_INFINITY }
        } else {
            k * rate.ln() - rate - ln_gamma(k + 1.0)
        }
    };
    (from..=to)
        .map(|k| log_weight(k).exp() * chi_square_tail(value, freedom + 2.0 * k as f64))
        .sum()
}

/// The noncentrality that a χ² test at `level` misses with probability `miss`.
/// Infinite without any freedom.
pub(crate) fn detectable_noncentrality(freedom: f64, level: f64, miss: f64) -> f64 {
    if freedom.is_nan() || freedom <= 0.0 {
        return f64::INFINITY;
    }
    let critical = chi_square_upper(level, freedom);
    let seen = |noncentrality| noncentral_chi_square_tail(critical, freedom, noncentrality);
    let mut high = 1.0;
    while seen(high) < 1.0 - miss {
        high *= 2.0;
    }
    let mut low = 0.0;
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        if seen(middle) < 1.0 - miss { low = middle } else { high = middle }
    }
    high
}

/// The middle value, or the upper of the middle two; none of none.
pub(crate) fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let rank = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(rank, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} is not {expected}");
    }

    // Values of scipy.stats: norm.isf, t.isf, chi2.isf; of F by the continued fraction of the incomplete beta function.
    #[test]
    fn agree_with_tables() {
        assert_close(normal_upper(5e-4), 3.290_526_731_492);
        assert_close(normal_upper(1e-9), 5.997_807_015_008);
        assert_close(student_upper(5e-4, 31.0), 3.633_456_349_758);
        assert_close(student_upper(5e-4, 63.0), 3.451_768_944_961);
        assert_close(student_upper(2e-5, 31.0), 4.782_731_763_809);
        assert_close(chi_square_upper(5e-4, 199.0), 271.258_004_171);
        assert_close(chi_square_upper(1e-9, 10.0), 62.945_457_420_6);
        assert_close(fisher_upper(5e-4, 1.0, 16.0), 18.890_746_013);
        assert_close(fisher_upper(5e-4, 200.0, 3200.0), 1.377_838_878);
    }

    // scipy: brentq(lambda l: ncx2.sf(chi2.isf(5e-4, d), d, l) - 0.999, 1, 5000).
    #[test]
    fn noncentralities_agree_with_another_library() {
        for (freedom, expected) in [
            (1.0, 43.177_892_63),
            (20.0, 76.707_088_56),
            (199.0, 165.350_317),
            (800.0, 294.140_698_5),
        ] {
            assert_close(detectable_noncentrality(freedom, 5e-4, 1e-3), expected);
        }
        assert_eq!(detectable_noncentrality(0.0, 5e-4, 1e-3), f64::INFINITY);
    }
}
