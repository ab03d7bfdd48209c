//! Samples of a distribution in cells of the sphere, as chi-square counts them.

use super::distribution::{Distribution, Drawn};
use crate::checks::{CheckError, Result};
use crate::contract::Core;
use crate::math::quadrature::Diligence;
use crate::math::rng::{Seed, uniform};
use crate::stats::{CellProbabilities, CountSource, Counts, SphereCells, Stage};
use glam::DVec3;
use std::f64::consts::TAU;

/// Rings and sectors of the upper hemisphere; all below is one ring more, or as many where samples belong there.
pub(super) const CELLS: (usize, usize) = (10, 20);

/// Error of the integral over a cell that costs a test of millions of samples nothing.
pub(super) const QUADRATURE: Diligence = Diligence { tolerance: 1e-7, most_evaluations: 4_000_000 };

pub(super) fn cells(distribution: &Distribution, turn: f64) -> SphereCells {
    let cells = match distribution.is_of_sphere() {
        true => SphereCells::sphere(CELLS.0, CELLS.1),
        false => SphereCells::hemisphere(CELLS.0, CELLS.1),
    };
    cells.with_kinks(distribution.kink().as_slice()).turned_by(turn)
}

/// A distribution of a core, in cells that are turned anew for each stage.
pub(super) struct Source<'a> {
    pub(super) core: &'a mut dyn Core,
    pub(super) distribution: &'a Distribution,
    pub(super) seed: Seed,
    pub(super) cells: SphereCells,
    /// Whether the pdf of a cell integrates to 0.
    pub(super) is_empty: Vec<bool>,
    /// Samples in each cell whose own pdf is 0.
    pub(super) forbidden: Vec<u64>,
}

impl<'a> Source<'a> {
    pub(super) fn new(core: &'a mut dyn Core, distribution: &'a Distribution, seed: Seed) -> Self {
        let cells = cells(distribution, 0.0);
        Self { core, distribution, seed, cells, is_empty: Vec::new(), forbidden: Vec::new() }
    }

    /// Asks for the pdf of samples in empty cells: quadrature misses slivers.
    fn count_forbidden(&mut self, samples: &[DVec3]) -> Result<()> {
        let mut pdf = vec![0.0; samples.len()];
        self.distribution.pdf(self.core, samples, &mut pdf)?;
        for (direction, _) in samples.iter().zip(pdf).filter(|(_, pdf)| pdf.is_nan() || *pdf <= 0.0)
        {
            self.forbidden[self.cells.cell_of(*direction)] += 1;
        }
        Ok(())
    }
}

impl CountSource for Source<'_> {
    type Error = CheckError;

    fn expected(&mut self, stage: Stage) -> Result<CellProbabilities> {
        let turn = TAU * uniform(&mut self.seed.child(stage).child("turn").stream());
        self.cells = cells(self.distribution, turn);
        let diligence =
            if self.distribution.is_of_sphere() { Diligence::KINKED } else { QUADRATURE };
        let probabilities = self.cells.probabilities(diligence, &mut |directions, values| {
            self.distribution.pdf(self.core, directions, values)
        })?;
        self.is_empty = probabilities.cells.iter().map(|probability| *probability == 0.0).collect();
        self.forbidden = vec![0; self.cells.len()];
        Ok(probabilities)
    }

    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts> {
        let mut counts = self.cells.count([]);
        let mut in_empty_cells = Vec::new();
        let seed = self.seed.child(stage);
        self.distribution.draw(self.core, seed, samples, |drawn: &[Drawn]| {
            let directions = drawn.iter().map(|drawn| drawn.direction);
            let batch = self.cells.count(directions.clone());
            counts.absorbed += batch.absorbed;
            counts.cells.iter_mut().zip(batch.cells).for_each(|(all, more)| *all += more);
            let is_in_empty = |wi: &DVec3| self.is_empty[self.cells.cell_of(*wi)];
            in_empty_cells.extend(directions.flatten().filter(is_in_empty));
        })?;
        if !in_empty_cells.is_empty() {
            self.count_forbidden(&in_empty_cells)?;
        }
        Ok(counts)
    }

    fn forbidden(&self, cell: usize, _samples: u64) -> u64 {
        self.forbidden[cell]
    }
}
