//! Radiance along single rays: direct light, bounces, roulette.

mod bounces_add_up;
mod estimate;
mod estimators_agree;
mod mean_radiance;
mod mistaken;
mod radiance_is_linear;

pub use bounces_add_up::BouncesAddUp;
pub use estimators_agree::EstimatorsAgree;
pub use mean_radiance::MeanRadiance;
pub use radiance_is_linear::RadianceIsLinear;
