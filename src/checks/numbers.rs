//! The random numbers that a batch of sampling calls is handed.

use crate::contract::{BuiltScene, LightSample, Randomness, Result};
use crate::math::rng::{Seed, in_square, uniform};
use glam::{DVec2, DVec3};

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
    pub(crate) fn new(seed: Seed, count: usize) -> Self {
        let stream = &mut seed.stream();
        let points = (0..count).map(|_| in_square(stream)).collect();
        let lobes = (0..count).map(|_| uniform(stream)).collect();
        Self { points, lobes, seed }
    }

    /// Samples of a light, one from each point, by as many of these numbers.
    pub(crate) fn sample_light(
        &self,
        scene: &mut dyn BuiltScene,
        light: u32,
        from: &[DVec3],
    ) -> Result<Vec<LightSample>> {
        let mut samples = vec![LightSample::NONE; from.len()];
        scene.sample_light(light, from, self.randomness(), &mut samples)?;
        Ok(samples)
    }

    pub(crate) fn randomness(&self) -> Randomness<'_> {
        Randomness { points: &self.points, lobes: &self.lobes, seed: self.seed.0 }
    }
}
