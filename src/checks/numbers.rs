//! The random numbers that a batch of sampling calls is handed.

use crate::contract::{BsdfSample, Randomness};
use crate::math::rng::{Seed, uniform};
use glam::{DVec2, DVec3};

/// What a core overwrites: a sample that has failed.
pub const NO_SAMPLE: BsdfSample =
    BsdfSample { wi: DVec3::Z, f: [0.0; 3], pdf: 0.0, is_delta: 0, is_valid: 0 };

/// Numbers for one batch, drawn from one seed.
pub struct Numbers {
    points: Vec<DVec2>,
    lobes: Vec<f64>,
    seed: Seed,
}

impl Numbers {
    /// Draws the numbers of `count` samples.
    pub fn new(seed: Seed, count: usize) -> Self {
        let stream = &mut seed.stream();
        let points = (0..count).map(|_| DVec2::new(uniform(stream), uniform(stream))).collect();
        let lobes = (0..count).map(|_| uniform(stream)).collect();
        Self { points, lobes, seed }
    }

    /// As a core is handed them.
    pub fn randomness(&self) -> Randomness<'_> {
        Randomness { points: &self.points, lobes: &self.lobes, seed: self.seed.0 }
    }
}
