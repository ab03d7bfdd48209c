//! Directions counted in cells of equal solid angle, and what a pdf says the counts should be.
//!
//! The cells are rings in cos θ around +z, cut into sectors of φ. The sectors are turned by an
//! angle of one's choice, so that no sampler's own seams coincide with theirs in every stage.

use crate::math::frame::direction;
use crate::math::quadrature::{Diligence, Integral, Rectangle, integrate_rectangles};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A direction whose cosine is below zero by no more than single precision explains is on the
/// horizon.
const HORIZON: f64 = 1e-6;

/// Writes its values, per steradian, for many unit directions.
pub(crate) type BatchPdf<'a, E> = dyn FnMut(&[DVec3], &mut [f64]) -> Result<(), E> + 'a;

/// A division of the sphere into cells: ring by ring from −z to +z, sector by sector within.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereCells {
    /// Edges of the rings in cos θ, ascending from −1 to 1.
    rings: Vec<f64>,
    sectors: usize,
    /// Azimuth at which the first sector begins, radians.
    offset: f64,
    /// Polar angles at which the pdf has a kink, as cos θ.
    kinks: Vec<f64>,
}

impl SphereCells {
    /// The upper hemisphere in `rings` by `sectors` cells; all that is below the horizon is one
    /// ring more.
    pub(crate) fn hemisphere(rings: usize, sectors: usize) -> Self {
        let upper = (0..=rings).map(|ring| ring as f64 / rings as f64);
        Self::new([-1.0].into_iter().chain(upper).collect(), sectors)
    }

    /// The sphere in twice `rings` by `sectors` cells; the horizon is an edge.
    pub(crate) fn sphere(rings: usize, sectors: usize) -> Self {
        let edges = 0..=2 * rings;
        Self::new(edges.map(|ring| ring as f64 / rings as f64 - 1.0).collect(), sectors)
    }

    fn new(rings: Vec<f64>, sectors: usize) -> Self {
        Self { rings, sectors, offset: 0.0, kinks: Vec::new() }
    }

    /// The same cells, the first sector beginning at azimuth `offset`.
    pub(crate) fn turned_by(self, offset: f64) -> Self {
        Self { offset, ..self }
    }

    /// The same cells for a pdf with kinks on the circles of these cos θ.
    pub(crate) fn with_kinks(self, kinks: &[f64]) -> Self {
        Self { kinks: kinks.to_vec(), ..self }
    }

    pub(crate) fn len(&self) -> usize {
        self.ring_count() * self.sectors
    }

    pub(crate) fn ring_count(&self) -> usize {
        self.rings.len() - 1
    }

    pub(crate) fn sector_count(&self) -> usize {
        self.sectors
    }

    /// Edges of the rings in cos θ, ascending.
    pub(crate) fn ring_edges(&self) -> &[f64] {
        &self.rings
    }

    /// Azimuth at which the first sector begins, radians.
    pub(crate) const fn offset(&self) -> f64 {
        self.offset
    }

    /// The range of cos θ and of φ (radians) of a cell.
    pub(crate) fn bounds(&self, cell: usize) -> ([f64; 2], [f64; 2]) {
        let (ring, sector) = (cell / self.sectors, cell % self.sectors);
        let width = TAU / self.sectors as f64;
        let from = self.offset + sector as f64 * width;
        ([self.rings[ring], self.rings[ring + 1]], [from, from + width])
    }

    pub(crate) fn cell_of(&self, direction: DVec3) -> usize {
        let z = if (-HORIZON..0.0).contains(&direction.z) { 0.0 } else { direction.z };
        let ring = self.rings.partition_point(|&edge| edge <= z);
        let ring = ring.clamp(1, self.ring_count()) - 1;
        let turn = ((direction.y.atan2(direction.x) - self.offset) / TAU).rem_euclid(1.0);
        let sector = (turn * self.sectors as f64) as usize;
        ring * self.sectors + sector.min(self.sectors - 1)
    }

    /// Counts samples; `None` is a sample that failed.
    pub(crate) fn count(&self, samples: impl IntoIterator<Item = Option<DVec3>>) -> Counts {
        let mut counts = Counts { cells: vec![0; self.len()], absorbed: 0 };
        for sample in samples {
            match sample {
                Some(direction) => counts.cells[self.cell_of(direction)] += 1,
                None => counts.absorbed += 1,
            }
        }
        counts
    }

    /// The probability of each cell under a pdf per steradian. What is missing to 1 is the
    /// probability that a sample fails. `pdf` answers for many directions at a time.
    pub(crate) fn probabilities<E>(
        &self,
        diligence: Diligence,
        pdf: &mut BatchPdf<'_, E>,
    ) -> Result<CellProbabilities, E> {
        let (owners, areas): (Vec<_>, Vec<_>) =
            (0..self.len()).flat_map(|cell| self.pieces(cell)).unzip();
        let mut directions = Vec::new();
        let pieces = integrate_rectangles(&areas, diligence, &mut |points, values| {
            directions.clear();
            directions.extend(points.iter().map(|p| direction(p.x, p.y)));
            pdf(&directions, values)?;
            // dω = sin θ dθ dφ. In θ, unlike in cos θ, a smooth pdf is smooth at the poles.
            points.iter().zip(values).for_each(|(p, value)| *value *= p.x.sin());
            Ok(())
        })?;
        let mut cells = vec![Integral::default(); self.len()];
        owners.into_iter().zip(pieces).for_each(|(cell, piece)| cells[cell] += piece);
        Ok(CellProbabilities::new(cells))
    }

    /// The same of a pdf that answers for one direction and never fails.
    #[cfg(test)]
    pub(crate) fn probabilities_of(&self, pdf: impl Fn(DVec3) -> f64) -> CellProbabilities {
        let mut batch = |directions: &[DVec3], values: &mut [f64]| {
            directions.iter().zip(values).for_each(|(d, v)| *v = pdf(*d));
            Ok::<_, std::convert::Infallible>(())
        };
        let Ok(probabilities) = self.probabilities(Diligence::default(), &mut batch);
        probabilities
    }

    /// A cell in (θ, φ), cut at the kinks.
    fn pieces(&self, cell: usize) -> Vec<(usize, Rectangle)> {
        let ([low, high], [from, to]) = self.bounds(cell);
        let inside = self.kinks.iter().copied().filter(|kink| low < *kink && *kink < high);
        let mut edges: Vec<f64> = [low, high].into_iter().chain(inside).collect();
        edges.sort_by(f64::total_cmp);
        let piece = |edge: &[f64]| Rectangle {
            low: DVec2::new(edge[1].acos(), from),
            high: DVec2::new(edge[0].acos(), to),
        };
        edges.windows(2).map(|edge| (cell, piece(edge))).collect()
    }
}

/// How many samples fell where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts {
    pub(crate) cells: Vec<u64>,
    /// Samples that failed: the cell "absorbed".
    pub(crate) absorbed: u64,
}

impl Counts {
    pub(crate) fn add(&mut self, other: &Self) {
        self.cells.iter_mut().zip(&other.cells).for_each(|(all, more)| *all += more);
        self.absorbed += other.absorbed;
    }

    pub(crate) fn total(&self) -> u64 {
        self.absorbed + self.cells.iter().sum::<u64>()
    }
}

/// The probability of each cell, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct CellProbabilities {
    pub(crate) cells: Vec<f64>,
    /// Bound on the quadrature error of each.
    pub(crate) errors: Vec<f64>,
    /// That a sample fails: what is missing to 1, never negative.
    pub(crate) absorbed: f64,
    /// The integral of the pdf.
    pub(crate) mass: f64,
}

impl CellProbabilities {
    /// From the integral of the pdf over each cell.
    pub(crate) fn new(cells: Vec<Integral>) -> Self {
        let mass: f64 = cells.iter().map(|cell| cell.value).sum();
        Self {
            errors: cells.iter().map(|cell| cell.error).collect(),
            absorbed: (1.0 - mass).max(0.0),
            mass,
            cells: cells.into_iter().map(|cell| cell.value).collect(),
        }
    }

    /// Known without error, and adding up to 1 or less.
    pub(crate) fn exact(cells: Vec<f64>) -> Self {
        let cells = cells.into_iter().map(|value| Integral { value, error: 0.0 });
        Self::new(cells.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};
    use std::cell::Cell;
    use std::f64::consts::{FRAC_1_PI, PI};

    #[test]
    fn the_middle_of_each_cell_is_in_it() {
        let turned = SphereCells::sphere(5, 12).turned_by(1.234);
        for cells in [SphereCells::hemisphere(10, 20), turned] {
            for cell in 0..cells.len() {
                let (z, phi) = cells.bounds(cell);
                let middle = direction((0.5 * (z[0] + z[1])).acos(), 0.5 * (phi[0] + phi[1]));
                assert_eq!(cells.cell_of(middle), cell);
            }
        }
    }

    #[test]
    fn poles_and_horizon_have_a_cell() {
        let cells = SphereCells::hemisphere(10, 20);
        assert_eq!(cells.cell_of(DVec3::Z) / 20, 10);
        assert_eq!(cells.cell_of(-DVec3::Z) / 20, 0);
        assert_eq!(cells.cell_of(DVec3::X) / 20, 1);
        assert_eq!(cells.cell_of(DVec3::new(1.0, 0.0, -1e-9)) / 20, 1);
    }

    #[test]
    fn the_cosine_pdf_fills_rings_by_the_difference_of_squares() {
        let cells = SphereCells::hemisphere(10, 20).turned_by(0.7);
        let found = cells.probabilities_of(|d| d.z.max(0.0) * FRAC_1_PI);
        for (cell, p) in found.cells.iter().enumerate() {
            let ([low, high], _) = cells.bounds(cell);
            let expected = (high.max(0.0).powi(2) - low.max(0.0).powi(2)) / 20.0;
            assert!((p - expected).abs() < 1e-12, "cell {cell}: {p} is not {expected}");
        }
        assert!((found.mass - 1.0).abs() < 1e-10);
    }

    #[test]
    fn what_the_pdf_lacks_is_absorbed() {
        let cells = SphereCells::sphere(4, 8);
        let found = cells.probabilities_of(|_| 0.75 / (4.0 * PI));
        assert!((found.absorbed - 0.25).abs() < 1e-12);
    }

    #[test]
    fn a_declared_kink_costs_nothing() {
        let evaluations = |cells: SphereCells| {
            let asked = Cell::new(0);
            cells.probabilities_of(|d| {
                asked.set(asked.get() + 1);
                (d.z - 0.333).max(0.0)
            });
            asked.get()
        };
        let cells = SphereCells::hemisphere(4, 8);
        assert!(evaluations(cells.clone().with_kinks(&[0.333])) < evaluations(cells));
    }

    #[test]
    fn every_sample_is_counted_once() {
        let mut stream = Seed(3).stream();
        let samples = (0..1000).map(|_| {
            let theta = PI * uniform(&mut stream);
            (theta < 3.0).then(|| direction(theta, TAU * uniform(&mut stream)))
        });
        let counts = SphereCells::sphere(3, 5).count(samples);
        assert_eq!(counts.total(), 1000);
        assert!(counts.absorbed > 0);
    }
}
