//! Where the light is that large cells lack.
//!
//! Runs that have all missed the same light do not vary, and a large cell has no neighbours that could tell of it. Yet
//! light that is missed by chance is missed in one place, for few samples came there: a cell that is darker all over has
//! been seen to be so by all its samples, one that lacks the light of a corner by those of the corner alone.

use super::cells::{COMPONENTS, TILES};
use super::target::{Frozen, Target};
use crate::stats::law::Spread;
use std::collections::BTreeMap;

/// Over how many pixels the light is spread that the frozen cells of a large scale lack, as both confirmations saw
/// them: of `n` tiles of 8 by 8 that lack the same, all of theirs. The noise of tiles makes it less, and what is too
/// bright beside what is too dark makes it more.
pub(super) fn pixels_that_lack(
    frozen: &Frozen,
    confirmations: [&Spread; 2],
    target: &Target,
    scale: usize,
) -> f64 {
    let tiles = Tiles::of(confirmations, target, scale);
    let mut lacks = BTreeMap::<usize, f64>::new();
    let mut departs = 0.0;
    for (place, sign, weight) in &frozen.terms {
        let index = place - target.cells.ranges()[scale].start;
        let (cell, component) = (index / COMPONENTS, index % COMPONENTS);
        for (tile, share) in &tiles.of_cells[cell] {
            let departure = sign * weight * share * tiles.difference(*tile, component);
            departs += departure;
            if *sign < 0.0 {
                *lacks.entry(*tile).or_default() += departure;
            }
        }
    }
    let squares: f64 = lacks.values().filter(|lack| **lack > 0.0).map(|lack| lack * lack).sum();
    let alike = departs.max(0.0).powi(2) / squares;
    alike * target.cells.grids[TILES].pixels() as f64
}

/// The tiles of both confirmations.
struct Tiles<'a> {
    confirmations: [&'a Spread; 2],
    target: &'a Target,
    /// Where the values of tiles start.
    start: usize,
    /// Of each cell of the large scale, its tiles with their shares of it.
    of_cells: Vec<Vec<(usize, f64)>>,
}

impl<'a> Tiles<'a> {
    fn of(confirmations: [&'a Spread; 2], target: &'a Target, scale: usize) -> Self {
        let (start, of_cells) = (target.cells.ranges()[TILES].start, target.cells.tiles_of(scale));
        Self { confirmations, target, start, of_cells }
    }

    /// Measured less expected.
    fn difference(&self, tile: usize, component: usize) -> f64 {
        let index = self.start + COMPONENTS * tile + component;
        let [second, third] = self.confirmations.map(|spread| spread.mean(index));
        0.5 * (second + third) - self.target.expected[index]
    }
}

#[cfg(test)]
mod tests {
    use super::super::cells::{Cells, Scale};
    use super::*;
    use crate::image::Image;

    const SIZE: usize = 64;

    /// Pixels over which a picture lacks light whose pixels are these instead of 1.
    fn pixels(is: impl Fn(usize, usize) -> f32) -> f64 {
        let right = Image::new(SIZE, SIZE, [1.0; 3]);
        let cells = Cells::new(&right);
        let expected = cells.values(&right);
        let seen = cells.values(&Image::from_fn(SIZE, SIZE, |x, y| [is(x, y); 3]));
        let errors = vec![0.0; expected.len()];
        let target = Target::new(cells, expected.clone(), expected, &errors);
        let mut spread = Spread::default();
        spread.push(&seen);
        let scale = Scale::ALL.len() - 1;
        let range = target.cells.ranges()[scale].clone();
        let frozen = Frozen { terms: range.map(|place| (place, -1.0, 1.0)).collect() };
        pixels_that_lack(&frozen, [&spread, &spread], &target, scale)
    }

    #[test]
    fn a_picture_that_is_darker_all_over_lacks_light_everywhere() {
        assert!((pixels(|_, _| 0.9) - (SIZE * SIZE) as f64).abs() < 1e-6);
    }

    #[test]
    fn a_picture_without_the_light_of_a_corner_lacks_it_there() {
        let corner = |x, y| if x < 16 && y < 8 { 0.0 } else { 1.0 };
        assert!((pixels(corner) - 128.0).abs() < 1e-6);
    }
}
