//! How noisy a pixel is: the variance that goes with its mean.

use super::change::Change;
use glam::DVec3;

/// The sums of a pixel's samples and of their squares, channel by channel.
///
/// In double precision they lose no digit that matters: samples would have to agree to seven digits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spread {
    count: u32,
    sum: DVec3,
    sum_of_squares: DVec3,
}

impl Spread {
    /// Takes one more sample in.
    pub fn add(&mut self, radiance: DVec3, change: Change) {
        self.count += 1;
        self.sum += radiance;
        self.sum_of_squares += radiance * radiance;
        if change == Change::SquaresInSingle {
            self.sum = self.sum.as_vec3().as_dvec3();
            self.sum_of_squares = self.sum_of_squares.as_vec3().as_dvec3();
        }
    }

    /// Variance of the mean of the samples: that of one sample, over n − 1, divided by n. Of a
    /// single sample nothing is known: 0.
    pub fn variance_of_mean(&self, change: Change) -> DVec3 {
        if self.count < 2 {
            return DVec3::ZERO;
        }
        let n = f64::from(self.count);
        let squared_deviations = self.sum_of_squares - self.sum * self.sum / n;
        let of_a_sample = squared_deviations.max(DVec3::ZERO) / (n - 1.0);
        match change {
            Change::VarianceOfSample => of_a_sample,
            Change::VarianceDividedTwice => of_a_sample / n / n,
            Change::DeviationReported => (of_a_sample / n).map(f64::sqrt),
            Change::SquaresReported => squared_deviations.max(DVec3::ZERO),
            _ => of_a_sample / n,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread_of(values: &[f64]) -> DVec3 {
        let mut spread = Spread::default();
        values.iter().for_each(|value| spread.add(DVec3::new(*value, 0.5, 0.0), Change::None));
        spread.variance_of_mean(Change::None)
    }

    #[test]
    fn the_variance_of_a_mean_by_hand() {
        // 1, 2, 6: mean 3, squared deviations 4 + 1 + 9, over 2, over 3.
        assert!(spread_of(&[1.0, 2.0, 6.0]).abs_diff_eq(DVec3::X * 14.0 / 6.0, 1e-15));
    }

    #[test]
    fn one_sample_says_nothing() {
        assert_eq!(spread_of(&[7.0]), DVec3::ZERO);
        assert_eq!(spread_of(&[]), DVec3::ZERO);
    }
}
