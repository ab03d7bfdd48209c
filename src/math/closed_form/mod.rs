//! Radiance that can be written down: the numbers that cases state, and where they come from.
//!
//! Every function has its source beside it and a witness in its tests: quadrature of the defining
//! integral, or a sum that shares no step with the formula. Lengths are scene units, angles
//! radians, radiance W·sr⁻¹·m⁻².
//!
//! Not here: which scene a number belongs to; the cases say that.

pub mod cavity;
pub mod configuration_factor;
pub mod coverage;
pub mod delta_light;
pub mod form_factor;
pub mod fresnel;
pub mod microfacet;
pub mod rough_dielectric;
pub mod roulette;

#[cfg(test)]
mod witness;
