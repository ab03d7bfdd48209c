//! What the cells of a picture should be, and the cells that are looked at again.

use super::cells::{COMPONENTS, Cells, Scale};
use crate::stats::plan::level::REFERENCE_LEVEL;
use crate::stats::{Band, normal_upper};

/// Darker than this, relative to the typical brightness, the band does not shrink further: what an
/// offset of shadow rays leaks into the dark is judged by what it adds to the picture.
pub(super) const DARK: f64 = 0.01;

/// What every cell should be, and how far from that a correct core may be.
pub(super) struct Target {
    pub(super) cells: Cells,
    pub(super) expected: Vec<f64>,
    /// What relative errors are relative to.
    pub(super) scale: Vec<f64>,
    /// Standard errors of `expected`.
    pub(super) errors: Vec<f64>,
    /// How far a mean may be from `expected`.
    pub(super) bands: Vec<f64>,
}

impl Target {
    pub(super) fn new(cells: Cells, expected: Vec<f64>, scale: Vec<f64>, errors: &[f64]) -> Self {
        let mut bands = Vec::with_capacity(expected.len());
        let whole = cells.ranges()[Scale::ALL.len() - 1].start;
        for range in cells.ranges() {
            let sigmas = normal_upper(REFERENCE_LEVEL / range.len() as f64);
            bands.extend(range.map(|i| {
                let level = scale[i].abs().max(DARK * scale[whole + i % COMPONENTS].abs());
                Band::RADIANCE.relative() * level + sigmas * errors[i]
            }));
        }
        Self { cells, expected, scale, errors: errors.to_vec(), bands }
    }

    pub(super) fn with_slack(mut self, slack: &[f64]) -> Self {
        self.bands.iter_mut().zip(slack).for_each(|(band, slack)| *band += slack);
        self
    }

    /// How far outside its band a cell's value is, with its sign.
    pub(super) fn departure(&self, index: usize, value: f64) -> f64 {
        let difference = value - self.expected[index];
        (difference.abs() - self.bands[index]).max(0.0) * difference.signum()
    }

    /// The luminance of the whole picture.
    pub(super) fn whole_luminance(&self) -> usize {
        self.expected.len() - 1
    }
}

/// Cells that are confirmed together: one number a run.
pub(super) struct Frozen {
    /// Cell, sign and weight.
    pub(super) terms: Vec<(usize, f64, f64)>,
}

impl Frozen {
    /// Whether no cell is too dark, as it is where light is missed by chance.
    pub(super) fn is_too_bright(&self) -> bool {
        self.terms.iter().all(|(_, sign, _)| *sign > 0.0)
    }

    /// The weighted sum of how far the frozen cells are outside their bands, towards their signs.
    pub(super) fn scalar(&self, target: &Target, values: &[f64]) -> f64 {
        let outside = |&(index, sign, weight): &(usize, f64, f64)| {
            weight * (sign * (values[index] - target.expected[index]) - target.bands[index])
        };
        self.terms.iter().map(outside).sum()
    }
}
