//! Mean and variance of many numbers at once, over runs.

/// Welford's moments of each element of the vectors pushed.
#[derive(Clone, Debug, Default)]
pub(in crate::stats) struct Spread {
    count: u32,
    means: Vec<f64>,
    squares: Vec<f64>,
}

impl Spread {
    pub(in crate::stats) fn push(&mut self, values: &[f64]) {
        if self.count == 0 {
            self.means = vec![0.0; values.len()];
            self.squares = vec![0.0; values.len()];
        }
        self.count += 1;
        let share = 1.0 / f64::from(self.count);
        for ((mean, squares), value) in self.means.iter_mut().zip(&mut self.squares).zip(values) {
            let before = value - *mean;
            *mean += before * share;
            *squares += before * (value - *mean);
        }
    }

    pub(in crate::stats) fn mean(&self, index: usize) -> f64 {
        self.means[index]
    }

    /// Standard error of the mean; NaN of fewer than two runs.
    pub(in crate::stats) fn standard_error(&self, index: usize) -> f64 {
        let runs = f64::from(self.count);
        (self.squares[index] / (runs - 1.0) / runs).sqrt()
    }

    /// Standard deviation of one run; NaN of fewer than two.
    pub(in crate::stats) fn deviation(&self, index: usize) -> f64 {
        (self.squares[index] / (f64::from(self.count) - 1.0)).sqrt()
    }

    /// How many numbers a run has.
    pub(in crate::stats) fn len(&self) -> usize {
        self.means.len()
    }

    /// How many runs there are.
    pub(in crate::stats) fn count(&self) -> u32 {
        self.count
    }

    /// Degrees of freedom of a standard error.
    pub(in crate::stats) fn freedom(&self) -> f64 {
        f64::from(self.count) - 1.0
    }
}
