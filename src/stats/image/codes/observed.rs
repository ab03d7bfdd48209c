//! Codes that were seen: of a few pictures, or of one.

use crate::stats::law::Spread;

/// The code of every channel of every pixel, with its noise.
#[derive(Clone, Debug)]
pub(crate) struct Observed {
    /// By `3 · pixel + channel`.
    pub(super) codes: Vec<Seen>,
    /// Degrees of freedom of each variance.
    pub(super) freedom: f64,
}

/// One channel of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// Mean code.
    pub(super) code: f64,
    /// Standard error of `code`.
    pub(super) error: f64,
    /// Standard deviation of the code between pictures.
    pub(super) deviation: f64,
}

impl Observed {
    /// Of several pictures with seeds of their own.
    pub(super) fn of_runs(runs: &Spread) -> Self {
        let seen = |index| Seen {
            code: runs.mean(index),
            error: runs.standard_error(index),
            deviation: runs.deviation(index),
        };
        Self { codes: (0..runs.len()).map(seen).collect(), freedom: runs.freedom() }
    }
}
