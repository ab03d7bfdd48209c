//! Samples of point and directional lights, whose every number is known.

use crate::cause::{Cause, convention, light as cause};
use crate::checks::numbers::Numbers;
use crate::checks::{Measure, Result};
use crate::contract::{BuiltScene, Falloff, LightSample};
use crate::math::rng::{Seed, uniform};
use crate::scene::Light;
use crate::stats::{Compared, judge_exact};
use glam::DVec3;

/// Points from which lights are sampled, in a cube of this half width around the origin.
const POINTS: usize = 256;

const REACH: f64 = 3.0;

/// What there is to say of one light.
pub(super) struct Judged {
    pub(super) measures: Vec<Measure>,
    pub(super) cause: Option<&'static Cause>,
}

/// One sample from each of some points.
pub(super) struct Sampled {
    pub(super) from: Vec<DVec3>,
    pub(super) samples: Vec<LightSample>,
}

impl Sampled {
    pub(super) fn new(scene: &mut dyn BuiltScene, light: u32, seed: Seed) -> Result<Self> {
        let stream = &mut seed.child("points").stream();
        let mut coordinate = || REACH * (2.0 * uniform(stream) - 1.0);
        let from: Vec<_> =
            (0..POINTS).map(|_| DVec3::new(coordinate(), coordinate(), coordinate())).collect();
        let samples = Numbers::new(seed, POINTS).sample_light(scene, light, &from)?;
        Ok(Self { from, samples })
    }

    pub(super) fn judge_delta(&self, light: &Light, falloff: Falloff, tolerance: f64) -> Judged {
        let right = |from: DVec3| expected(light, from, falloff);
        let pairs = || self.from.iter().map(|from| right(*from)).zip(&self.samples);
        let usable = self.samples.iter().filter(|s| s.is_valid == 1 && s.is_delta == 1).count();
        let directions = judge_exact(pairs().map(|(expected, sample)| {
            Compared::within(sample.wi.distance(expected.wi), 0.0, tolerance)
        }));
        let distances = judge_exact(pairs().filter(|(e, _)| e.distance.is_finite()).map(
            |(expected, sample)| Compared::relative(sample.distance, expected.distance, tolerance),
        ));
        let radiances = judge_exact(pairs().flat_map(|(expected, sample)| {
            let channel = move |c: usize| {
                Compared::relative(sample.radiance[c] / sample.pdf, expected.radiance[c], tolerance)
            };
            (0..3).map(channel)
        }));
        let mut measures = vec![
            Measure::exact(
                "samples marked as delta",
                usable as f64,
                self.samples.len() as f64,
                0.0,
            ),
            Measure::worst("direction, how far off", &directions),
            Measure::worst("radiance over pdf", &radiances),
        ];
        if distances.compared > 0 {
            measures.push(Measure::worst("distance", &distances));
        }
        let name = if distances.compared > 0 { "the point light" } else { "the sun" };
        let measures = measures.into_iter().map(|measure| measure.of_row(name)).collect();
        Judged { measures, cause: self.mistake(light, falloff, tolerance) }
    }

    /// The mistake that predicts every sample.
    pub(super) fn mistake(
        &self,
        light: &Light,
        falloff: Falloff,
        tolerance: f64,
    ) -> Option<&'static Cause> {
        let predicts = |change: &dyn Fn(Expected) -> Expected, falloff: Falloff| {
            self.from.iter().zip(&self.samples).all(|(from, sample)| {
                let predicted = change(expected(light, *from, falloff));
                let is_like = |c: usize| {
                    let ratio = sample.radiance[c] / sample.pdf / predicted.radiance[c];
                    (ratio - 1.0).abs() <= tolerance
                };
                sample.wi.distance(predicted.wi) <= tolerance && (0..3).all(is_like)
            })
        };
        let other = match falloff {
            Falloff::InverseSquare => (Falloff::None, &convention::NO_FALLOFF),
            Falloff::None => (Falloff::InverseSquare, &convention::INVERSE_SQUARE),
        };
        let flipped = |expected: Expected| Expected { wi: -expected.wi, ..expected };
        if predicts(&flipped, falloff) {
            Some(&cause::DIRECTIONAL_FLIPPED)
        } else if matches!(light, Light::Point { .. }) && predicts(&|e| e, other.0) {
            Some(other.1)
        } else {
            None
        }
    }
}

/// What a sample of a delta light has to be.
#[derive(Clone, Copy)]
pub(super) struct Expected {
    pub(super) wi: DVec3,
    pub(super) distance: f64,
    pub(super) radiance: [f64; 3],
}

pub(super) fn expected(light: &Light, from: DVec3, falloff: Falloff) -> Expected {
    match *light {
        Light::Point { position, intensity } => {
            let distance = position.distance(from);
            let weakened = match falloff {
                Falloff::InverseSquare => distance * distance,
                Falloff::None => 1.0,
            };
            let radiance = intensity.map(|intensity| intensity / weakened);
            Expected { wi: (position - from) / distance, distance, radiance }
        }
        Light::Directional { direction, irradiance } => {
            Expected { wi: -direction, distance: f64::INFINITY, radiance: irradiance }
        }
        Light::ConstantSky { .. } | Light::GradientSky { .. } | Light::Area { .. } => {
            Expected { wi: DVec3::ZERO, distance: f64::NAN, radiance: [f64::NAN; 3] }
        }
    }
}
