//! How bright a whole picture is beside what it should be: what people ask first.
//!
//! All light counts here, that of emitters in view too, so that the numbers are what adding up two
//! pictures gives. The cells that are judged count bright pixels less; no verdict hangs on this.

use super::cells::{COMPONENTS, Component};
use super::report::GlobalRatio;
use super::target::Target;
use crate::stats::law::{Spread, student_upper};
use crate::stats::plan::level::INTERVAL_LEVEL;

/// The mean light of pictures, over runs.
pub(super) struct Brightness {
    pixels: usize,
    runs: Spread,
}

impl Brightness {
    pub(super) fn of(pixels: usize) -> Self {
        Self { pixels, runs: Spread::default() }
    }

    /// Takes in the cells of one run, of which the pixels come first.
    pub(super) fn push(&mut self, cells: &[f64]) {
        self.runs.push(&self.sums(cells, |value| value).map(|sum| sum / self.pixels as f64));
    }

    /// Measured over expected, for each component.
    pub(super) fn ratios(&self, target: &Target) -> Vec<GlobalRatio> {
        let pixels = self.pixels as f64;
        let expected = self.sums(&target.expected, |value| value).map(|sum| sum / pixels);
        let scale = self.sums(&target.scale, |value| value).map(|sum| sum / pixels);
        let squares = self.sums(&target.errors, |error| error * error);
        let ratio = |(i, component)| {
            let i: usize = i;
            let ratio = 1.0 + (self.runs.mean(i) - expected[i]) / scale[i];
            let error = self.runs.standard_error(i).hypot(squares[i].sqrt() / pixels);
            let half = student_upper(INTERVAL_LEVEL, self.runs.freedom()) * error / scale[i];
            GlobalRatio { component, ratio, interval: [ratio - half, ratio + half] }
        };
        Component::ALL.into_iter().enumerate().map(ratio).collect()
    }

    /// What `of` makes of the values of all pixels, summed up for each component.
    fn sums(&self, cells: &[f64], of: impl Fn(f64) -> f64) -> [f64; COMPONENTS] {
        let (pixels, _) = cells[..COMPONENTS * self.pixels].as_chunks::<COMPONENTS>();
        let mut sums = [0.0; COMPONENTS];
        for pixel in pixels {
            sums.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += of(*value));
        }
        sums
    }
}
