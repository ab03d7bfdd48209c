//! Part 3: lights and direct lighting (next event estimation, hemisphere sampling).

use super::{Cause, causes};

causes! {
    WORLD_COSINE = "world-cosine":
        "the cosine is taken in world space, as if every surface faced +z",
        at "direct lighting, where the cosine of the incident direction is taken",
        fix "Use the local direction's z, or the dot product with the shading normal.";
    FRAME_OF_GEOMETRIC_NORMAL = "frame-of-geometric-normal":
        "surfaces are shaded by their geometric normals, not by the shading normals of their hits",
        at "direct and indirect lighting, where the local shading frame is made from a hit",
        fix "Build the frame around the shading normal; the geometric one only tells which side is lit.";
    LIGHT_COSINE_FORGOTTEN = "light-cosine-forgotten":
        "the pdf of light sampling lacks the cosine at the light",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_DISTANCE_FORGOTTEN = "light-distance-forgotten":
        "the pdf of light sampling lacks the squared distance",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_PDF_PER_AREA = "light-pdf-per-area":
        "the pdf of light sampling is with respect to area, not solid angle",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_DISTANCE_NOT_SQUARED = "light-distance-not-squared":
        "the pdf of light sampling has the distance, not its square",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_AREA_FORGOTTEN = "light-area-forgotten":
        "the pdf of light sampling lacks the light's area",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_AREA_MULTIPLIED = "light-area-multiplied":
        "the pdf of light sampling is multiplied by the light's area instead of divided",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_PDF_INVERTED = "light-pdf-inverted":
        "light sampling returns the reciprocal of its pdf",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_SURFACE_COSINE = "light-surface-cosine":
        "the pdf of light sampling has the cosine at the surface, not at the light",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "pdf with respect to solid angle = distance² / (cos θ at the light · area).";
    LIGHT_POINTS_UNEVEN = "light-points-uneven":
        "points on the light are not uniform, but the pdf is that of uniform ones",
        at "light sampling, where two random numbers become a point on the light",
        fix "Uniform points of a triangle have barycentric coordinates 1 − √u, √u (1 − v), √u v.";
    LIGHT_SHINES_BACKWARDS = "light-shines-backwards":
        "a one-sided light is sampled as if it also emitted from its back",
        at "light sampling, where the cosine at the light is computed",
        fix "Behind the light's front side the sample is black: radiance 0.";
    EMITTER_SHADOWS_ITSELF = "emitter-shadows-itself":
        "self-shadowing of the emitter: the shadow ray hits the light it was sampled on",
        at "direct lighting, where t_max of the shadow ray is set",
        fix "End the shadow ray just short of the sampled point: t_max = distance − ε, and twice that if it also starts ε ahead.";
    DIVIDED_TWICE_BY_SAMPLES = "light-samples-divided-twice":
        "the sum over light samples is divided by their number twice",
        at "direct lighting, where the mean over samples is taken",
        fix "Divide once, after the loop over the samples of one light.";
    NOT_DIVIDED_BY_SAMPLES = "light-samples-not-divided":
        "the sum over light samples is not divided by their number",
        at "direct lighting, after the loop over samples",
        fix "Divide the sum by the number of samples of that light.";
    EMISSION_OVER_PI = "emission-over-pi":
        "direct light is too dark by a factor π: π is divided out twice, or emission is taken for radiosity",
        at "direct lighting, where the emitted radiance and f are multiplied",
        fix "Emission is radiance as it stands; the only 1/π is in the diffuse BRDF.";
    COSINE_TWICE = "cosine-twice":
        "the cosine at the surface is multiplied in twice",
        at "direct lighting, where f, the cosine and the emitted radiance are multiplied",
        fix "f excludes the cosine: multiply by it once.";
    COSINE_FORGOTTEN = "cosine-forgotten":
        "the cosine at the surface is missing",
        at "direct lighting, where f, the cosine and the emitted radiance are multiplied",
        fix "Multiply by the cosine between the shading normal and wi.";
    TWICE_AS_BRIGHT = "direct-light-twice":
        "direct light is counted twice",
        at "direct lighting: the emitted radiance, the pdf, or a sum that is added twice",
        fix "Each light sample counts once, divided by the pdf it was drawn with.";
    HALF_AS_BRIGHT = "direct-light-halved":
        "direct light is halved",
        at "direct lighting: the pdf, or an average over estimators that are each complete",
        fix "A uniform hemisphere sample has pdf 1/(2π); a complete estimator needs no 1/2.";
    TIMES_PDF = "multiplied-by-pdf":
        "direct light samples are multiplied by their pdf instead of divided",
        at "direct lighting, where a sample is weighted by its pdf",
        fix "Each sample contributes f · cos θ · radiance / pdf.";
    PDF_FORGOTTEN = "pdf-forgotten":
        "direct light samples are not divided by their pdf",
        at "direct lighting, where a sample is weighted by its pdf",
        fix "Each sample contributes f · cos θ · radiance / pdf.";
    DIRECTIONAL_FLIPPED = "directional-flipped":
        "a directional light shines in the opposite direction",
        at "light sampling, where wi of a directional light is set",
        fix "wi points towards the light: it is minus the direction in which the light travels.";
    ENVIRONMENT_PDF_OF_HEMISPHERE = "environment-pdf-of-hemisphere":
        "the environment light is sampled over the sphere with the pdf of the hemisphere",
        at "light sampling (next event estimation), where the pdf is computed",
        fix "Uniform directions of the sphere have pdf 1/(4π).";
    ENVIRONMENT_FROM_ONE_SIDE = "environment-from-one-side":
        "the environment light is sampled over a hemisphere: half of its directions never come",
        at "light sampling (next event estimation), where the direction is sampled",
        fix "Sample directions of the whole sphere, with pdf 1/(4π) where they are uniform.";
    HEMISPHERE_IGNORED = "hemisphere-ignored":
        "light sampling is used even where hemisphere sampling is requested",
        at "the choice between hemisphere sampling and light sampling",
        fix "Let the setting choose the estimator.";
    DIVIDED_BY_ZERO_LIGHTS = "divided-by-zero-lights":
        "without lights, direct lighting divides an empty sum by 0 samples",
        at "direct lighting, where the mean over the samples of all lights is taken",
        fix "Return 0 where there is no light, or draw at least one direction.";
    LIGHT_FROM_BELOW_SUBTRACTED = "light-from-below-subtracted":
        "light that arrives from below the surface is subtracted: its cosine is negative",
        at "direct lighting, where the cosine of a light sample is taken",
        fix "Add a light sample only where cos θ > 0 at the surface.";
    LIGHT_FROM_BELOW_ADDED = "light-from-below-added":
        "light that arrives from below the surface is added: its cosine lost its sign",
        at "direct lighting, where the cosine of a light sample is taken",
        fix "Add a light sample only where cos θ > 0 at the surface; |cos θ| is positive on both sides.";
    NO_SHADOWS = "no-shadows":
        "direct light ignores occlusion",
        at "the shadow ray: whether there is one, its origin, t_min and t_max",
        fix "Add a light sample only if the shadow ray reaches the light unoccluded; its origin is offset by no more than a few roundings.";
    SECONDARY_RAYS_LOST = "secondary-rays-meet-nothing":
        "rays that leave a surface meet nothing: shadow rays, hemisphere samples and bounces alike",
        at "where rays leave a surface: their origin, t_min and t_max",
        fix "Offset the origin by no more than a few roundings, and end the ray at the light, or nowhere.";
    SHADOW_BEYOND_LIGHT = "shadow-beyond-light":
        "surfaces behind the light cast a shadow",
        at "direct lighting, where t_max of the shadow ray is set",
        fix "End the shadow ray at the light: t_max = distance − ε.";
    SHADOW_ACNE = "shadow-acne":
        "shadow acne: rays that leave a surface hit it again (self-intersection)",
        at "the shadow ray, where t_min or its origin is set",
        fix "Start the ray at t_min = ε, or offset its origin along the normal.";
    DIVIDED_IN_LOOP = "divided-in-loop":
        "the sum so far is divided by the number of samples again for each further light",
        at "light sampling, the loop over lights",
        fix "Divide each light's own sum by its samples, then add it to the total.";
    DIVIDED_BY_LIGHTS = "divided-by-lights":
        "the sum over lights is divided by the number of lights",
        at "light sampling, the loop over lights",
        fix "Lights add up: average only over the samples of one light.";
    DELTA_DIVIDED = "delta-divided":
        "a delta light is sampled once and divided by the number of samples",
        at "light sampling, where the number of samples is chosen",
        fix "A delta light takes one sample: divide by one.";
    LAST_LIGHT_ONLY = "last-light-only":
        "only one of the lights counts",
        at "light sampling, the loop over lights",
        fix "Declare the sum outside the loop, and add to it inside.";
    LIGHT_TRIANGLE_NOT_PICKED = "light-pdf-of-one-triangle":
        "the pdf of a mesh light is that of one triangle: the probability of picking it is missing",
        at "sampling the area light, where the pdf is computed",
        fix "Triangles picked by area: 1 / (area of the whole mesh) per area; otherwise multiply by the probability of the pick.";
    SPHERE_LIGHT_AS_DISK = "sphere-light-pdf-of-disk":
        "the solid angle of a sphere light is that of a small disk: π sin² θ",
        at "sampling the sphere light, where the pdf of its cone is computed",
        fix "A cone of half angle θ fills 2π (1 − cos θ): the pdf is one over that.";
    BACK_UNLIT = "back-unlit":
        "surfaces that are seen from their back get no direct light",
        at "direct light, where the cosine at the surface is clamped",
        fix "A diffuse surface has two sides: take |cos θ| where wi and wo lie on the same side.";
    MIS_SURFACE_IN_FULL = "mis-surface-samples-in-full":
        "light that BSDF sampling meets counts in full beside weighted light samples",
        at "direct light by multiple importance sampling, where a direction of the BSDF meets a light",
        fix "Weight it by the pdfs of both techniques: the MIS weights of one direction add up to 1.";
    MIS_LIGHT_IN_FULL = "mis-light-samples-in-full":
        "light samples count in full beside weighted BSDF samples",
        at "direct light by multiple importance sampling, where a light is sampled",
        fix "Weight them by the pdfs of both techniques: the MIS weights of one direction add up to 1.";
    MIS_HEURISTICS_DIFFER = "mis-heuristics-differ":
        "light samples and BSDF samples are weighted by different heuristics",
        at "direct light by multiple importance sampling, where weights are computed",
        fix "Use one heuristic for both: the MIS weights of one direction add up to 1.";
    T_MAX_NOT_RESET = "t-max-not-reset":
        "secondary rays do not reset t_max",
        at "where a secondary ray is spawned at a hit",
        fix "Give every new ray a range of its own: t_max = ∞.";
    HEMISPHERE_IN_WORLD = "hemisphere-in-world":
        "hemisphere samples are used in world space without the local-to-world transform",
        at "hemisphere sampling, where a local direction becomes a ray",
        fix "Transform the local direction to world space before tracing it.";
    FADES_WITH_DISTANCE = "point-light-fades-with-distance":
        "a point light falls off with the distance, not with its square",
        at "sampling the point light",
        fix "Incident radiance is intensity / distance².";
}
