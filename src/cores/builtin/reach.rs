//! The domain of a BSDF: the hemisphere above a surface, or the sphere where light is transmitted.

use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Where a surface takes light from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Reach {
    /// The hemisphere around this normal.
    Above(DVec3),
    /// Both sides.
    Everywhere,
}

impl Reach {
    /// The pdf of samples of environment lights: with the cosine above a surface, else uniform.
    pub(crate) fn sky_pdf(self, wi: DVec3) -> f64 {
        match self {
            Self::Above(normal) => normal.dot(wi).max(0.0) * FRAC_1_PI,
            Self::Everywhere => FRAC_1_PI / 4.0,
        }
    }
}
