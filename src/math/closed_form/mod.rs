//! Radiance that can be written down: the numbers that cases state, and where they come from.
//!
//! Every function has its source beside it and a witness in its tests: quadrature of the defining
//! integral, or a sum that shares no step with the formula. Lengths are scene units, angles
//! radians, radiance W·sr⁻¹·m⁻².
//!
//! Most of them are asked by tests alone: `checks::integrator::closed_forms` works the numbers of every
//! case out from its scene.
//!
//! Not here: which scene a number belongs to; the cases say that.

#[cfg(test)]
pub(crate) mod cavity;
#[cfg(test)]
pub(crate) mod configuration_factor;
#[cfg(test)]
pub(crate) mod coverage;
#[cfg(test)]
pub(crate) mod delta_light;
#[cfg(test)]
pub(crate) mod form_factor;
pub(crate) mod fresnel;
pub(crate) mod microfacet;
pub(crate) mod rough_dielectric;
#[cfg(test)]
pub(crate) mod roulette;

#[cfg(test)]
pub(crate) mod witness;
