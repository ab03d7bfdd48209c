//! Where people put the samples of a pixel instead of spreading them over it, and what the pattern shows of that.

use super::painting::{FILM, corner, places};
use super::pattern::{CELLS, Decoded, SAMPLES, cell_at, decode, is_lit};
use crate::cause::{Cause, camera};
use glam::DVec2;

/// Where a sample with two uniform numbers lies, in pixels from the top left corner of its own.
pub(crate) type Law = fn(DVec2) -> DVec2;

/// A law that people write instead of the identity.
pub(crate) struct PixelMistake {
    pub(crate) cause: &'static Cause,
    pub(crate) law: Law,
}

const fn mistake(cause: &'static Cause, law: Law) -> PixelMistake {
    PixelMistake { cause, law }
}

/// Each shows another pattern than the rest.
pub(crate) const MISTAKES: &[PixelMistake] = &[
    mistake(&camera::PIXEL_CENTRE, |_| DVec2::splat(0.5)),
    mistake(&camera::PIXEL_CORNER, |_| DVec2::ZERO),
    mistake(&camera::HALF_A_PIXEL, |u| u + 0.5),
    mistake(&camera::HALF_A_PIXEL, |u| u - 0.5),
    mistake(&camera::HALF_A_PIXEL, |u| u + DVec2::new(0.5, -0.5)),
    mistake(&camera::HALF_A_PIXEL, |u| u + DVec2::new(-0.5, 0.5)),
    mistake(&camera::WHOLE_PIXEL, |u| u + DVec2::X),
    mistake(&camera::WHOLE_PIXEL, |u| u - DVec2::X),
    mistake(&camera::WHOLE_PIXEL, |u| u + DVec2::Y),
    mistake(&camera::WHOLE_PIXEL, |u| u - DVec2::Y),
    mistake(&camera::JITTER_TOO_NARROW, |u| 0.5 * u),
    mistake(&camera::JITTER_TOO_NARROW, |u| 0.5 * u + 0.25),
    mistake(&camera::JITTER_TOO_WIDE, |u| 2.0 * u),
    mistake(&camera::JITTER_TOO_WIDE, |u| 2.0 * u - 0.5),
    mistake(&camera::JITTER_TOO_WIDE, |u| 2.0 * u - 1.0),
    mistake(&camera::JITTER_TOO_WIDE, |u| DVec2::new(tent(u.x), tent(u.y))),
    mistake(&camera::ONE_NUMBER_TWICE, |u| DVec2::splat(u.x)),
    mistake(&camera::ONE_AXIS_ONLY, |u| DVec2::new(u.x, 0.5)),
    mistake(&camera::ONE_AXIS_ONLY, |u| DVec2::new(0.5, u.y)),
];

/// The tent filter of smallpt: of two pixels' width, around the middle.
fn tent(u: f64) -> f64 {
    0.5 + if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() }
}

/// Where dark pixels stand beside lit ones, with none behind: at the left, the right, the top, the
/// bottom, so that what they see says where their samples went.
const SIDES: usize = 4;

/// Samples of a picture of the pattern, counted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Samples of lit pixels.
    pub(crate) samples: f64,
    /// Of those, how many fell in each column, row, falling and rising diagonal of their own cells.
    pub(crate) lines: [[f64; CELLS]; 4],
    /// Samples of all dark pixels.
    pub(crate) dark_samples: f64,
    /// Of those, how many saw the cells of another pixel.
    pub(crate) strayed: f64,
    /// Samples of dark pixels that have a lit one on one side only, by that side.
    beside: [f64; SIDES],
    /// Of those, how many saw cells.
    seen_beside: [f64; SIDES],
    /// Pixels that are no mean of radiances of the pattern.
    pub(crate) unreadable: u64,
}

impl Tally {
    /// The shares that a mistake predicts: of lit pixels line by line, then of the pixels beside them, side by side.
    pub(crate) fn shares(&self) -> Vec<f64> {
        let beside = (0..SIDES).map(|side| self.seen_beside[side] / self.beside[side]);
        self.own_shares().into_iter().chain(beside).collect()
    }

    /// The shares of the samples of lit pixels, line by line; NaN if a pixel could not be read.
    pub(crate) fn own_shares(&self) -> Vec<f64> {
        let samples = if self.unreadable > 0 { f64::NAN } else { self.samples };
        self.lines.iter().flatten().map(|count| count / samples).collect()
    }

    /// The share of the samples of dark pixels that saw light.
    pub(crate) fn strayed_share(&self) -> f64 {
        self.strayed / self.dark_samples
    }

    /// Takes in another picture.
    pub(crate) fn add(&mut self, other: &Self) {
        let add = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        self.samples += other.samples;
        add(self.lines.as_flattened_mut(), other.lines.as_flattened());
        self.dark_samples += other.dark_samples;
        self.strayed += other.strayed;
        add(&mut self.beside, &other.beside);
        add(&mut self.seen_beside, &other.seen_beside);
        self.unreadable += other.unreadable;
    }

    /// What a picture of the pattern shows.
    pub(crate) fn of_picture(pixels: &[[f32; 3]]) -> Self {
        let mut tally = Self::default();
        for (at, pixel) in places().zip(pixels) {
            match decode(*pixel) {
                Some(decoded) => tally.take(at, f64::from(SAMPLES), &decoded),
                None => tally.unreadable += 1,
            }
        }
        tally
    }

    fn take(&mut self, at: [u32; 2], samples: f64, decoded: &Decoded) {
        if is_lit(at) {
            self.samples += samples;
            let counts = decoded.lines.as_flattened().iter();
            let sums = self.lines.as_flattened_mut().iter_mut();
            return sums.zip(counts).for_each(|(sum, count)| *sum += f64::from(*count));
        }
        let seen = samples - f64::from(decoded.background);
        self.dark_samples += samples;
        self.strayed += seen;
        if let Some(side) = side(at) {
            self.beside[side] += samples;
            self.seen_beside[side] += seen;
        }
    }

    /// What a picture shows, on average, whose samples follow `law`.
    pub(crate) fn of_law(law: Law) -> Self {
        const GRID: u32 = 40;
        let middle = |n: u32| (f64::from(n) + 0.5) / f64::from(GRID);
        let numbers = || (0..GRID * GRID).map(|n| DVec2::new(middle(n % GRID), middle(n / GRID)));
        let mut tally = Self::default();
        for at in [LIT].into_iter().chain(BESIDE) {
            for point in numbers().map(|u| corner(at) + law(u)) {
                tally.take(at, 1.0, &Decoded::of_sample(cell_at(point)));
            }
        }
        tally
    }
}

/// A lit pixel, and one beside it on each border: all others of their kind see the same.
const LIT: [u32; 2] = [1, 1];
const BESIDE: [[u32; 2]; SIDES] = [[0, 1], [FILM[0] - 1, 1], [1, 0], [1, FILM[1] - 1]];

/// On which border a pixel stands beside a lit one.
fn side([x, y]: [u32; 2]) -> Option<usize> {
    BESIDE.iter().position(|[column, row]| match (x % 2, y % 2) {
        (0, 1) => x == *column && row % 2 == 1,
        (1, 0) => y == *row && column % 2 == 1,
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::super::pattern::share;
    use super::*;

    #[test]
    fn every_mistake_shows_another_pattern() {
        let shown: Vec<_> = MISTAKES.iter().map(|m| Tally::of_law(m.law).shares()).collect();
        let differ =
            |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        for (i, one) in shown.iter().enumerate() {
            for (j, other) in shown[..i].iter().enumerate() {
                let cause = [i, j].map(|index| MISTAKES[index].cause.name);
                assert!(differ(one, other) > 0.045, "{i} and {j}: {cause:?}");
            }
        }
    }

    #[test]
    fn an_even_spread_is_even_and_strays_nowhere() {
        let tally = Tally::of_law(|u| u);
        assert_eq!(tally.strayed_share(), 0.0);
        // The grid of numbers is coarser than the margin.
        assert!(tally.own_shares().iter().all(|found| (found - share()).abs() < 0.01));
    }
}
