//! Pictures cut into cells of several sizes, so that errors of any extent stand out at one of them.
//!
//! A cell's value is a weighted mean over its pixels. The weights come from the reference alone and
//! fall with brightness: an emitter in view, a hundred times brighter than what it lights, would
//! otherwise decide alone, and its noisy edge with it.

use crate::image::{Image, luminance};
use crate::stats::law::upper_median;
use crate::stats::plan::level::SCALES;
use crate::text::spoken;
use serde::Serialize;
use std::ops::Range;

/// Red, green, blue and luminance.
pub(crate) const COMPONENTS: usize = 4;

/// The place of [`Scale::Tile8`] among the scales.
pub(super) const TILES: usize = 1;

/// What of a pixel is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// First channel.
    Red,
    /// Second channel.
    Green,
    /// Third channel.
    Blue,
    /// Rec. 709.
    Luminance,
}

impl Component {
    /// In the order in which cells keep them.
    pub(crate) const ALL: [Component; COMPONENTS] =
        [Component::Red, Component::Green, Component::Blue, Component::Luminance];
}

spoken! {
    /// The size of cells.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Scale {
        /// One pixel.
        Pixel = "one pixel",
        /// 8 by 8 pixels.
        Tile8 = "8 × 8 pixels",
        /// 32 by 32 pixels.
        Tile32 = "32 × 32 pixels",
        /// 8 whole rows.
        Rows = "8 rows",
        /// Everything.
        Whole = "the whole picture",
    }
}

impl Scale {
    /// From the finest to the coarsest.
    pub(crate) const ALL: [Scale; SCALES] =
        [Scale::Pixel, Scale::Tile8, Scale::Tile32, Scale::Rows, Scale::Whole];

    /// Whether few runs may confirm a cell: of a thousand pixels or more. Small ones may be out because rare light has not
    /// come.
    pub(super) fn is_large(self) -> bool {
        !matches!(self, Scale::Pixel | Scale::Tile8)
    }

    /// Width and height of a cell that is not cut off by the border.
    fn cell_size(self, width: usize, height: usize) -> (usize, usize) {
        match self {
            Scale::Pixel => (1, 1),
            Scale::Tile8 => (8, 8),
            Scale::Tile32 => (32, 32),
            Scale::Rows => (width, 8),
            Scale::Whole => (width, height),
        }
    }
}

/// A picture cut into cells of one scale.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub(super) scale: Scale,
    pub(super) columns: usize,
    pub(super) rows: usize,
    cell: (usize, usize),
    picture: (usize, usize),
}

/// The pixels of a cell: column and row of the top left one, width and height.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Extent {
    pub(crate) x: usize,
    pub(crate) y: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl Grid {
    pub(super) fn new(scale: Scale, width: usize, height: usize) -> Self {
        let cell = scale.cell_size(width, height);
        let columns = width.div_ceil(cell.0);
        let rows = height.div_ceil(cell.1);
        Self { scale, columns, rows, cell, picture: (width, height) }
    }

    /// Of a whole cell; those at the edges may have fewer.
    pub(super) fn pixels(&self) -> usize {
        self.cell.0 * self.cell.1
    }

    /// Cells, each with all components.
    pub(super) fn len(&self) -> usize {
        self.columns * self.rows
    }

    pub(super) fn extent(&self, cell: usize) -> Extent {
        let (x, y) = (cell % self.columns * self.cell.0, cell / self.columns * self.cell.1);
        let width = self.cell.0.min(self.picture.0 - x);
        let height = self.cell.1.min(self.picture.1 - y);
        Extent { x, y, width, height }
    }

    /// The pixels in their order, as stretches of rows that lie in one cell, with its number.
    fn stretches(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        let (width, height) = self.picture;
        (0..height).flat_map(move |y| {
            let (row, cells) = (y * width, y / self.cell.1 * self.columns);
            (0..self.columns).map(move |column| {
                let [from, to] = [column, column + 1].map(|c| (c * self.cell.0).min(width));
                (cells + column, row + from..row + to)
            })
        })
    }

    /// The weighted mean of the pixels' values over each cell, all components: cell by cell.
    fn means(&self, weights: &[f64], values: &[[f64; COMPONENTS]]) -> Vec<f64> {
        let mut sums = vec![[0.0; COMPONENTS]; self.len()];
        let mut total = vec![0.0; self.len()];
        for (cell, pixels) in self.stretches() {
            for (weight, value) in weights[pixels.clone()].iter().zip(&values[pixels]) {
                total[cell] += weight;
                for (sum, value) in sums[cell].iter_mut().zip(value) {
                    *sum += weight * value;
                }
            }
        }
        let mean = |(sums, total): ([f64; COMPONENTS], f64)| sums.map(|sum| sum / total);
        sums.into_iter().zip(total).map(mean).collect::<Vec<_>>().into_flattened()
    }

    /// The standard error of each cell's mean, from those of its pixels, which are independent of
    /// each other.
    fn standard_errors(&self, weights: &[f64], errors: &Image) -> Vec<f64> {
        // How the noise of the channels hangs together is not known: that of the luminance is at most this.
        let squares = |pixel: &[f32; 3]| components(*pixel).map(|e| e * e);
        let squares: Vec<_> = errors.pixels.iter().map(squares).collect();
        let weighted: Vec<f64> = weights.iter().map(|weight| weight * weight).collect();
        let [of_squares, of_weights] = [&weighted[..], weights].map(|w| self.totals(w));
        let share = |cell: usize| of_squares[cell] / (of_weights[cell] * of_weights[cell]);
        let means = self.means(&weighted, &squares);
        means.iter().enumerate().map(|(i, m)| (m * share(i / COMPONENTS)).sqrt()).collect()
    }

    /// The number of the cell that a pixel lies in.
    fn cell_of(&self, [x, y]: [usize; 2]) -> usize {
        y / self.cell.1 * self.columns + x / self.cell.0
    }

    /// What the pixels of each cell weigh together.
    fn totals(&self, weights: &[f64]) -> Vec<f64> {
        let mut totals = vec![0.0; self.len()];
        for (cell, pixels) in self.stretches() {
            weights[pixels].iter().for_each(|weight| totals[cell] += weight);
        }
        totals
    }
}

/// The cells up to `reach` away from one, and that one, of so many columns and rows.
pub(super) fn around(
    (width, height): (usize, usize),
    cell: usize,
    reach: usize,
) -> impl Iterator<Item = usize> {
    let (x, y) = (cell % width, cell / width);
    let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
    let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

/// The components of a colour, in their order.
pub(super) fn components(pixel: [f32; 3]) -> [f64; COMPONENTS] {
    let [red, green, blue] = pixel.map(f64::from);
    [red, green, blue, luminance(pixel)]
}

/// The cells of all scales over pictures of one size.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    pub(super) grids: Vec<Grid>,
    weights: Vec<f64>,
}

impl Cells {
    /// Cells weighted after the brightness of `guide`.
    pub(super) fn new(guide: &Image) -> Self {
        let grids = Scale::ALL.map(|scale| Grid::new(scale, guide.width, guide.height));
        let levels: Vec<f64> = guide.pixels.iter().map(|pixel| luminance(*pixel)).collect();
        let lit = levels.iter().copied().filter(|level| *level > 0.0);
        let typical = upper_median(lit).unwrap_or(1.0);
        let weights = levels.into_iter().map(|level| typical / (level.max(0.0) + typical));
        Self { grids: grids.to_vec(), weights: weights.collect() }
    }

    /// The values of all cells of one picture, scale by scale, cell by cell, component by
    /// component.
    pub(super) fn values(&self, image: &Image) -> Vec<f64> {
        let values: Vec<_> = image.pixels.iter().map(|pixel| components(*pixel)).collect();
        self.grids.iter().flat_map(|grid| grid.means(&self.weights, &values)).collect()
    }

    /// The standard errors of all cells, from those of the pixels.
    pub(super) fn standard_errors(&self, errors: &Image) -> Vec<f64> {
        self.grids.iter().flat_map(|grid| grid.standard_errors(&self.weights, errors)).collect()
    }

    /// Of each cell of a large scale, the tiles of 8 by 8 pixels in it, each with its share of the cell's weight.
    pub(super) fn tiles_of(&self, scale: usize) -> Vec<Vec<(usize, f64)>> {
        let (tiles, grid) = (&self.grids[TILES], &self.grids[scale]);
        let [of_tiles, of_cells] = [tiles, grid].map(|grid| grid.totals(&self.weights));
        let mut inside = vec![Vec::new(); grid.len()];
        for (tile, weight) in of_tiles.into_iter().enumerate() {
            let extent = tiles.extent(tile);
            let cell = grid.cell_of([extent.x, extent.y]);
            inside[cell].push((tile, weight / of_cells[cell]));
        }
        inside
    }

    /// Where the values of each scale lie among all.
    pub(super) fn ranges(&self) -> Vec<Range<usize>> {
        let mut end = 0;
        let range = |grid: &Grid| {
            let start = end;
            end += grid.len() * COMPONENTS;
            start..end
        };
        self.grids.iter().map(range).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_in_the_extent_of_its_cell() {
        for scale in Scale::ALL {
            let grid = Grid::new(scale, 37, 21);
            let mut next = 0;
            for (cell, pixels) in grid.stretches() {
                assert_eq!(pixels.start, next, "{scale}");
                next = pixels.end;
                let extent = grid.extent(cell);
                for pixel in pixels {
                    let (x, y) = (pixel % 37, pixel / 37);
                    assert!((extent.x..extent.x + extent.width).contains(&x), "{scale}");
                    assert!((extent.y..extent.y + extent.height).contains(&y), "{scale}");
                }
            }
            assert_eq!(next, 37 * 21, "{scale}");
            let pixels: usize =
                (0..grid.len()).map(|c| grid.extent(c).width * grid.extent(c).height).sum();
            assert_eq!(pixels, 37 * 21, "{scale}");
        }
    }

    #[test]
    fn a_constant_picture_has_constant_cells() {
        let image = Image::new(20, 12, [0.25, 0.5, 1.0]);
        let cells = Cells::new(&image);
        for value in cells.values(&image).chunks(COMPONENTS) {
            for (found, expected) in value.iter().zip([0.25, 0.5, 1.0, luminance([0.25, 0.5, 1.0])])
            {
                assert!((found - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn an_emitter_in_view_does_not_decide_alone() {
        let mut image = Image::new(32, 32, [0.1; 3]);
        image.pixels[5] = [1000.0; 3];
        let cells = Cells::new(&image);
        let whole = cells.ranges()[4].start;
        let plain = (1023.0 * 0.1 + 1000.0) / 1024.0;
        let weighted = cells.values(&image)[whole];
        assert!(weighted < 0.31 && plain > 1.0, "{weighted}");
    }

    #[test]
    fn errors_of_independent_pixels_average_out() {
        let flat = Image::new(16, 16, [1.0; 3]);
        let errors = Cells::new(&flat).standard_errors(&Image::new(16, 16, [0.16; 3]));
        let ranges = Cells::new(&flat).ranges();
        assert!((errors[ranges[0].start] - 0.16).abs() < 1e-6);
        assert!((errors[ranges[1].start] - 0.02).abs() < 1e-6);
        assert!((errors[ranges[4].start] - 0.01).abs() < 1e-6);
    }
}
