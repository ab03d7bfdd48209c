//! A picture, what it should be, and how a difference is measured.

use super::Knowledge;
use crate::image::{Image, luminance};
use crate::stats::law::upper_median;
use rayon::prelude::*;

/// Width and height of a unit: differences are summed up over units, whose noise is independent.
pub(super) const UNIT: usize = 8;
/// No difference counts for more than this share of its pixel's light.
const MOST: f32 = 1.0;
/// Pixels that are enough for a search.
pub(super) const ENOUGH: usize = 1 << 17;
/// A candidate that leaves more than this of the difference in units enough for a search is none.
const HOPELESS: f64 = 0.98;
/// Pixels to each side whose brightness a weight goes by.
const REACH: usize = 2;

pub(super) struct Question<'a> {
    pub(super) image: &'a Image,
    /// The reference, with the mistakes found so far.
    pub(super) reference: &'a Image,
    pub(super) knowledge: &'a Knowledge<'a>,
    /// What makes differences relative: one over brightness, 0 for pixels that do not count.
    pub(super) weights: &'a [f32],
    /// Every so many-th unit is looked at, along diagonals: 1 for all.
    pub(super) every: usize,
}

/// The weights of pixels: relative to the brightness of the reference around them. A pixel's own
/// noise hardly moves its weight, so that products of both have the right mean.
pub(super) fn weights(image: &Image, reference: &Image, knowledge: &Knowledge<'_>) -> Vec<f32> {
    let levels: Vec<f64> = reference.pixels.par_iter().map(|pixel| luminance(*pixel)).collect();
    let lit = levels.iter().copied().filter(|level| *level > 0.0 && level.is_finite());
    let typical = upper_median(lit).unwrap_or(1.0);
    let levels = around(&levels, reference.width);
    #[expect(clippy::cast_possible_truncation, reason = "weights are used in single precision")]
    let weight = |(i, level): (usize, &f64)| {
        let finite = |picture: &Image| picture.pixels[i].iter().all(|value| value.is_finite());
        let counts = knowledge.counted.is_none_or(|counted| counted[i]);
        let usable = counts && finite(image) && finite(reference);
        if usable { 1.0 / (level.max(0.0) + typical) as f32 } else { 0.0 }
    };
    levels.par_iter().enumerate().map(weight).collect()
}

impl Question<'_> {
    /// The difference of a channel as it counts.
    #[inline(always)]
    pub(super) fn difference(&self, pixel: usize, image: f32, candidate: f32) -> f32 {
        let weight = self.weights[pixel];
        // A pixel that does not count may be NaN.
        if weight > 0.0 { (weight * (image - candidate)).clamp(-MOST, MOST) } else { 0.0 }
    }

    /// The same question of units enough for a search.
    pub(super) fn thin(&self) -> Question<'_> {
        Question { every: (self.weights.len() / ENOUGH).max(1), ..*self }
    }

    /// Whether a candidate could explain something, judged by units enough for a search.
    pub(super) fn is_worth_a_look(&self, candidate: impl Fn(usize) -> [f32; 3] + Sync) -> bool {
        let few = self.thin();
        if few.every == 1 {
            return true;
        }
        let before: f64 = few.energies(few.reference).iter().sum();
        few.energies_of(candidate).iter().sum::<f64>() < HOPELESS * before
    }

    /// The squared differences from `candidate`, summed up over each unit.
    pub(super) fn energies(&self, candidate: &Image) -> Vec<f64> {
        self.energies_of(|pixel| candidate.pixels[pixel])
    }

    /// The same of a candidate that is not drawn yet.
    pub(super) fn energies_of(&self, candidate: impl Fn(usize) -> [f32; 3] + Sync) -> Vec<f64> {
        self.fold_units(0.0, |sum, pixel| {
            if self.weights[pixel] > 0.0 {
                *sum += self.energy(pixel, self.image.pixels[pixel], candidate(pixel));
            }
        })
    }

    #[inline(always)]
    fn energy(&self, pixel: usize, image: [f32; 3], candidate: [f32; 3]) -> f64 {
        let square = |c: usize| f64::from(self.difference(pixel, image[c], candidate[c])).powi(2);
        square(0) + square(1) + square(2)
    }

    /// The energy that noise alone adds to the difference; 0 where nothing is known of it.
    pub(super) fn noise_energy(&self) -> f64 {
        let Some(errors) = self.knowledge.standard_error else { return 0.0 };
        let add = |sum: &mut f64, pixel| *sum += self.energy(pixel, errors.pixels[pixel], [0.0; 3]);
        self.fold_units(0.0, add).iter().sum()
    }

    /// What `add` makes of the pixels of every unit that is looked at, row by row.
    pub(super) fn fold_units<T: Clone + Send + Sync>(
        &self,
        nothing: T,
        add: impl Fn(&mut T, usize) + Sync,
    ) -> Vec<T> {
        let (width, height) = (self.image.width, self.image.height);
        let columns = width.div_ceil(UNIT);
        let is_looked_at = |unit: &usize| {
            let (column, row) = (unit % columns, unit / columns);
            (column + 3 * row).is_multiple_of(self.every)
        };
        let of_unit = |unit: usize| {
            let (left, top) = (unit % columns * UNIT, unit / columns * UNIT);
            let mut sum = nothing.clone();
            for y in top..(top + UNIT).min(height) {
                for x in left..(left + UNIT).min(width) {
                    add(&mut sum, y * width + x);
                }
            }
            sum
        };
        let units: Vec<usize> = (0..columns * height.div_ceil(UNIT)).filter(is_looked_at).collect();
        units.into_par_iter().with_min_len(columns).map(of_unit).collect()
    }
}

/// The mean of the finite values up to [`REACH`] pixels away.
fn around(levels: &[f64], width: usize) -> Vec<f64> {
    let height = levels.len() / width.max(1);
    let near = |at: usize, end: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(end);
    let of_row = |y: usize| {
        let mut columns = vec![(0.0, 0.0); width];
        for row in near(y, height) {
            for (column, level) in columns.iter_mut().zip(&levels[row * width..]) {
                if level.is_finite() {
                    *column = (column.0 + level, column.1 + 1.0);
                }
            }
        }
        let mean = |x: usize| {
            let add = |(sum, count), (more, many): &(f64, f64)| (sum + more, count + many);
            let (sum, count) = columns[near(x, width)].iter().fold((0.0, 0.0), add);
            if count > 0.0 { sum / count } else { 0.0 }
        };
        (0..width).map(mean).collect::<Vec<_>>()
    };
    (0..height).into_par_iter().flat_map_iter(of_row).collect()
}
