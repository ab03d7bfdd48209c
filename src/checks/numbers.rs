//! The random numbers that a batch of sampling calls is handed.

use crate::contract::Randomness;
use crate::math::rng::{Seed, uniform};
use glam::DVec2;

/// Numbers for one batch, drawn from one seed.
#[derive(Clone)]
pub(crate) struct Numbers {
    /// Two for each sample.
    pub(crate) points: Vec<DVec2>,
    /// One for each sample.
    pub(crate) lobes: Vec<f64>,
    /// For cores that draw their own.
    pub(crate) seed: Seed,
}

impl Numbers {
    /// Draws the numbers of `count` samples.
    pub(crate) fn new(seed: Seed, count: usize) -> Self {
        let stream = &mut seed.stream();
        let points = (0..count).map(|_| DVec2::new(uniform(stream), uniform(stream))).collect();
        let lobes = (0..count).map(|_| uniform(stream)).collect();
        Self { points, lobes, seed }
    }

    /// As a core is handed them.
    pub(crate) fn randomness(&self) -> Randomness<'_> {
        Randomness { points: &self.points, lobes: &self.lobes, seed: self.seed.0 }
    }
}
