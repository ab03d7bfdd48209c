//! Radiance along single rays: direct light, bounces, roulette.

mod bounces_add_up;
mod by_convention;
mod estimate;
mod estimators_agree;
#[cfg(test)]
pub(in crate::checks) mod fake;
mod foretold;
mod mean_radiance;
mod radiance_is_linear;
mod roulette_stops_paths;

pub use bounces_add_up::BouncesAddUp;
pub use estimate::{RayEntry, RouletteEntry, draw_estimates, needs, settings};
pub use estimators_agree::EstimatorsAgree;
pub use foretold::MistakeEntry;
pub use mean_radiance::MeanRadiance;
pub use radiance_is_linear::RadianceIsLinear;
pub use roulette_stops_paths::RouletteStopsPaths;
