//! What must hold whatever is rendered: finite radiance, seeds that matter, answers that repeat.

mod radiance_is_finite;

pub use radiance_is_finite::RadianceIsFinite;
