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

/// See its headline.
pub static LAMP_SHADOWS_ITSELF: Cause = Cause {
    name: "lamp-shadows-itself",
    headline: "the lamp shadows itself",
    look_at: "direct lighting, where the shadow ray ends",
    remedy: "End the shadow ray a little short of the sampled point: t_max = distance − ε.",
};

/// See its headline.
pub static DIVIDED_TWICE_BY_SAMPLES: Cause = Cause {
    name: "light-samples-divided-twice",
    headline: "the sum over light samples is divided by their number twice",
    look_at: "direct lighting, where the mean over samples is taken",
    remedy: "Divide once, after the loop over the samples of one light.",
};

/// See its headline.
pub static NOT_DIVIDED_BY_SAMPLES: Cause = Cause {
    name: "light-samples-not-divided",
    headline: "the sum over light samples is not divided by their number",
    look_at: "direct lighting, after the loop over samples",
    remedy: "Divide the sum by the number of samples of that light.",
};

/// See its headline.
pub static EMISSION_OVER_PI: Cause = Cause {
    name: "emission-over-pi",
    headline: "direct light is a factor π too dark: π is divided out twice, or emission is taken for radiosity",
    look_at: "direct lighting, where emission and f are multiplied",
    remedy: "Emission is radiance as it stands; f of a diffuse surface holds the only 1/π.",
};

/// See its headline.
pub static COSINE_TWICE: Cause = Cause {
    name: "cosine-twice",
    headline: "the cosine at the surface is multiplied in twice",
    look_at: "direct lighting, where f, the cosine and the emission are multiplied",
    remedy: "f does not hold the cosine; multiply by it once.",
};

/// See its headline.
pub static COSINE_FORGOTTEN: Cause = Cause {
    name: "cosine-forgotten",
    headline: "the cosine at the surface is missing",
    look_at: "direct lighting, where f and the emission are multiplied",
    remedy: "Multiply by the cosine between the normal and the incident direction.",
};

/// See its headline.
pub static TWICE_AS_BRIGHT: Cause = Cause {
    name: "direct-light-twice",
    headline: "direct light is counted twice",
    look_at: "direct lighting: emission, the density of the samples, or a sum that is added two times",
    remedy: "Each light sample counts once, with the density it was drawn with.",
};

/// See its headline.
pub static HALF_AS_BRIGHT: Cause = Cause {
    name: "direct-light-halved",
    headline: "direct light is halved",
    look_at: "direct lighting: the density of the samples, or an average over estimators that each are whole",
    remedy: "A hemisphere sample has density 1/2π; a whole estimate needs no 1/2.",
};

/// See its headline.
pub static TIMES_PDF: Cause = Cause {
    name: "multiplied-by-pdf",
    headline: "samples are multiplied by their density where they should be divided",
    look_at: "direct lighting, where a sample is weighted",
    remedy: "Each sample counts f · cos θ · radiance / pdf.",
};

/// See its headline.
pub static PDF_FORGOTTEN: Cause = Cause {
    name: "pdf-forgotten",
    headline: "samples are not divided by their density",
    look_at: "direct lighting, where a sample is weighted",
    remedy: "Each sample counts f · cos θ · radiance / pdf.",
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
    &LAMP_SHADOWS_ITSELF,
    &DIVIDED_TWICE_BY_SAMPLES,
    &NOT_DIVIDED_BY_SAMPLES,
    &EMISSION_OVER_PI,
    &COSINE_TWICE,
    &COSINE_FORGOTTEN,
    &TWICE_AS_BRIGHT,
    &HALF_AS_BRIGHT,
    &TIMES_PDF,
    &PDF_FORGOTTEN,
];
