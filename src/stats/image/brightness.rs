//! How bright a picture and its parts are beside what they should be: what people ask first, and what two wrong cores
//! have in common.
//!
//! All light counts here, that of emitters in view too, so that the numbers are what adding up two
//! pictures gives. The cells that are judged count bright pixels less; no verdict hangs on this.

use super::cells::{COMPONENTS, Component};
use super::report::{GlobalRatio, PartRatio};
use super::target::{DARK, Target};
use crate::stats::law::{Spread, student_upper};
use crate::stats::plan::level::INTERVAL_LEVEL;

/// Parts across and down.
pub(crate) const PARTS: usize = 4;
/// The picture, and its parts row by row.
const AREAS: usize = 1 + PARTS * PARTS;

/// Sums over all pixels of each area, for each component.
type Sums = [[f64; COMPONENTS]; AREAS];

/// What the sums should be.
struct Right {
    expected: Sums,
    /// What relative errors are relative to.
    scale: Sums,
    squared_errors: Sums,
}

/// The light of pictures, over runs.
pub(super) struct Brightness {
    size: (usize, usize),
    runs: Spread,
}

impl Brightness {
    pub(super) fn of(size: (usize, usize)) -> Self {
        Self { size, runs: Spread::default() }
    }

    /// Takes in the cells of one run, of which the pixels come first.
    pub(super) fn push(&mut self, cells: &[f64]) {
        self.runs.push(self.sums(cells, |value| value).as_flattened());
    }

    /// Measured over expected, for each component.
    pub(super) fn ratios(&self, target: &Target) -> Vec<GlobalRatio> {
        let right = self.right(target);
        let ratio = |component| {
            let (ratio, interval) = self.ratio(&right, 0, component as usize);
            GlobalRatio { component, ratio, interval }
        };
        Component::ALL.into_iter().map(ratio).collect()
    }

    /// The same of the luminance of each part.
    pub(super) fn of_parts(&self, target: &Target) -> Vec<PartRatio> {
        let right = self.right(target);
        let of = |part: usize| {
            let (ratio, interval) = self.ratio(&right, 1 + part, Component::Luminance as usize);
            PartRatio { column: part % PARTS, row: part / PARTS, ratio, interval }
        };
        (0..PARTS * PARTS).map(of).collect()
    }

    fn right(&self, target: &Target) -> Right {
        Right {
            expected: self.sums(&target.expected, |value| value),
            scale: self.sums(&target.scale, |value| value),
            squared_errors: self.sums(&target.errors, |error| error * error),
        }
    }

    fn ratio(&self, right: &Right, area: usize, component: usize) -> (f64, [f64; 2]) {
        let typical = right.scale[0][component] / if area == 0 { 1 } else { PARTS * PARTS } as f64;
        let scale = right.scale[area][component].max(DARK * typical);
        let index = area * COMPONENTS + component;
        let ratio = 1.0 + (self.runs.mean(index) - right.expected[area][component]) / scale;
        let squared_error = right.squared_errors[area][component];
        let error = self.runs.standard_error(index).hypot(squared_error.sqrt());
        let half = student_upper(INTERVAL_LEVEL, self.runs.freedom()) * error / scale;
        (ratio, [ratio - half, ratio + half])
    }

    /// What `of` makes of the values of all pixels, summed up.
    fn sums(&self, cells: &[f64], of: impl Fn(f64) -> f64) -> Sums {
        let (width, height) = self.size;
        let (pixels, _) = cells[..COMPONENTS * width * height].as_chunks::<COMPONENTS>();
        let mut sums = [[0.0; COMPONENTS]; AREAS];
        for (number, pixel) in pixels.iter().enumerate() {
            let (x, y) = (number % width, number / width);
            let part = y * PARTS / height * PARTS + x * PARTS / width;
            for area in [0, 1 + part] {
                sums[area].iter_mut().zip(pixel).for_each(|(sum, value)| *sum += of(*value));
            }
        }
        sums
    }
}
