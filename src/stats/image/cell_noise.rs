//! The noise of a picture's cells: what its runs showed, and what is known without them.
//!
//! Light that few samples find is easily missed by all runs of a screen. Then a cell is too dark and
//! hardly varies: by its own spread alone every picture with rare light in it would be suspected.
//! Two things tell how noisy such a cell is:
//!
//! - The reference, from a hundred times the samples, has seen that light. Its standard errors show
//!   which cells hold it; how much noisier the runs are is told by the cells around, taken together,
//!   and by those of them that the reference knows about as well: it spreads its samples evenly,
//!   which helps it more with light from wide regions than with edges.
//! - At an edge samples fall to either side by chance, and a reference that spreads its samples
//!   evenly over the pixel knows nothing of that. A sample between a and b whose mean is m has a
//!   variance of at most (m − a)(b − m) (Bhatia and Davis 2000); a and b are the darkest and the
//!   brightest of the pixels around, for a sliver of an emitter may fill no pixel but at its end.
//!
//! What is known needs no more sigmas than a normal variable, Student's t many more: each counts
//! with its own, and the larger decides.

use super::cells::{COMPONENTS, Grid, Scale, around};
use super::target::{Frozen, Target};
use crate::stats::law::{Spread, normal_upper, student_upper};
use std::collections::BTreeMap;
use std::ops::Range;

/// How far around a cell others tell of its noise, in cells.
const REACH: usize = 4;

/// By which factor the reference's standard errors of cells differ at most that it knows alike.
const ALIKE: f64 = 2.0;

/// The standard errors of the mean cells of some runs.
pub(super) struct CellNoise<'a> {
    pub(super) spread: &'a Spread,
    /// How many standard errors of its own a cell of each scale is suspected at.
    pub(super) critical: [f64; Scale::ALL.len()],
    /// The least standard errors of all cells, in the sigmas of their own.
    known: Vec<f64>,
}

impl<'a> CellNoise<'a> {
    /// Of runs of so many samples a pixel, of which any cell is suspected without cause with
    /// probability `level`. Of scales that are not `wanted` nothing more is known than the runs show.
    pub(super) fn of(
        spread: &'a Spread,
        target: &Target,
        samples: u32,
        level: f64,
        wanted: impl Fn(Scale) -> bool,
    ) -> Self {
        let mut critical = [0.0; Scale::ALL.len()];
        let mut known = Vec::with_capacity(spread.len());
        let samples = f64::from(samples) * (spread.freedom() + 1.0);
        for (scale, grid) in target.cells.grids.iter().enumerate() {
            let cells = COMPONENTS * grid.len();
            let level = level / (2 * Scale::ALL.len() * cells) as f64;
            critical[scale] = student_upper(level, spread.freedom());
            let fewer_sigmas = normal_upper(level) / critical[scale];
            let start = known.len();
            if !wanted(grid.scale) {
                known.resize(start + cells, 0.0);
                continue;
            }
            let neighbours = Neighbours::of(spread, target, grid, start..start + cells);
            known.extend((0..cells).map(|index| fewer_sigmas * neighbours.known(index, samples)));
        }
        Self { spread, critical, known }
    }

    /// Of a cell's mean, in the sigmas of [`CellNoise::critical`].
    pub(super) fn standard_error(&self, index: usize) -> f64 {
        self.spread.standard_error(index).max(self.known[index])
    }
}

/// The standard error that the frozen cells of a scale are known to have over some runs of so many samples a pixel: its
/// components vary together, cells on their own.
pub(super) fn known_of_frozen(
    frozen: &Frozen,
    spread: &Spread,
    target: &Target,
    scale: usize,
    samples: u32,
) -> f64 {
    let places = target.cells.ranges()[scale].clone();
    let samples = f64::from(samples) * (spread.freedom() + 1.0);
    let neighbours = Neighbours::of(spread, target, &target.cells.grids[scale], places.clone());
    let mut of_cells = BTreeMap::<usize, f64>::new();
    for (place, _, weight) in &frozen.terms {
        let index = place - places.start;
        *of_cells.entry(index / COMPONENTS).or_default() +=
            weight * neighbours.known(index, samples);
    }
    of_cells.values().map(|error| error * error).sum::<f64>().sqrt()
}

/// The cells of one scale, each looked at from all that are near it.
struct Neighbours<'a> {
    grid: &'a Grid,
    expected: &'a [f64],
    /// Standard errors of the reference.
    errors: &'a [f64],
    /// Their squares.
    stored: Vec<f64>,
    /// Squares of the standard errors of the runs.
    seen: Vec<f64>,
}

/// What a component of the cells around one should be, and is.
struct Around {
    mean: f64,
    darkest: f64,
    brightest: f64,
    all: Noisier,
    alike: Noisier,
}

/// How much noisier the runs are than the reference in some cells.
#[derive(Clone, Copy, Default)]
struct Noisier {
    /// Summed squares of standard errors of the runs, and of the reference.
    seen: f64,
    stored: f64,
}

impl Noisier {
    fn add(&mut self, seen: f64, stored: f64) {
        self.seen += seen;
        self.stored += stored;
    }

    /// Of standard errors; none where the reference is exact.
    fn factor(self) -> f64 {
        if self.stored > 0.0 { (self.seen / self.stored).sqrt() } else { 0.0 }
    }
}

impl<'a> Neighbours<'a> {
    /// Of the grid whose cells have these places among all.
    fn of(spread: &Spread, target: &'a Target, grid: &'a Grid, places: Range<usize>) -> Self {
        let errors = &target.errors[places.clone()];
        Self {
            grid,
            expected: &target.expected[places.clone()],
            errors,
            stored: errors.iter().map(|error| error.powi(2)).collect(),
            seen: places.map(|place| spread.standard_error(place).powi(2)).collect(),
        }
    }

    /// What is known of a standard error without the cell itself, over so many samples of a pixel.
    fn known(&self, index: usize, samples: f64) -> f64 {
        let around = self.around(index);
        let by_edges = if self.grid.scale == Scale::Pixel { around.by_edges(samples) } else { 0.0 };
        around.by_reference(self.errors[index]).max(by_edges)
    }

    /// Around the cell whose component has this number on its grid.
    fn around(&self, index: usize) -> Around {
        let (mean, error) = (self.expected[index], self.errors[index]);
        let alike = error / ALIKE..=error * ALIKE;
        let none = Noisier::default();
        let mut taken = Around { mean, darkest: mean, brightest: mean, all: none, alike: none };
        let (cell, component) = (index / COMPONENTS, index % COMPONENTS);
        for other in around((self.grid.columns, self.grid.rows), cell, REACH) {
            let other = COMPONENTS * other + component;
            let (seen, stored) = (self.seen[other], self.stored[other]);
            taken.darkest = taken.darkest.min(self.expected[other]);
            taken.brightest = taken.brightest.max(self.expected[other]);
            taken.all.add(seen, stored);
            if alike.contains(&self.errors[other]) {
                taken.alike.add(seen, stored);
            }
        }
        taken
    }
}

impl Around {
    /// From the reference's standard error of the cell.
    fn by_reference(&self, error: f64) -> f64 {
        error * self.all.factor().max(self.alike.factor())
    }

    /// The largest that so many samples have by falling to either side of an edge.
    fn by_edges(&self, samples: f64) -> f64 {
        ((self.mean - self.darkest) * (self.brightest - self.mean) / samples).sqrt()
    }
}
