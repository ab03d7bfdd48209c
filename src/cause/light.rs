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
    remedy: "End the shadow ray a little short of the sampled point: t_max = distance − ε, and twice that if it also \
             starts ε ahead.",
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

/// See its headline.
pub static DIRECTIONAL_FLIPPED: Cause = Cause {
    name: "directional-flipped",
    headline: "a directional light shines the wrong way",
    look_at: "light sampling, where the direction to the light is made",
    remedy: "wi points to the light: it is minus the direction in which the light travels.",
};

/// See its headline.
pub static SKY_PDF_OF_HEMISPHERE: Cause = Cause {
    name: "sky-pdf-of-hemisphere",
    headline: "the sky is sampled over the whole sphere with the density of the hemisphere",
    look_at: "light sampling, where the pdf is computed",
    remedy: "Directions of the whole sphere have density 1/4π.",
};

/// See its headline.
pub static HEMISPHERE_IGNORED: Cause = Cause {
    name: "hemisphere-ignored",
    headline: "light is sampled even where hemisphere sampling is asked for",
    look_at: "the choice between hemisphere and light sampling",
    remedy: "Let the flag choose the estimator.",
};

/// See its headline.
pub static DIVIDED_BY_ZERO_LIGHTS: Cause = Cause {
    name: "divided-by-zero-lights",
    headline: "without lights the hemisphere's sum of no samples is divided by 0",
    look_at: "hemisphere sampling",
    remedy: "Draw at least one direction, or answer 0 where there is no light.",
};

/// See its headline.
pub static NO_SHADOWS: Cause = Cause {
    name: "no-shadows",
    headline: "light is not blocked by what stands in between",
    look_at: "the shadow ray",
    remedy: "Add a light sample only if nothing lies between the point and the light.",
};

/// See its headline.
pub static SHADOW_BEYOND_LIGHT: Cause = Cause {
    name: "shadow-beyond-light",
    headline: "what lies behind the light casts a shadow",
    look_at: "the shadow ray",
    remedy: "End the shadow ray at the light: t_max = distance − ε.",
};

/// See its headline.
pub static ACNE: Cause = Cause {
    name: "acne",
    headline: "rays that leave a surface meet it again",
    look_at: "the shadow ray",
    remedy: "Start t_min (or the origin) a little off the surface.",
};

/// See its headline.
pub static DIVIDED_IN_LOOP: Cause = Cause {
    name: "divided-in-loop",
    headline: "earlier lights are divided by the number of samples again for each light that follows",
    look_at: "light sampling, the loop over lights",
    remedy: "Divide each light's own sum, then add it to the total.",
};

/// See its headline.
pub static DIVIDED_BY_LIGHTS: Cause = Cause {
    name: "divided-by-lights",
    headline: "the sum over lights is divided by their number",
    look_at: "light sampling, the loop over lights",
    remedy: "Every light adds its share: only the samples of one light are averaged.",
};

/// See its headline.
pub static DELTA_DIVIDED: Cause = Cause {
    name: "delta-divided",
    headline: "a delta light is sampled once and divided by the number of samples",
    look_at: "light sampling, where the number of samples is chosen",
    remedy: "A delta light has one sample: divide by one.",
};

/// See its headline.
pub static LAST_LIGHT_ONLY: Cause = Cause {
    name: "last-light-only",
    headline: "only one of the lights counts",
    look_at: "light sampling, the loop over lights",
    remedy: "Add to the sum outside the loop; do not declare it anew inside.",
};

/// See its headline.
pub static RANGE_KEPT: Cause = Cause {
    name: "range-kept",
    headline: "rays that leave a surface end where the ray before ended",
    look_at: "the ray that leaves a surface",
    remedy: "Give every new ray its own range: t_max is infinite again.",
};

/// See its headline.
pub static HEMISPHERE_IN_WORLD: Cause = Cause {
    name: "hemisphere-in-world",
    headline: "directions of the hemisphere are followed as if they were world directions",
    look_at: "hemisphere sampling",
    remedy: "Turn the local direction into the world before it becomes a ray.",
};

/// See its headline.
pub static FADES_WITH_DISTANCE: Cause = Cause {
    name: "point-light-fades-with-distance",
    headline: "a point light weakens with distance, not with its square",
    look_at: "the sample of a point light",
    remedy: "Its radiance is intensity over distance squared.",
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
    &DIRECTIONAL_FLIPPED,
    &SKY_PDF_OF_HEMISPHERE,
    &HEMISPHERE_IGNORED,
    &DIVIDED_BY_ZERO_LIGHTS,
    &NO_SHADOWS,
    &SHADOW_BEYOND_LIGHT,
    &ACNE,
    &DIVIDED_IN_LOOP,
    &DIVIDED_BY_LIGHTS,
    &DELTA_DIVIDED,
    &LAST_LIGHT_ONLY,
    &RANGE_KEPT,
    &HEMISPHERE_IN_WORLD,
    &FADES_WITH_DISTANCE,
];
