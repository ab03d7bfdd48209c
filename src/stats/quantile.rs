//! Upper quantiles: what a statistic exceeds with a small probability if nothing is wrong.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// What a standard normal variable exceeds with probability `level`.
pub fn normal_upper(level: f64) -> f64 {
    // From the lower tail, where small levels keep their digits.
    -Normal::standard().inverse_cdf(level)
}

/// What Student's t with `freedom` degrees of freedom exceeds with probability `level`.
/// Infinite without any freedom: one value alone proves nothing.
pub fn student_upper(level: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |law| -law.inverse_cdf(level))
}

/// What χ² with `freedom` degrees of freedom exceeds with probability `level`. Infinite without any freedom.
pub fn chi_square_upper(level: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::INFINITY, |law| law.inverse_cdf(1.0 - level))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} is not {expected}");
    }

    // Values of scipy.stats: norm.isf, t.isf, chi2.isf.
    #[test]
    fn agree_with_tables() {
        assert_close(normal_upper(5e-4), 3.290_526_731_492);
        assert_close(normal_upper(1e-9), 5.997_807_015_008);
        assert_close(student_upper(5e-4, 31.0), 3.633_456_349_758);
        assert_close(student_upper(5e-4, 63.0), 3.451_768_944_961);
        assert_close(student_upper(2e-5, 31.0), 4.782_731_763_809);
        assert_close(chi_square_upper(5e-4, 199.0), 271.258_004_171);
        assert_close(chi_square_upper(1e-9, 10.0), 62.945_457_420_6);
    }
}
