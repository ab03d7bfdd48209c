//! Part 3: sampling directions and their densities.

use super::Cause;

/// See its headline.
pub static DENSITY_OF_OTHER_SAMPLER: Cause = Cause {
    name: "density-of-other-sampler",
    headline: "directions are drawn by one sampler and their density is that of another",
    look_at: "the sampler, where the pdf is written",
    remedy: "Cosine-distributed directions have density cos θ/π, uniform ones 1/2π.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&DENSITY_OF_OTHER_SAMPLER];
