//! What must hold whatever is rendered: finite radiance, seeds that matter, answers that repeat.

mod neighbouring_seeds;
mod radiance_is_finite;
mod same_seed_same_picture;
mod seeds_matter;

pub use neighbouring_seeds::NeighbouringSeeds;
pub use radiance_is_finite::RadianceIsFinite;
pub use same_seed_same_picture::SameSeedSamePicture;
pub use seeds_matter::SeedsMatter;
