//! Part 3: lights and direct lighting.

use super::Cause;

/// See its headline.
pub static WORLD_COSINE: Cause = Cause {
    name: "world-cosine",
    headline: "the cosine is taken in world space, as if every surface faced +z",
    look_at: "direct lighting, where the cosine of the incident direction is taken",
    remedy: "Use the local direction's z, or the dot product with the shading normal.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&WORLD_COSINE];
