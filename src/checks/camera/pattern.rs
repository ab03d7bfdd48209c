//! A picture that tells where in a pixel its samples lie, though all that can be seen of them is their mean.
//!
//! Every second pixel of every second row shows five by five cells of light; all else is background. Each cell emits
//! powers of 4, so that the sum of three samples, written in base 4, has in each digit how many of them fell where: in
//! which column of cells, which row, and which diagonal either way. The diagonals tell two independent numbers from the
//! same one used twice. Pixels that show background alone tell whether samples leave their pixel.

use super::painting::{FILM, MARGIN, Painting, corner, digit, one, places, sum};
use crate::scene::SceneDescription;
use glam::DVec2;

/// Camera rays per pixel: one less than the base of the digits.
pub(crate) const SAMPLES: u32 = BASE - 1;
/// Cells in a row, and digits of a number; odd, so that the middle of a pixel is in the middle of one.
pub(crate) const CELLS: usize = 5;

const BASE: u32 = 4;
/// The digit of red that counts samples of the background.
const BACKGROUND: usize = CELLS;
const BACKGROUND_RADIANCE: [f64; 3] = [1024.0, 0.0, 0.0];
const _: () = assert!(BASE.pow(BACKGROUND as u32) == 1024);

/// Its column in red, its row in green, its two diagonals in blue.
fn cell_radiance(cell: [usize; 2]) -> [f64; 3] {
    let [column, row, falling, rising] = lines_of(cell);
    [one(BASE, column), one(BASE, row), one(BASE, falling) + one(BASE, CELLS + rising)]
}

/// The column, row, falling and rising diagonal that a cell is in.
const fn lines_of([column, row]: [usize; 2]) -> [usize; 4] {
    [column, row, (column + CELLS - row) % CELLS, (column + row) % CELLS]
}

/// Whether a pixel shows cells.
pub(crate) fn is_lit([x, y]: [u32; 2]) -> bool {
    x % 2 == 1 && y % 2 == 1
}

/// Pixels that show cells.
pub(crate) fn lit_pixels() -> u64 {
    u64::from(FILM[0] / 2) * u64::from(FILM[1] / 2)
}

/// The share of uniform samples that falls in one column of cells.
pub(crate) fn share() -> f64 {
    let side = 1.0 - 2.0 * MARGIN;
    side * side / CELLS as f64
}

/// The cell at a film point in pixels from the top left, if one is there.
pub(crate) fn cell_at(point: DVec2) -> Option<[usize; 2]> {
    let corner = point.floor();
    let inside = corner.cmpge(DVec2::ZERO).all() && corner.cmplt(FILM.map(f64::from).into()).all();
    let within = (point - corner - MARGIN) / (1.0 - 2.0 * MARGIN);
    let in_cells = within.cmpge(DVec2::ZERO).all() && within.cmplt(DVec2::ONE).all();
    let is_cell = inside && in_cells && is_lit([corner.x as u32, corner.y as u32]);
    is_cell.then(|| (within * CELLS as f64).to_array().map(|cell| cell as usize))
}

/// What a ray through a film point brings home.
#[cfg(test)]
pub(crate) fn radiance_at(point: DVec2) -> [f64; 3] {
    cell_at(point).map_or(BACKGROUND_RADIANCE, cell_radiance)
}

/// How many of the samples of a pixel fell where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Decoded {
    /// In each column, row, falling and rising diagonal of cells.
    pub(crate) lines: [[u32; CELLS]; 4],
    pub(crate) background: u32,
}

impl Decoded {
    /// One sample, in a cell or on the background.
    pub(crate) fn of_sample(cell: Option<[usize; 2]>) -> Self {
        let mut lines = [[0; CELLS]; 4];
        let places = cell.map(lines_of).into_iter().flatten();
        places.zip(&mut lines).for_each(|(place, counts)| counts[place] = 1);
        Self { lines, background: u32::from(cell.is_none()) }
    }
}

/// Reads a pixel; `None` if it is no mean of [`SAMPLES`] radiances of the pattern.
pub(crate) fn decode(pixel: [f32; 3]) -> Option<Decoded> {
    let [red, green, blue] = pixel.map(|mean| sum(mean, SAMPLES, BASE.pow(2 * CELLS as u32)));
    let (red, green, blue) = (red?, green?, blue?);
    let counts = |sum, first| std::array::from_fn(|place| digit(sum, BASE, first + place));
    let lines: [[u32; CELLS]; 4] =
        [counts(red, 0), counts(green, 0), counts(blue, 0), counts(blue, CELLS)];
    let background = digit(red, BASE, BACKGROUND);
    let in_cells = SAMPLES.checked_sub(background)?;
    let is_mean = lines.iter().all(|line| line.iter().sum::<u32>() == in_cells);
    is_mean.then_some(Decoded { lines, background })
}

pub(crate) fn scene() -> SceneDescription {
    let mut painting = Painting::new("pixel-pattern", BACKGROUND_RADIANCE);
    let size = (1.0 - 2.0 * MARGIN) / CELLS as f64;
    for cell in (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| [column, row])) {
        let [column, row] = cell;
        let offset = DVec2::from(cell.map(|number| number as f64)) * size + MARGIN;
        let corners = places().filter(|at| is_lit(*at)).map(|at| corner(at) + offset);
        let areas = corners.map(|corner| [corner, corner + size]);
        painting.paint(format!("cell {column}, {row}"), cell_radiance(cell), areas);
    }
    painting.scene()
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
    fn what_is_written_can_be_read() {
        let of = |cells: [Option<[usize; 2]>; 3]| {
            let radiances = cells.map(|cell| cell.map_or(BACKGROUND_RADIANCE, cell_radiance));
            decode(std::array::from_fn(|c| {
                (radiances.iter().map(|radiance| radiance[c]).sum::<f64>() / 3.0) as f32
            }))
        };
        let decoded = of([Some([4, 4]), Some([4, 4]), Some([0, 1])]).unwrap();
        let lines = [[1, 0, 0, 0, 2], [0, 1, 0, 0, 2], [2, 0, 0, 0, 1], [0, 1, 0, 2, 0]];
        assert_eq!(decoded, Decoded { lines, background: 0 });
        assert_eq!(of([None, None, None]).unwrap().background, 3);
        assert_eq!(of([None, None, Some([2, 2])]).unwrap().background, 2);
    }

    #[test]
    fn other_pixels_cannot() {
        let dark = [512.0, 0.0, 0.0];
        for pixel in [[0.0; 3], [1024.0, 1.0, 0.0], [f32::NAN; 3], [f32::INFINITY; 3], dark] {
            assert_eq!(decode(pixel), None, "{pixel:?}");
        }
    }
}
