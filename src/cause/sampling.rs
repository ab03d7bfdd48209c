//! Part 3: sampling directions, and their pdfs.

use super::{Cause, causes};

causes! {
    PDF_OF_OTHER_SAMPLER = "pdf-of-other-sampler":
        "directions come from one sampler and the pdf from another",
        at "the sampler, where the pdf is computed",
        fix "The pdf is cos θ/π for cosine-weighted directions, 1/(2π) for uniform ones.";
    UNIFORM_PDF_FOR_COSINE = "uniform-pdf-for-cosine":
        "directions are cosine-weighted, but the pdf is that of uniform ones",
        at "the sampler, where the pdf is computed",
        fix "Cosine-weighted directions have pdf cos θ/π.";
    COSINE_PDF_FOR_UNIFORM = "cosine-pdf-for-uniform":
        "directions are uniform, but the pdf is that of cosine-weighted ones",
        at "the sampler, where the pdf is computed",
        fix "Uniform directions of the hemisphere have pdf 1/(2π).";
    PDF_WITHOUT_PI = "pdf-without-pi":
        "the pdf lacks the factor 1/π",
        at "the sampler, where the pdf is computed",
        fix "The cosine-weighted pdf is cos θ/π, the uniform one 1/(2π).";
    PDF_HALVED = "pdf-halved":
        "the pdf is half of what it should be: 1/(4π), of the whole sphere, or cos θ/(2π)",
        at "the sampler, where the pdf is computed",
        fix "The pdf is cos θ/π for cosine-weighted directions, 1/(2π) for uniform ones of the hemisphere.";
    PDF_DOUBLED = "pdf-doubled":
        "the pdf is twice what it should be: 1/π instead of 1/(2π)",
        at "the sampler, where the pdf is computed",
        fix "Uniform directions of the hemisphere have pdf 1/(2π).";
    UNIFORM_FOR_COSINE = "uniform-for-cosine":
        "directions are uniform over the hemisphere, not cosine-weighted",
        at "the sampler, where two random numbers become a direction",
        fix "cos θ = √u for cosine-weighted directions, u for uniform ones.";
    COSINE_FOR_UNIFORM = "cosine-for-uniform":
        "directions are cosine-weighted, not uniform over the hemisphere",
        at "the sampler, where two random numbers become a direction",
        fix "cos θ = u for uniform directions, √u for cosine-weighted ones.";
    THETA_UNIFORM = "theta-uniform":
        "the polar angle θ is drawn uniformly, so directions cluster at the pole",
        at "the sampler, where two random numbers become a direction",
        fix "Draw cos θ, not θ: the Jacobian of spherical coordinates is sin θ.";
    HALF_OF_AZIMUTHS = "half-of-azimuths":
        "some azimuths are never sampled",
        at "the sampler, where two random numbers become a direction",
        fix "φ = 2π u covers the full circle.";
    ONE_NUMBER_TWICE = "one-number-twice":
        "both coordinates of a direction use the same random number",
        at "the sampler, where two random numbers become a direction",
        fix "Draw one random number per coordinate.";
    PDF_BELOW_HORIZON = "pdf-below-horizon":
        "the pdf is not 0 below the horizon, where nothing is sampled",
        at "the sampler, where the pdf is computed",
        fix "Return 0 for directions with cos θ ≤ 0.";
    PDF_INVERTED = "pdf-inverted":
        "the reciprocal of the pdf is returned: 2π or π",
        at "the sampler, where the pdf is computed",
        fix "A uniform pdf is one over the solid angle it covers: 1/(2π) for the hemisphere.";
    SAMPLES_ALL_ALIKE = "samples-all-alike":
        "all samples of an estimate are the same sample: more of them do not reduce variance",
        at "where a sample draws its random numbers",
        fix "Draw new random numbers for each sample.";
    AROUND_Y = "hemisphere-around-y":
        "directions are sampled about +y; the local normal is +z",
        at "the sampler, where polar coordinates become x, y and z",
        fix "In the local shading frame the normal is +z: z = cos θ.";
    AROUND_X = "hemisphere-around-x":
        "directions are sampled about +x; the local normal is +z",
        at "the sampler, where polar coordinates become x, y and z",
        fix "In the local shading frame the normal is +z: z = cos θ.";
    BELOW_SURFACE = "samples-below-surface":
        "directions are sampled below the surface: z < 0",
        at "the sampler, where polar coordinates become x, y and z",
        fix "Sampled directions point away from the surface: z = cos θ > 0.";
    LOBE_AROUND_VIEWER = "lobe-around-viewer":
        "the lobe is centred on wo, not on its reflection about the normal",
        at "the step from the half vector or mirror direction to wi",
        fix "Both directions point away from the surface: wi = 2 (wo·h) h − wo.";
    TANGENTS_SWAPPED = "tangents-swapped":
        "the two tangents of the local shading frame are swapped",
        at "the sampler, where polar coordinates become x, y and z",
        fix "x = sin θ cos φ and y = sin θ sin φ, in the frame in which wo is given.";
    ENDS_OF_RANGE = "ends-of-range-forgotten":
        "random numbers of 0, or just below 1, give samples of zero pdf or none at all",
        at "square roots, logarithms and divisions of a random number",
        fix "Random numbers lie in [0, 1): use 1 − u, which is never 0, and clamp square roots at 0.";
    OWN_NUMBERS = "own-random-numbers":
        "samples do not depend only on the random numbers passed in",
        at "the sampler, where it takes its random numbers",
        fix "Use the caller's random numbers, or do not declare that you do.";
    NUMBERS_OF_ANOTHER = "numbers-of-another-sample":
        "a sample uses the random numbers of another sample",
        at "the index into the random numbers of a batch",
        fix "Element i of the answers uses element i of the random numbers.";
    NUMBER_DRAWN_AGAIN = "random-number-drawn-again":
        "a sample reuses a random number of the sample before it",
        at "where the random generator is seeded or copied",
        fix "Draw every number from one generator whose state advances, never from a copy or a fresh seed.";
}
