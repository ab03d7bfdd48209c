//! Radiance along rays: bounces, Russian roulette, how noisy estimates are, what seeds do.

mod bounces_add_up;
mod by_convention;
mod changed_scene;
#[cfg(test)]
mod closed_forms;
mod error_falls_as_root_n;
mod estimate;
mod estimators_agree;
mod foretold;
mod linearity;
mod mean_radiance;
mod neighbouring_seeds;
mod question;
mod radiance_is_finite;
mod radiance_is_linear;
mod real_variance;
mod reported_variance;
mod roulette_law;
mod roulette_stops_paths;
mod same_seed_same_picture;
mod seeds_matter;
mod variance_is_known;

pub(crate) use changed_scene::lit_by;
pub(crate) use estimate::settings;

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<mean_radiance::MeanRadiance>(),
    CheckKind::of::<estimators_agree::EstimatorsAgree>(),
    CheckKind::of::<radiance_is_linear::RadianceIsLinear>(),
    CheckKind::of::<bounces_add_up::BouncesAddUp>(),
    CheckKind::of::<roulette_stops_paths::RouletteStopsPaths>(),
    CheckKind::of::<same_seed_same_picture::SameSeedSamePicture>(),
    CheckKind::of::<seeds_matter::SeedsMatter>(),
    CheckKind::of::<neighbouring_seeds::NeighbouringSeeds>(),
    CheckKind::of::<radiance_is_finite::RadianceIsFinite>(),
    CheckKind::of::<variance_is_known::VarianceIsKnown>(),
    CheckKind::of::<error_falls_as_root_n::ErrorFallsAsRootN>(),
    CheckKind::of::<reported_variance::ReportsItsVariance>(),
];
