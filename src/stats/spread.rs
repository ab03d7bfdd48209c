//! Mean and variance of many numbers at once, over runs.

/// Welford's moments of each element of the vectors pushed.
#[derive(Clone, Debug, Default)]
pub(super) struct Spread {
    count: u32,
    means: Vec<f64>,
    squares: Vec<f64>,
}

impl Spread {
    pub(super) fn push(&mut self, values: &[f64]) {
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

    pub(super) fn mean(&self, index: usize) -> f64 {
        self.means[index]
    }

    /// Standard error of the mean; NaN of fewer than two runs.
    pub(super) fn standard_error(&self, index: usize) -> f64 {
        let runs = f64::from(self.count);
        (self.squares[index] / (runs - 1.0) / runs).sqrt()
    }

    /// Standard deviation of one run; NaN of fewer than two.
    pub(super) fn deviation(&self, index: usize) -> f64 {
        (self.squares[index] / (f64::from(self.count) - 1.0)).sqrt()
    }

    /// How many numbers a run has.
    pub(super) fn len(&self) -> usize {
        self.means.len()
    }

    /// Degrees of freedom of a standard error.
    pub(super) fn freedom(&self) -> f64 {
        f64::from(self.count) - 1.0
    }
}
