//! Radiance along rays (direct and indirect lighting, global illumination): bounces, Russian roulette, how noisy estimates are, what seeds do.

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
mod rays_stand_alone;
mod real_variance;
mod reported_variance;
mod roulette_law;
mod roulette_stops_paths;
mod same_seed_same_picture;
mod seeds_matter;
mod size_does_not_matter;
mod variance_is_known;

pub(crate) use changed_scene::lit_by;
pub(crate) use estimate::settings;

use super::checks;

checks! {
    mean_radiance::MeanRadiance,
    estimators_agree::EstimatorsAgree,
    rays_stand_alone::RaysStandAlone,
    radiance_is_linear::RadianceIsLinear,
    size_does_not_matter::SizeDoesNotMatter,
    bounces_add_up::BouncesAddUp,
    roulette_stops_paths::RouletteStopsPaths,
    same_seed_same_picture::SameSeedSamePicture,
    seeds_matter::SeedsMatter,
    neighbouring_seeds::NeighbouringSeeds,
    radiance_is_finite::RadianceIsFinite,
    variance_is_known::VarianceIsKnown,
    error_falls_as_root_n::ErrorFallsAsRootN,
    reported_variance::ReportsItsVariance,
}
