//! What sampling a surface answers.

use glam::Vec3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scattering {
    /// Towards the light, local frame, unit.
    pub(crate) wi: Vec3,
    /// `f · |cos θi| / pdf`, RGB.
    pub(crate) weight: Vec3,
    /// Pdf, per steradian; for a delta lobe the probability of having chosen it.
    pub(crate) pdf: f32,
}
