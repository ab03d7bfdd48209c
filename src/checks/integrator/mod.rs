//! Radiance along rays: bounces, Russian roulette, how noisy estimates are, what seeds do.

mod bounces_add_up;
mod by_convention;
#[cfg(test)]
mod closed_forms;
mod error_falls_as_root_n;
mod estimate;
mod estimators_agree;
#[cfg(test)]
pub(in crate::checks) mod fake;
mod foretold;
mod mean_radiance;
mod neighbouring_seeds;
mod radiance_is_finite;
mod radiance_is_linear;
mod reported_variance;
mod roulette_stops_paths;
mod same_seed_same_picture;
mod seeds_matter;
mod variance_is_known;

pub use bounces_add_up::BouncesAddUp;
pub use error_falls_as_root_n::ErrorFallsAsRootN;
pub use estimate::{RayEntry, RouletteEntry, draw_estimates, needs, settings};
pub use estimators_agree::EstimatorsAgree;
pub use foretold::MistakeEntry;
pub use mean_radiance::MeanRadiance;
pub use neighbouring_seeds::NeighbouringSeeds;
pub use radiance_is_finite::RadianceIsFinite;
pub use radiance_is_linear::RadianceIsLinear;
pub use reported_variance::ReportsItsVariance;
pub use roulette_stops_paths::RouletteStopsPaths;
pub use same_seed_same_picture::SameSeedSamePicture;
pub use seeds_matter::SeedsMatter;
pub use variance_is_known::VarianceIsKnown;
