//! Part 3: lights and direct lighting.

use super::{Cause, causes};

causes! {
    WORLD_COSINE = "world-cosine":
        "the cosine is taken in world space, as if every surface faced +z",
        at "direct lighting, where the cosine of the incident direction is taken",
        fix "Use the local direction's z, or the dot product with the shading normal.";
    LIGHT_COSINE_FORGOTTEN = "light-cosine-forgotten":
        "the density of a light sample lacks the cosine at the light",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_DISTANCE_FORGOTTEN = "light-distance-forgotten":
        "the density of a light sample lacks the square of the distance",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_DENSITY_PER_AREA = "light-density-per-area":
        "the density of a light sample is per area, not per steradian",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_DISTANCE_NOT_SQUARED = "light-distance-not-squared":
        "the density of a light sample has the distance where its square belongs",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_AREA_FORGOTTEN = "light-area-forgotten":
        "the density of a light sample lacks the area of the light",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_AREA_MULTIPLIED = "light-area-multiplied":
        "the density of a light sample is multiplied by the area of the light, not divided",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_DENSITY_INVERTED = "light-density-inverted":
        "the density of a light sample is upside down",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_SURFACE_COSINE = "light-surface-cosine":
        "the density of a light sample has the cosine at the surface, not at the light",
        at "light sampling, where the pdf is computed",
        fix "pdf = distance² / (cos θ at the light · area).";
    LIGHT_POINTS_UNEVEN = "light-points-uneven":
        "points on the light are not uniform over it, though their density is that of uniform ones",
        at "light sampling, where two random numbers become a point on the light",
        fix "Uniform points of a triangle have weights 1 − √u, √u (1 − v), √u v.";
    LIGHT_SHINES_BACKWARDS = "light-shines-backwards":
        "a light that looks away is sampled as if it shone to the back too",
        at "light sampling, where the cosine at the light is computed",
        fix "Where the light's front looks away from the point there is no light: radiance or density 0.";
    LAMP_SHADOWS_ITSELF = "lamp-shadows-itself":
        "the lamp shadows itself",
        at "direct lighting, where the shadow ray ends",
        fix "End the shadow ray a little short of the sampled point: t_max = distance − ε, and twice that if it also \
             starts ε ahead.";
    DIVIDED_TWICE_BY_SAMPLES = "light-samples-divided-twice":
        "the sum over light samples is divided by their number twice",
        at "direct lighting, where the mean over samples is taken",
        fix "Divide once, after the loop over the samples of one light.";
    NOT_DIVIDED_BY_SAMPLES = "light-samples-not-divided":
        "the sum over light samples is not divided by their number",
        at "direct lighting, after the loop over samples",
        fix "Divide the sum by the number of samples of that light.";
    EMISSION_OVER_PI = "emission-over-pi":
        "direct light is a factor π too dark: π is divided out twice, or emission is taken for radiosity",
        at "direct lighting, where emission and f are multiplied",
        fix "Emission is radiance as it stands; f of a diffuse surface holds the only 1/π.";
    COSINE_TWICE = "cosine-twice":
        "the cosine at the surface is multiplied in twice",
        at "direct lighting, where f, the cosine and the emission are multiplied",
        fix "f does not hold the cosine; multiply by it once.";
    COSINE_FORGOTTEN = "cosine-forgotten":
        "the cosine at the surface is missing",
        at "direct lighting, where f and the emission are multiplied",
        fix "Multiply by the cosine between the normal and the incident direction.";
    TWICE_AS_BRIGHT = "direct-light-twice":
        "direct light is counted twice",
        at "direct lighting: emission, the density of the samples, or a sum that is added two times",
        fix "Each light sample counts once, with the density it was drawn with.";
    HALF_AS_BRIGHT = "direct-light-halved":
        "direct light is halved",
        at "direct lighting: the density of the samples, or an average over estimators that each are whole",
        fix "A hemisphere sample has density 1/2π; a whole estimate needs no 1/2.";
    TIMES_PDF = "multiplied-by-pdf":
        "samples are multiplied by their density where they should be divided",
        at "direct lighting, where a sample is weighted",
        fix "Each sample counts f · cos θ · radiance / pdf.";
    PDF_FORGOTTEN = "pdf-forgotten":
        "samples are not divided by their density",
        at "direct lighting, where a sample is weighted",
        fix "Each sample counts f · cos θ · radiance / pdf.";
    DIRECTIONAL_FLIPPED = "directional-flipped":
        "a directional light shines the wrong way",
        at "light sampling, where the direction to the light is made",
        fix "wi points to the light: it is minus the direction in which the light travels.";
    SKY_PDF_OF_HEMISPHERE = "sky-pdf-of-hemisphere":
        "the sky is sampled over the whole sphere with the density of the hemisphere",
        at "light sampling, where the pdf is computed",
        fix "Directions of the whole sphere have density 1/4π.";
    HEMISPHERE_IGNORED = "hemisphere-ignored":
        "light is sampled even where hemisphere sampling is asked for",
        at "the choice between hemisphere and light sampling",
        fix "Let the flag choose the estimator.";
    DIVIDED_BY_ZERO_LIGHTS = "divided-by-zero-lights":
        "without lights the hemisphere's sum of no samples is divided by 0",
        at "hemisphere sampling",
        fix "Draw at least one direction, or answer 0 where there is no light.";
    NO_SHADOWS = "no-shadows":
        "light is not blocked by what stands in between",
        at "the shadow ray",
        fix "Add a light sample only if nothing lies between the point and the light.";
    SHADOW_BEYOND_LIGHT = "shadow-beyond-light":
        "what lies behind the light casts a shadow",
        at "the shadow ray",
        fix "End the shadow ray at the light: t_max = distance − ε.";
    ACNE = "acne":
        "rays that leave a surface meet it again",
        at "the shadow ray",
        fix "Start t_min (or the origin) a little off the surface.";
    DIVIDED_IN_LOOP = "divided-in-loop":
        "earlier lights are divided by the number of samples again for each light that follows",
        at "light sampling, the loop over lights",
        fix "Divide each light's own sum, then add it to the total.";
    DIVIDED_BY_LIGHTS = "divided-by-lights":
        "the sum over lights is divided by their number",
        at "light sampling, the loop over lights",
        fix "Every light adds its share: only the samples of one light are averaged.";
    DELTA_DIVIDED = "delta-divided":
        "a delta light is sampled once and divided by the number of samples",
        at "light sampling, where the number of samples is chosen",
        fix "A delta light has one sample: divide by one.";
    LAST_LIGHT_ONLY = "last-light-only":
        "only one of the lights counts",
        at "light sampling, the loop over lights",
        fix "Add to the sum outside the loop; do not declare it anew inside.";
    RANGE_KEPT = "range-kept":
        "rays that leave a surface end where the ray before ended",
        at "the ray that leaves a surface",
        fix "Give every new ray its own range: t_max is infinite again.";
    HEMISPHERE_IN_WORLD = "hemisphere-in-world":
        "directions of the hemisphere are followed as if they were world directions",
        at "hemisphere sampling",
        fix "Turn the local direction into the world before it becomes a ray.";
    FADES_WITH_DISTANCE = "point-light-fades-with-distance":
        "a point light weakens with distance, not with its square",
        at "the sample of a point light",
        fix "Its radiance is intensity over distance squared.";
}
