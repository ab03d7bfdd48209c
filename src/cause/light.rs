//! Part 3: lights and direct lighting.

use super::Cause;

/// See its headline.
pub static WORLD_COSINE: Cause = Cause {
    name: "world-cosine",
    headline: "the cosine is taken in world space, as if every surface faced +z",
    look_at: "direct lighting, where the cosine of the incident direction is taken",
    remedy: "Use the local direction's z, or the dot product with the shading normal.",
};

/// See its headline.
pub static LIGHT_COSINE_FORGOTTEN: Cause = Cause {
    name: "light-cosine-forgotten",
    headline: "the density of a light sample lacks the cosine at the light",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_DISTANCE_FORGOTTEN: Cause = Cause {
    name: "light-distance-forgotten",
    headline: "the density of a light sample lacks the square of the distance",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_DENSITY_PER_AREA: Cause = Cause {
    name: "light-density-per-area",
    headline: "the density of a light sample is per area, not per steradian",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_DISTANCE_NOT_SQUARED: Cause = Cause {
    name: "light-distance-not-squared",
    headline: "the density of a light sample has the distance where its square belongs",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_AREA_FORGOTTEN: Cause = Cause {
    name: "light-area-forgotten",
    headline: "the density of a light sample lacks the area of the light",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_AREA_MULTIPLIED: Cause = Cause {
    name: "light-area-multiplied",
    headline: "the density of a light sample is multiplied by the area of the light, not divided",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_DENSITY_INVERTED: Cause = Cause {
    name: "light-density-inverted",
    headline: "the density of a light sample is upside down",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_SURFACE_COSINE: Cause = Cause {
    name: "light-surface-cosine",
    headline: "the density of a light sample has the cosine at the surface, not at the light",
    look_at: "light sampling, where the pdf is computed",
    remedy: "pdf = distance² / (cos θ at the light · area).",
};

/// See its headline.
pub static LIGHT_POINTS_UNEVEN: Cause = Cause {
    name: "light-points-uneven",
    headline: "points on the light are not uniform over it, though their density is that of uniform ones",
    look_at: "light sampling, where two random numbers become a point on the light",
    remedy: "Uniform points of a triangle have weights 1 − √u, √u (1 − v), √u v.",
};

/// See its headline.
pub static LIGHT_SHINES_BACKWARDS: Cause = Cause {
    name: "light-shines-backwards",
    headline: "a light that looks away is sampled as if it shone to the back too",
    look_at: "light sampling, where the cosine at the light is computed",
    remedy: "Where the light's front looks away from the point there is no light: radiance or density 0.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &WORLD_COSINE,
    &LIGHT_COSINE_FORGOTTEN,
    &LIGHT_DISTANCE_FORGOTTEN,
    &LIGHT_DENSITY_PER_AREA,
    &LIGHT_DISTANCE_NOT_SQUARED,
    &LIGHT_AREA_FORGOTTEN,
    &LIGHT_AREA_MULTIPLIED,
    &LIGHT_DENSITY_INVERTED,
    &LIGHT_SURFACE_COSINE,
    &LIGHT_POINTS_UNEVEN,
    &LIGHT_SHINES_BACKWARDS,
];
