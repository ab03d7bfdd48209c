//! Pixels that stay black although they should not: no test of means sees twenty of them.
//!
//! That a pixel is exactly 0 in every run is no chance if the probability q of a black run is
//! small: chance would do it with probability q^runs. A pixel that is always black says nothing of
//! its own q, so two witnesses have to agree, and the larger q counts:
//!
//! - Pixels around it of like brightness: the share of their runs that are black, of all or of the darker quarter, and
//!   of the darkest beside it that some run lights. How noisy light is may change where its brightness does not.
//! - The reference. A value X ≥ 0 of mean m and variance v is 0 with probability at most
//!   v/(v + m²), by Cauchy and Schwarz: E\[X\]² ≤ E\[X²\] P(X > 0). The reference knows m and, but
//!   for a factor, v: how many runs its samples are worth is told by like pixels, whose variance
//!   is known of both; the largest factor of all counts.
//!
//! Neighbours alone would blame a right core for a sliver of an emitter: its light comes in few samples,
//! and its mean may yet be that of a wall. There the reference is noisy, and is asked. A reference
//! whose samples are spread evenly over a pixel may know a sliver too well; but a sliver has an edge
//! to what it is a sliver of, so pixels beside others of another brightness are not judged.

use super::cells::around;
use crate::image::{Image, luminance};
use crate::stats::Moments;

/// Probability below which a pixel is suspected after the screen.
const SUSPECTED: f64 = 1e-6;
/// Probability below which it is dead.
const DEAD: f64 = 1e-15;
/// Neighbours are looked for this far away, in pixels.
const REACH: usize = 4;
/// One that few runs light tells of rare light this far away: no farther than light's own edges, for beside a dead pixel
/// others may be half dead.
const BESIDE: usize = 2;
/// Neighbours of like brightness are within this factor.
const LIKE: f64 = 2.0;
/// Fewer neighbours prove nothing.
const FEWEST_NEIGHBOURS: u64 = 8;
/// Dead pixels reported.
const MOST_REPORTED: usize = 64;

/// What each pixel was in the runs so far.
pub(super) struct LitRuns {
    size: (usize, usize),
    /// What the pixels should be, luminance.
    levels: Vec<f64>,
    /// Variance of that over its square.
    noise: Vec<f64>,
    /// Luminance between runs.
    seen: Vec<Moments>,
    /// In how many runs each pixel was not black.
    lit: Vec<u32>,
    runs: u32,
}

impl LitRuns {
    /// For pictures that should look like `guide`, whose luminance has a standard error in each
    /// pixel.
    pub(super) fn new(guide: &Image, errors: impl Iterator<Item = f64>) -> Self {
        let levels: Vec<f64> = guide.pixels.iter().map(|pixel| luminance(*pixel)).collect();
        let noise = levels.iter().zip(errors).map(|(level, error)| (error / level).powi(2));
        Self {
            size: (guide.width, guide.height),
            noise: noise.collect(),
            seen: vec![Moments::default(); levels.len()],
            lit: vec![0; levels.len()],
            levels,
            runs: 0,
        }
    }

    pub(super) fn take(&mut self, image: &Image) {
        self.runs += 1;
        for (i, pixel) in image.pixels.iter().enumerate() {
            self.lit[i] += u32::from(*pixel != [0.0; 3]);
            self.seen[i].push(luminance(*pixel));
        }
    }

    /// Pixels that the confirmations should look at.
    pub(super) fn suspects(&self) -> Vec<[usize; 2]> {
        self.darker_than_chance(SUSPECTED)
    }

    pub(super) fn dead(&self) -> Vec<[usize; 2]> {
        self.darker_than_chance(DEAD)
    }

    fn darker_than_chance(&self, level: f64) -> Vec<[usize; 2]> {
        let black = (0..self.lit.len()).filter(|&i| self.lit[i] == 0 && self.levels[i] > 0.0);
        let dead = black.filter(|&pixel| self.probability(pixel) <= level);
        dead.take(MOST_REPORTED).map(|i| [i % self.size.0, i / self.size.0]).collect()
    }

    /// At most the probability that a right core's pixel is black in all runs; 1 where that is not
    /// known.
    fn probability(&self, pixel: usize) -> f64 {
        let is_inside = around(self.size, pixel, 1).all(|i| self.are_alike(i, pixel));
        if self.runs < 2 || !is_inside {
            return 1.0;
        }
        let alike: Vec<usize> = around(self.size, pixel, REACH)
            .filter(|&i| i != pixel && self.are_alike(i, pixel))
            .collect();
        if (alike.len() as u64) < FEWEST_NEIGHBOURS {
            return 1.0;
        }
        let seen = self.share_of_black(&alike).max(self.share_of_rarely_lit(pixel));
        let black = seen.max(self.most_black(pixel, &alike));
        black.powf(f64::from(self.runs))
    }

    fn are_alike(&self, a: usize, b: usize) -> bool {
        (LIKE.recip()..=LIKE).contains(&(self.levels[a] / self.levels[b]))
    }

    /// The share of these pixels' runs that are black, never quite none.
    fn share_of_black(&self, pixels: &[usize]) -> f64 {
        let lit: u64 = pixels.iter().map(|i| u64::from(self.lit[*i])).sum();
        let trials = pixels.len() as u64 * u64::from(self.runs);
        let of_all = (trials - lit + 1) as f64 / (trials + 1) as f64;
        of_all.max(self.share_of_darker(pixels))
    }

    /// The share of black runs that a quarter of these pixels reach.
    fn share_of_darker(&self, pixels: &[usize]) -> f64 {
        let mut black: Vec<u32> = pixels.iter().map(|i| self.runs - self.lit[*i]).collect();
        black.sort_unstable();
        f64::from(black[black.len() - 1 - black.len() / 4]) / f64::from(self.runs)
    }

    /// The share of black runs of the darkest like pixel beside one that was lit at all.
    fn share_of_rarely_lit(&self, pixel: usize) -> f64 {
        let beside = around(self.size, pixel, BESIDE).filter(|&i| self.are_alike(i, pixel));
        let lit = beside.map(|i| self.lit[i]).filter(|lit| *lit > 0).min();
        lit.map_or(0.0, |lit| f64::from(self.runs - lit) / f64::from(self.runs))
    }

    /// The largest share of black runs that the reference's moments allow a pixel.
    fn most_black(&self, pixel: usize, alike: &[usize]) -> f64 {
        // A neighbour that the reference knows exactly tells nothing about noise.
        let noisy = alike.iter().filter(|i| self.noise[**i] > 0.0);
        let factor = noisy.map(|i| self.seen_noise(*i) / self.noise[*i]).fold(0.0, f64::max);
        let variance = factor * self.noise[pixel];
        variance / (1.0 + variance)
    }

    /// Variance of a run over the square of what it should be.
    fn seen_noise(&self, pixel: usize) -> f64 {
        let error = self.seen[pixel].standard_error() / self.levels[pixel];
        f64::from(self.runs) * error * error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, Stream, uniform};

    const SIDE: usize = 32;
    const PIXEL: usize = 70;

    /// Lit runs of pictures that should be flat and grey, but for the standard error of one pixel;
    /// `draw` makes a pixel of a run.
    fn runs(count: u32, error: f64, mut draw: impl FnMut(usize, &mut Stream) -> f32) -> LitRuns {
        let errors = (0..SIDE * SIDE).map(|i| if i == PIXEL { error } else { 0.005 });
        let mut lit = LitRuns::new(&Image::new(SIDE, SIDE, [0.5; 3]), errors);
        let mut stream = Seed(5).stream();
        for _ in 0..count {
            let pixels = (0..SIDE * SIDE).map(|i| [draw(i, &mut stream); 3]).collect();
            lit.take(&Image { width: SIDE, height: SIDE, pixels });
        }
        lit
    }

    /// Black with this probability, and otherwise so bright that the mean is right.
    fn flickering(black: f64, stream: &mut Stream) -> f32 {
        if uniform(stream) < black { 0.0 } else { (0.5 / (1.0 - black)) as f32 }
    }

    fn with_dead(count: u32, black: f64) -> LitRuns {
        runs(count, 0.005, |i, stream| if i == PIXEL { 0.0 } else { flickering(black, stream) })
    }

    #[test]
    fn a_dead_pixel_is_suspected_by_the_screen_and_found_after_the_confirmations() {
        assert_eq!(with_dead(16, 0.05).suspects(), [[6, 2]]);
        assert_eq!(with_dead(80, 0.3).dead(), [[6, 2]]);
    }

    #[test]
    fn pixels_that_are_often_black_by_chance_are_not_dead() {
        let runs = |count| runs(count, 0.005, |_, stream| flickering(0.9, stream));
        assert!(runs(16).suspects().is_empty());
        assert!(runs(80).dead().is_empty());
    }

    #[test]
    fn noise_that_begins_where_brightness_does_not_change_is_no_death() {
        let half = |i, stream: &mut Stream| match i {
            PIXEL => 0.0,
            _ if i % SIDE <= PIXEL % SIDE => flickering(0.95, stream),
            _ => 0.5,
        };
        assert!(runs(80, 0.005, half).dead().is_empty());
    }

    #[test]
    fn a_corner_that_few_samples_light_is_no_death() {
        let corner = |i: usize, stream: &mut Stream| match (i % SIDE, i / SIDE) {
            _ if i == PIXEL => 0.0,
            (6..=7, 2..=3) => flickering(0.97, stream),
            _ => 0.5,
        };
        assert!(runs(80, 0.005, corner).dead().is_empty());
    }

    #[test]
    fn a_sliver_of_an_emitter_as_bright_as_the_wall_beside_it_is_not_dead() {
        // Of 10,000 samples of the reference, as many light the wall pixels, and 100 the sliver; of
        // the 20 samples of a run one in five holds it.
        let sliver = |i, stream: &mut Stream| if i == PIXEL { 0.0 } else { wall(stream) };
        let wall_error = 0.005;
        assert_eq!(runs(80, wall_error, sliver).dead(), [[6, 2]]);
        let sliver_error = 0.05;
        assert!(runs(16, sliver_error, sliver).suspects().is_empty());
        assert!(runs(80, sliver_error, sliver).dead().is_empty());
    }

    /// A run of 20 samples, each of deviation 1 relative to its mean.
    fn wall(stream: &mut Stream) -> f32 {
        let sum: f64 = (0..20).map(|_| -(1.0 - uniform(stream)).ln()).sum();
        (0.5 * sum / 20.0) as f32
    }

    #[test]
    fn a_pixel_at_an_edge_or_unlike_its_neighbours_is_not_judged_by_them() {
        for (changed, level) in [(PIXEL, 0.001), (PIXEL + 1, 5.0)] {
            let mut guide = Image::new(SIDE, SIDE, [0.5; 3]);
            guide.pixels[changed] = [level; 3];
            let mut lit = LitRuns::new(&guide, std::iter::repeat_n(0.001, SIDE * SIDE));
            let mut image = guide.clone();
            image.pixels[PIXEL] = [0.0; 3];
            (0..80).for_each(|_| lit.take(&image));
            assert!(lit.dead().is_empty());
        }
    }
}
