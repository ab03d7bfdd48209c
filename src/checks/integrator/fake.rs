//! A core whose estimates of radiance are whatever a test draws.

use crate::checks::testing::info;
use crate::contract::{
    Acceleration, BuildStats, BuiltScene, Core, CoreInfo, IntegratorSettings, Precision, Ray,
    Result,
};
use crate::math::rng::{Seed, Stream};
use crate::scene::SceneDescription;

/// Draws one estimate, the same in every channel.
#[derive(Clone, Copy)]
pub struct Draws<F>(pub F);

impl<F: Fn(&mut Stream, &IntegratorSettings) -> f64 + Copy + Send> Core for Draws<F> {
    fn info(&self) -> CoreInfo {
        info(Precision::Double)
    }

    fn build_scene(
        &mut self,
        _: &SceneDescription,
        _: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        Ok(Box::new(*self))
    }
}

impl<F: Fn(&mut Stream, &IntegratorSettings) -> f64 + Send> BuiltScene for Draws<F> {
    fn stats(&self) -> BuildStats {
        BuildStats::default()
    }

    fn radiance(
        &mut self,
        _: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let mut stream = Seed(settings.seed).stream();
        radiance.iter_mut().for_each(|value| *value = [(self.0)(&mut stream, settings); 3]);
        Ok(())
    }
}
