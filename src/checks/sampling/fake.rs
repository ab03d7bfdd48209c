//! A core of samplers that can be given any map and any density, for the tests of the checks in this folder.

use crate::checks::testing::info;
use crate::contract::{
    BsdfQuery, BsdfSample, BsdfValue, Core, CoreInfo, DirectionSample, Precision, Randomness,
    Result, Sampler,
};
use crate::math::sphere::at_height;
use crate::scene::Material;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, TAU};

/// Draws by `map` and claims `density`, whatever the sampler; BSDFs do the same with f = pdf.
pub struct FakeSampler {
    /// From the unit square to a direction; `None` fails.
    pub map: fn(DVec2) -> Option<DVec3>,
    /// Per steradian.
    pub density: fn(DVec3) -> f64,
}

/// Malley's method, right.
pub fn cosine(point: DVec2) -> Option<DVec3> {
    Some(at_height((1.0 - point.x).sqrt(), TAU * point.y))
}

/// Archimedes' method, right.
pub fn uniform(point: DVec2) -> Option<DVec3> {
    Some(at_height(1.0 - point.x, TAU * point.y))
}

/// cos θ/π.
pub fn cosine_density(direction: DVec3) -> f64 {
    direction.z.max(0.0) * FRAC_1_PI
}

/// 1/2π.
pub fn uniform_density(direction: DVec3) -> f64 {
    if direction.z > 0.0 { 1.0 / TAU } else { 0.0 }
}

impl Core for FakeSampler {
    fn info(&self) -> CoreInfo {
        info(Precision::Double)
    }

    fn sample_direction(
        &mut self,
        _: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        for (point, sample) in random.points.iter().zip(samples) {
            let direction = (self.map)(*point).unwrap_or(DVec3::Z);
            *sample = DirectionSample { direction, pdf: (self.density)(direction) };
        }
        Ok(())
    }

    fn direction_pdf(&mut self, _: Sampler, directions: &[DVec3], pdf: &mut [f64]) -> Result<()> {
        directions.iter().zip(pdf).for_each(|(direction, pdf)| *pdf = (self.density)(*direction));
        Ok(())
    }

    fn eval_bsdf(
        &mut self,
        _: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        evaluate(self.density, queries, values);
        Ok(())
    }

    fn sample_bsdf(
        &mut self,
        _: &Material,
        _: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        for (point, sample) in random.points.iter().zip(samples) {
            let wi = (self.map)(*point);
            let is_valid = u32::from(wi.is_some());
            let wi = wi.unwrap_or(DVec3::Z);
            let pdf = (self.density)(wi);
            *sample = BsdfSample { wi, f: [pdf; 3], pdf, is_delta: 0, is_valid };
        }
        Ok(())
    }
}

/// `f` is the density itself.
fn evaluate(density: fn(DVec3) -> f64, queries: &[BsdfQuery], values: &mut [BsdfValue]) {
    for (query, value) in queries.iter().zip(values) {
        let pdf = density(query.wi);
        *value = BsdfValue { f: [pdf; 3], pdf };
    }
}

/// Reflects and refracts with the cosine, whatever its material and the viewer, and claims `density`.
pub struct FakeInterface {
    /// The chance of a reflection.
    pub reflected: f64,
    /// Per steradian.
    pub density: fn(DVec3) -> f64,
}

impl Core for FakeInterface {
    fn info(&self) -> CoreInfo {
        info(Precision::Double)
    }

    fn eval_bsdf(
        &mut self,
        _: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        evaluate(self.density, queries, values);
        Ok(())
    }

    fn sample_bsdf(
        &mut self,
        _: &Material,
        _: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        let numbers = random.points.iter().zip(random.lobes);
        for ((point, lobe), sample) in numbers.zip(samples) {
            let up = at_height((1.0 - point.x).sqrt(), TAU * point.y);
            let wi = if *lobe < self.reflected { up } else { -up };
            let pdf = (self.density)(wi);
            *sample = BsdfSample { wi, f: [pdf; 3], pdf, is_delta: 0, is_valid: 1 };
        }
        Ok(())
    }
}
