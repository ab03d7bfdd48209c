//! Mean and variance of a stream, after Welford (1962), merged after Chan, Golub and LeVeque
//! (1979).

/// The number, the mean and the spread of what was pushed. One NaN makes the mean and the variance
/// NaN.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    pub(crate) fn push(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (value - self.mean);
    }

    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; NaN of none.
    pub(crate) fn mean(&self) -> f64 {
        if self.count == 0 { f64::NAN } else { self.mean }
    }

    /// Their unbiased variance (n − 1); NaN of fewer than two.
    pub(crate) fn variance(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { self.squares / (self.count - 1) as f64 }
    }

    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count as f64).sqrt()
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<T: IntoIterator<Item = f64>>(values: T) -> Self {
        let mut moments = Self::default();
        values.into_iter().for_each(|value| moments.push(value));
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agree_with_the_definition_on_numbers_that_cancel() {
        let values = [1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0];
        let moments: Moments = values.into_iter().collect();
        assert_eq!(moments.mean(), 1e9 + 10.0);
        assert_eq!(moments.variance(), 30.0);
        assert_eq!(moments.standard_error(), 7.5f64.sqrt());
    }

    #[test]
    fn a_constant_has_no_variance_and_a_nan_is_not_lost() {
        assert_eq!(Moments::from_iter([0.3; 50]).variance(), 0.0);
        assert!(Moments::from_iter([1.0, f64::NAN, 1.0]).mean().is_nan());
        assert!(Moments::default().mean().is_nan());
    }
}
