//! How noisy a pixel is: the variance that goes with its mean.

use super::steps::Steps;
use glam::DVec3;

/// The sums of a pixel's samples and of their squares, channel by channel.
///
/// In double precision they lose no digit that matters: samples would have to agree to seven digits.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spread {
    count: u32,
    /// Of the samples.
    pub(crate) sum: DVec3,
    /// Of each channel.
    pub(crate) sum_of_squares: DVec3,
}

/// Takes one more sample in.
pub(crate) fn add(spread: &mut Spread, radiance: DVec3) {
    spread.count += 1;
    spread.sum += radiance;
    spread.sum_of_squares += radiance * radiance;
}

impl Spread {
    /// Variance of the mean of the samples. Of a single sample nothing is known: 0.
    pub(crate) fn variance_of_mean(&self, steps: &Steps) -> DVec3 {
        if self.count < 2 {
            return DVec3::ZERO;
        }
        let n = f64::from(self.count);
        let squared_deviations = self.sum_of_squares - self.sum * self.sum / n;
        steps.variance_of_mean(squared_deviations.max(DVec3::ZERO), n)
    }
}

/// That of one sample, over n − 1, divided by n.
pub(crate) fn variance_of_mean(squared_deviations: DVec3, n: f64) -> DVec3 {
    squared_deviations / (n - 1.0) / n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;

    fn spread_of(values: &[f64]) -> DVec3 {
        let mut spread = Spread::default();
        values.iter().for_each(|value| add(&mut spread, DVec3::new(*value, 0.5, 0.0)));
        spread.variance_of_mean(&LESSON)
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
