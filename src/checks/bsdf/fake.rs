//! A Lambertian core, and one of mirrors and glass, that can be wrong in the ways these checks are for.

use super::interface::{Interface, Mistake};
use crate::checks::fake::Fake;
use crate::contract::{BsdfSample, BsdfValue, Conventions};
use crate::math::sphere::at_height;
use crate::scene::{Material, Surface};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Right by default.
#[derive(Clone, Copy)]
pub(crate) struct Lambertian {
    /// Multiplies the pdf of samples.
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

/// Chooses between the lobes of an interface by their probability.
#[derive(Clone, Copy)]
pub(crate) struct Smooth {
    pub(crate) mistake: Option<Mistake>,
    pub(crate) conventions: Conventions,
    pub(crate) spoil: fn(&mut BsdfSample),
}

impl Default for Smooth {
    fn default() -> Self {
        Self { mistake: None, conventions: Conventions::default(), spoil: |_| () }
    }
}

impl Smooth {
    pub(crate) fn sample(&self, material: &Material, wo: DVec3, chosen: f64) -> BsdfSample {
        let interface = Interface::new(material.surface, self.conventions);
        let lobes = match self.mistake {
            None => interface.lobes(wo),
            Some(mistake) => interface.mistaken(wo, mistake),
        };
        let share = lobes.reflected.map_or(0.0, |lobe| lobe.probability);
        let lobe = if chosen < share { lobes.reflected } else { lobes.refracted };
        let Some(lobe) = lobe else { return BsdfSample::NONE };
        let mut sample = BsdfSample {
            wi: lobe.wi,
            f: lobe.carried.map(|carried| carried / lobe.wi.z.abs()),
            pdf: lobe.probability,
            is_delta: 1,
            is_valid: 1,
        };
        (self.spoil)(&mut sample);
        sample
    }
}
