//! Pixels that stay black although pixels like them do not: no test of means sees twenty of them.
//!
//! That a pixel is exactly 0 in every run is no chance if its neighbours of like brightness are 0
//! in few: with q the share of their runs that are black, chance would do it with probability
//! q^runs.

use crate::image::{Image, luminance};

/// Chance below which a pixel is suspected after the screen.
const SUSPECTED: f64 = 1e-6;
/// Chance below which it is dead.
const DEAD: f64 = 1e-15;
/// Neighbours are looked for this far away, in pixels.
const REACH: usize = 4;
/// Neighbours of like brightness are within this factor.
const LIKE: f64 = 2.0;
/// Fewer neighbours prove nothing.
const FEWEST_NEIGHBOURS: u64 = 8;
/// Dead pixels reported.
const MOST_REPORTED: usize = 64;

/// In how many runs each pixel was not black.
pub(super) struct LitRuns {
    width: usize,
    height: usize,
    levels: Vec<f64>,
    lit: Vec<u32>,
    runs: u32,
}

impl LitRuns {
    /// For pictures that should look like `guide`.
    pub(super) fn new(guide: &Image) -> Self {
        let levels: Vec<f64> = guide.pixels.iter().map(|pixel| luminance(*pixel)).collect();
        let lit = vec![0; levels.len()];
        Self { width: guide.width, height: guide.height, levels, lit, runs: 0 }
    }

    pub(super) fn take(&mut self, image: &Image) {
        self.runs += 1;
        for (lit, pixel) in self.lit.iter_mut().zip(&image.pixels) {
            *lit += u32::from(*pixel != [0.0; 3]);
        }
    }

    /// Pixels that the confirmations should look at.
    pub(super) fn suspects(&self) -> Vec<[usize; 2]> {
        self.darker_than_chance(SUSPECTED)
    }

    /// Pixels that are dead.
    pub(super) fn dead(&self) -> Vec<[usize; 2]> {
        self.darker_than_chance(DEAD)
    }

    fn darker_than_chance(&self, level: f64) -> Vec<[usize; 2]> {
        let black = (0..self.lit.len()).filter(|&i| self.lit[i] == 0 && self.levels[i] > 0.0);
        let dead = black.filter(|&pixel| self.chance(pixel) <= level);
        dead.take(MOST_REPORTED).map(|i| [i % self.width, i / self.width]).collect()
    }

    /// The probability that a pixel is black in all runs, judged by its neighbours of like
    /// brightness.
    fn chance(&self, pixel: usize) -> f64 {
        if self.runs == 0 {
            return 1.0;
        }
        let alike = |i: usize| {
            let ratio = self.levels[i] / self.levels[pixel];
            i != pixel && (LIKE.recip()..=LIKE).contains(&ratio)
        };
        let (mut neighbours, mut lit) = (0u64, 0u64);
        for i in self.around(pixel).filter(|&i| alike(i)) {
            neighbours += 1;
            lit += u64::from(self.lit[i]);
        }
        if neighbours < FEWEST_NEIGHBOURS {
            return 1.0;
        }
        let trials = neighbours * u64::from(self.runs);
        let black = (trials - lit + 1) as f64 / (trials + 1) as f64;
        black.powf(f64::from(self.runs))
    }

    fn around(&self, pixel: usize) -> impl Iterator<Item = usize> {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let columns = x.saturating_sub(REACH)..(x + REACH + 1).min(self.width);
        let rows = y.saturating_sub(REACH)..(y + REACH + 1).min(self.height);
        let width = self.width;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    /// Runs of a flat grey picture, each pixel black with probability `black`.
    fn runs(count: u32, black: f64, dead: Option<usize>) -> LitRuns {
        let mut lit = LitRuns::new(&Image::new(32, 32, [0.5; 3]));
        let mut stream = Seed(5).stream();
        for _ in 0..count {
            let mut image = Image::from_fn(32, 32, |_, _| {
                if uniform(&mut stream) < black { [0.0; 3] } else { [0.5; 3] }
            });
            if let Some(pixel) = dead {
                image.pixels[pixel] = [0.0; 3];
            }
            lit.take(&image);
        }
        lit
    }

    #[test]
    fn a_dead_pixel_is_suspected_by_the_screen_and_found_after_the_confirmations() {
        assert_eq!(runs(16, 0.05, Some(70)).suspects(), [[6, 2]]);
        assert_eq!(runs(80, 0.3, Some(70)).dead(), [[6, 2]]);
    }

    #[test]
    fn pixels_that_are_often_black_by_chance_are_not_dead() {
        assert!(runs(16, 0.9, None).suspects().is_empty());
        assert!(runs(80, 0.9, None).dead().is_empty());
    }

    #[test]
    fn a_pixel_unlike_its_neighbours_is_not_judged_by_them() {
        let mut guide = Image::new(32, 32, [0.5; 3]);
        guide.pixels[70] = [0.001; 3];
        let mut lit = LitRuns::new(&guide);
        let mut image = guide.clone();
        image.pixels[70] = [0.0; 3];
        (0..80).for_each(|_| lit.take(&image));
        assert!(lit.dead().is_empty());
    }
}
