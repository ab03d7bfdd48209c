//! A picture that tells in which quarter of its pixel each of four samples lies, and of one of them where in its
//! quarter.
//!
//! Every quarter emits its own power of 5 in red, so that the sum of four samples, written in base 5, has in each digit
//! how many of them fell there. One quarter of each pixel, another one in the pixels beside it, emits green too, three
//! by three cells with numbers from 1 to 9. Only one sample of a pixel is looked at so closely, since a core may jitter
//! all of them alike. Between the quarters is background.

use super::painting::{Area, MARGIN, Painting, corner, digit, one, places, sum};
use crate::scene::SceneDescription;
use crate::stats::CellProbabilities;
use glam::DVec2;

/// Camera rays per pixel.
pub(crate) const SAMPLES: u32 = BASE - 1;
/// Quarters in a row.
const SIDE: usize = 2;
/// Quarters of a pixel.
pub(crate) const STRATA: usize = SIDE * SIDE;
/// Cells in a row of a quarter.
const CELLS: usize = 3;

const BASE: u32 = 5;
const BACKGROUND_RADIANCE: [f64; 3] = [625.0, 0.0, 0.0];
const _: () = assert!(BASE.pow(STRATA as u32) == 625);

/// What a pixel shows of its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Samples in each quarter, row by row. The rest lie between them.
    pub(crate) strata: [u32; STRATA],
    /// Where in the quarter that is looked at closely its only sample lies, cell by cell, row by row.
    pub(crate) cell: Option<usize>,
}

impl Reading {
    /// Whether no quarter has two samples.
    pub(crate) fn is_even(&self) -> bool {
        self.strata.iter().all(|count| *count <= 1)
    }

    /// Whether no sample lies between the quarters.
    pub(crate) fn is_whole(&self) -> bool {
        self.strata.iter().sum::<u32>() == SAMPLES
    }
}

/// The quarter of a pixel that is looked at closely.
fn close(at: [u32; 2]) -> usize {
    (at[0] + 2 * at[1]) as usize % STRATA
}

/// In the quarter that is looked at closely, with the number of a cell.
fn radiance(stratum: usize, cell: Option<usize>) -> [f64; 3] {
    [one(BASE, stratum), cell.map_or(0.0, |cell| 1.0 + cell as f64), 0.0]
}

/// Reads the pixel of this column and row; `None` if it is no mean of [`SAMPLES`] radiances of the pattern.
pub(crate) fn read(at: [u32; 2], pixel: [f32; 3]) -> Option<Reading> {
    let [red, green, _] = pixel.map(|mean| sum(mean, SAMPLES, BASE.pow(5)));
    let (red, green) = (red?, green?);
    let strata = std::array::from_fn(|place| digit(red, BASE, place));
    let counted = strata.iter().sum::<u32>() + digit(red, BASE, STRATA);
    let alone = strata[close(at)] == 1;
    let cell = alone.then(|| (green as usize).wrapping_sub(1));
    let is_cell = cell.is_none_or(|cell| cell < CELLS * CELLS);
    (counted == SAMPLES && is_cell).then_some(Reading { strata, cell })
}

/// The probabilities of the cells of a quarter for a sample whose two coordinates in it are uniform
/// in this interval of [0, 1]. What is missing lies between the quarters.
pub(crate) fn law([from, to]: [f64; 2]) -> CellProbabilities {
    let border = |number: usize| to_stratum(MARGIN + number as f64 * cell_size());
    let share = |cell: usize| {
        let overlap = border(cell + 1).min(to) - border(cell).max(from);
        overlap.max(0.0) / (to - from)
    };
    let cells = (0..CELLS * CELLS).map(|cell| share(cell % CELLS) * share(cell / CELLS));
    CellProbabilities::exact(cells.collect())
}

/// From a distance in pixels to one in quarters.
fn to_stratum(distance: f64) -> f64 {
    distance * SIDE as f64
}

fn stratum_size() -> f64 {
    1.0 / SIDE as f64
}

/// In pixels.
fn cell_size() -> f64 {
    (stratum_size() - 2.0 * MARGIN) / CELLS as f64
}

pub(crate) fn scene() -> SceneDescription {
    let mut painting = Painting::new("strata-pattern", BACKGROUND_RADIANCE);
    for stratum in 0..STRATA {
        let (near, far): (Vec<_>, Vec<_>) = places().partition(|at| close(*at) == stratum);
        let areas = far.iter().map(|at| area(*at, stratum, 0, CELLS));
        painting.paint(format!("quarter {stratum}"), radiance(stratum, None), areas);
        for cell in 0..CELLS * CELLS {
            let areas = near.iter().map(|at| area(*at, stratum, cell, 1));
            painting.paint(
                format!("cell {cell} of {stratum}"),
                radiance(stratum, Some(cell)),
                areas,
            );
        }
    }
    painting.scene()
}

/// `cells` by `cells` cells of a quarter, from `first` on.
fn area(at: [u32; 2], stratum: usize, first: usize, cells: usize) -> Area {
    let place =
        |number: usize, side: usize| DVec2::new((number % side) as f64, (number / side) as f64);
    let corner = corner(at) + stratum_size() * place(stratum, SIDE) + MARGIN;
    let corner = corner + cell_size() * place(first, CELLS);
    [corner, corner + cell_size() * cells as f64]
}

/// What a ray through a film point brings home.
#[cfg(test)]
pub(crate) fn radiance_at(point: DVec2) -> [f64; 3] {
    let at = point.floor().to_array().map(|c| c as u32);
    let inside = |[low, high]: Area| point.cmpge(low).all() && point.cmplt(high).all();
    let Some(stratum) = (0..STRATA).find(|stratum| inside(area(at, *stratum, 0, CELLS))) else {
        return BACKGROUND_RADIANCE;
    };
    if close(at) != stratum {
        return radiance(stratum, None);
    }
    let cell = (0..CELLS * CELLS).find(|cell| inside(area(at, stratum, *cell, 1)));
    cell.map_or(BACKGROUND_RADIANCE, |cell| radiance(stratum, Some(cell)))
}

#[cfg(test)]
mod tests {
    use super::super::painting::assert_shows;
    use super::*;

    #[test]
    fn the_scene_shows_the_pattern() {
        assert_shows(&scene(), radiance_at);
    }

    #[test]
    fn what_is_written_can_be_read_and_nothing_else() {
        let pixel = |points: [[f64; 2]; 4]| {
            let radiances = points.map(|point| radiance_at(DVec2::from(point)));
            let sum = |c: usize| radiances.iter().map(|radiance| radiance[c]).sum::<f64>();
            read([0, 0], [0, 1, 2].map(|c| (sum(c) / 4.0) as f32))
        };
        let even = pixel([[0.49, 0.1], [0.7, 0.2], [0.1, 0.9], [0.6, 0.6]]).unwrap();
        assert_eq!(even, Reading { strata: [1; 4], cell: Some(2) });
        let uneven = pixel([[0.1, 0.1], [0.2, 0.2], [0.1, 0.9], [0.5, 0.6]]).unwrap();
        assert_eq!(uneven, Reading { strata: [2, 0, 1, 0], cell: None });
        assert!(even.is_even() && even.is_whole() && !uneven.is_even() && !uneven.is_whole());
        for other in [[0.0; 3], [f32::NAN; 3], [0.3, 0.0, 0.0], [1e9, 0.0, 0.0]] {
            assert_eq!(read([0, 0], other), None, "{other:?}");
        }
    }

    #[test]
    fn nearly_all_of_a_quarter_is_cells() {
        let law = law([0.0, 1.0]);
        assert!((law.mass - (1.0 - 4.0 * MARGIN).powi(2)).abs() < 1e-12);
        assert!(law.cells.iter().all(|cell| (cell - law.mass / 9.0).abs() < 1e-12));
    }
}
