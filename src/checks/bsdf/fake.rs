//! A Lambertian core that can be wrong in the ways these checks are for.

use crate::checks::fake::Fake;
use crate::contract::{BsdfSample, BsdfValue};
use crate::math::sphere::at_height;
use crate::scene::{Material, Surface};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Right by default.
#[derive(Clone, Copy)]
pub(crate) struct Lambertian {
    /// Multiplies the density of samples.
    pub(crate) sampled_pdf: f64,
    /// Multiplies the value of samples.
    pub(crate) sampled_value: f64,
    /// Multiplies the value by `1 + tilt · wo.z`, which is not reciprocal.
    pub(crate) tilt: f64,
    /// Multiplies the value.
    pub(crate) gain: f64,
    /// Has a value below the horizon.
    pub(crate) shines_through: bool,
}

impl Default for Lambertian {
    fn default() -> Self {
        Self { sampled_pdf: 1.0, sampled_value: 1.0, tilt: 0.0, gain: 1.0, shines_through: false }
    }
}

impl Lambertian {
    /// What it answers for a pair of directions.
    pub(crate) fn value(&self, material: &Material, wo: DVec3, wi: DVec3) -> BsdfValue {
        let Surface::Diffuse { reflectance } = material.surface else {
            return BsdfValue { f: [0.0; 3], pdf: 0.0 };
        };
        if wi.z <= 0.0 && !self.shines_through {
            return BsdfValue { f: [0.0; 3], pdf: 0.0 };
        }
        let factor = self.gain * (1.0 + self.tilt * wo.z) * FRAC_1_PI;
        BsdfValue { f: reflectance.map(|r| r * factor), pdf: wi.z.abs() * FRAC_1_PI }
    }

    /// The core.
    pub(crate) fn core(self) -> Fake {
        Fake {
            value: Box::new(move |material, query| self.value(material, query.wo, query.wi)),
            sample: Box::new(move |material, wo, point, _| {
                let wi = at_height((1.0 - point.x).sqrt(), TAU * point.y);
                let BsdfValue { f, pdf } = self.value(material, wo, wi);
                let f = f.map(|value| value * self.sampled_value);
                BsdfSample { wi, f, pdf: pdf * self.sampled_pdf, is_delta: 0, is_valid: 1 }
            }),
            ..Fake::default()
        }
    }
}
