//! Samples of a distribution in cells of the sphere, as chi-square counts them.

use super::distribution::{Distribution, Drawn};
use crate::checks::{CheckError, Result};
use crate::contract::{Capabilities, Core};
use crate::math::quadrature::Diligence;
use crate::math::rng::{Seed, uniform};
use crate::stats::{CellProbabilities, CountSource, Counts, SphereCells, Stage, batch_size};
use glam::DVec3;
use std::f64::consts::TAU;

/// Rings and sectors of the upper hemisphere; all below is one ring more, or as many where samples belong there.
pub(super) const CELLS: (usize, usize) = (10, 20);

/// Batches of samples that may depend on each other: enough to know how much counts vary.
const BATCHES: u64 = 32;

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
    /// The counts of each batch.
    batches: Vec<Counts>,
}

impl<'a> Source<'a> {
    pub(super) fn new(core: &'a mut dyn Core, distribution: &'a Distribution, seed: Seed) -> Self {
        let cells = cells(distribution, 0.0);
        let (is_empty, forbidden, batches) = Default::default();
        Self { core, distribution, seed, cells, is_empty, forbidden, batches }
    }

    /// Its cells in a stage: no seam of a sampler coincides with theirs in all of them.
    pub(super) fn cells_of(&self, stage: Stage) -> SphereCells {
        let turn = TAU * uniform(&mut self.seed.child(stage).child("turn").stream());
        cells(self.distribution, turn)
    }

    /// One, if all samples are independent by the core's word, or by numbers of our own.
    fn batch_count(&self) -> u64 {
        let independent = Capabilities::CALLERS_RANDOMNESS | Capabilities::INDEPENDENT_SAMPLES;
        if self.core.info().capabilities.intersects(independent) { 1 } else { BATCHES }
    }

    /// Draws and counts one batch.
    fn batch(&mut self, seed: Seed, samples: u64) -> Result<Counts> {
        let mut counts = self.cells.count([]);
        let mut in_empty_cells = Vec::new();
        self.distribution.draw(self.core, seed, samples, |drawn: &[Drawn]| {
            let directions = drawn.iter().map(|drawn| drawn.direction);
            counts.add(&self.cells.count(directions.clone()));
            let is_in_empty = |wi: &DVec3| self.is_empty[self.cells.cell_of(*wi)];
            in_empty_cells.extend(directions.flatten().filter(is_in_empty));
        })?;
        if !in_empty_cells.is_empty() {
            self.count_forbidden(&in_empty_cells)?;
        }
        Ok(counts)
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
        self.cells = self.cells_of(stage);
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
        let (seed, batches) = (self.seed.child(stage), self.batch_count());
        let size = if batches == 1 { samples } else { batch_size(samples, batches) };
        self.batches = (0..batches)
            .map(|number| self.batch(seed.child(number), size))
            .collect::<Result<_>>()?;
        let mut all = self.cells.count([]);
        self.batches.iter().for_each(|batch| all.add(batch));
        Ok(all)
    }

    fn forbidden(&self, cell: usize, _samples: u64) -> u64 {
        self.forbidden[cell]
    }

    fn batches(&self) -> &[Counts] {
        &self.batches
    }
}
