//! Part 3: sampling directions and their densities.

use super::Cause;

/// See its headline.
pub static DENSITY_OF_OTHER_SAMPLER: Cause = Cause {
    name: "density-of-other-sampler",
    headline: "directions are drawn by one sampler and their density is that of another",
    look_at: "the sampler, where the pdf is written",
    remedy: "Cosine-distributed directions have density cos θ/π, uniform ones 1/2π.",
};

/// See its headline.
pub static UNIFORM_DENSITY_FOR_COSINE: Cause = Cause {
    name: "uniform-density-for-cosine",
    headline: "directions are cosine-distributed, but their density is that of uniform ones",
    look_at: "the sampler, where the pdf is written",
    remedy: "Cosine-distributed directions have density cos θ/π.",
};

/// See its headline.
pub static COSINE_DENSITY_FOR_UNIFORM: Cause = Cause {
    name: "cosine-density-for-uniform",
    headline: "directions are uniform, but their density is that of cosine-distributed ones",
    look_at: "the sampler, where the pdf is written",
    remedy: "Uniform directions of the hemisphere have density 1/2π.",
};

/// See its headline.
pub static DENSITY_WITHOUT_PI: Cause = Cause {
    name: "density-without-pi",
    headline: "1/π is missing in the density",
    look_at: "the sampler, where the pdf is written",
    remedy: "The cosine-weighted density is cos θ/π, the uniform one 1/2π.",
};

/// See its headline.
pub static DENSITY_HALVED: Cause = Cause {
    name: "density-halved",
    headline: "the density is half of what it should be: that of the whole sphere, or over 2π",
    look_at: "the sampler, where the pdf is written",
    remedy: "Cosine-distributed directions have density cos θ/π, uniform ones of the hemisphere 1/2π.",
};

/// See its headline.
pub static DENSITY_DOUBLED: Cause = Cause {
    name: "density-doubled",
    headline: "the density is twice what it should be: 1/π stands where 1/2π belongs",
    look_at: "the sampler, where the pdf is written",
    remedy: "Uniform directions of the hemisphere have density 1/2π.",
};

/// See its headline.
pub static UNIFORM_FOR_COSINE: Cause = Cause {
    name: "uniform-for-cosine",
    headline: "directions are uniform over the hemisphere where cosine-distributed ones belong",
    look_at: "the sampler, where two random numbers become a direction",
    remedy: "cos θ = √u for cosine-distributed directions, u for uniform ones.",
};

/// See its headline.
pub static COSINE_FOR_UNIFORM: Cause = Cause {
    name: "cosine-for-uniform",
    headline: "directions are cosine-distributed where uniform ones belong",
    look_at: "the sampler, where two random numbers become a direction",
    remedy: "cos θ = u for uniform directions, √u for cosine-distributed ones.",
};

/// See its headline.
pub static THETA_UNIFORM: Cause = Cause {
    name: "theta-uniform",
    headline: "the angle θ is drawn uniformly: directions are too dense at the pole",
    look_at: "the sampler, where two random numbers become a direction",
    remedy: "Draw cos θ, not θ: equal steps of height cut the sphere into equal areas.",
};

/// See its headline.
pub static HALF_OF_AZIMUTHS: Cause = Cause {
    name: "half-of-azimuths",
    headline: "a part of the azimuths is never drawn",
    look_at: "the sampler, where two random numbers become a direction",
    remedy: "φ = 2π u runs all the way round.",
};

/// See its headline.
pub static ONE_NUMBER_TWICE: Cause = Cause {
    name: "one-number-twice",
    headline: "both coordinates of a direction come from the same random number",
    look_at: "the sampler, where two random numbers become a direction",
    remedy: "Draw a number of its own for each coordinate.",
};

/// See its headline.
pub static DENSITY_BELOW_HORIZON: Cause = Cause {
    name: "density-below-horizon",
    headline: "the density is not 0 below the horizon, where nothing is drawn",
    look_at: "the sampler, where the pdf is written",
    remedy: "Answer 0 for directions with cos θ ≤ 0.",
};

/// See its headline.
pub static DENSITY_INVERTED: Cause = Cause {
    name: "density-inverted",
    headline: "the density is upside down: 2π or π stands where its reciprocal belongs",
    look_at: "the sampler, where the pdf is written",
    remedy: "A uniform density is one over the area it covers: 1/2π for the hemisphere.",
};

/// See its headline.
pub static SAMPLES_ALL_ALIKE: Cause = Cause {
    name: "samples-all-alike",
    headline: "all samples of one estimate are the same sample: more of them do not help",
    look_at: "where the random numbers of a sample are drawn",
    remedy: "Draw new random numbers for each sample.",
};

/// See its headline.
pub static AROUND_Y: Cause = Cause {
    name: "hemisphere-around-y",
    headline: "directions are drawn around +y where the normal is +z",
    look_at: "the sampler, where height and azimuth become x, y and z",
    remedy: "In the local frame the normal is +z: z is the height, x and y the azimuth.",
};

/// See its headline.
pub static AROUND_X: Cause = Cause {
    name: "hemisphere-around-x",
    headline: "directions are drawn around +x where the normal is +z",
    look_at: "the sampler, where height and azimuth become x, y and z",
    remedy: "In the local frame the normal is +z: z is the height, x and y the azimuth.",
};

/// See its headline.
pub static BELOW_SURFACE: Cause = Cause {
    name: "samples-below-surface",
    headline: "directions are drawn into the surface: z is negative where it should be positive",
    look_at: "the sampler, where height and azimuth become x, y and z",
    remedy: "Directions point away from the surface: z = cos θ > 0.",
};

/// See its headline.
pub static LOBE_AROUND_VIEWER: Cause = Cause {
    name: "lobe-around-viewer",
    headline: "a lobe leans towards the viewer where it should lean to the other side of the normal",
    look_at: "the step from a half vector or a mirror direction to wi",
    remedy: "Both directions point away from the surface: wi = 2 (wo·h) h − wo.",
};

/// See its headline.
pub static TANGENTS_SWAPPED: Cause = Cause {
    name: "tangents-swapped",
    headline: "the two tangents of the local frame are swapped",
    look_at: "the sampler, where height and azimuth become x, y and z",
    remedy: "x = sin θ cos φ and y = sin θ sin φ, in the frame in which wo is given.",
};

/// See its headline.
pub static ENDS_OF_RANGE: Cause = Cause {
    name: "ends-of-range-forgotten",
    headline: "random numbers of 0, or just below 1, give samples without density or none at all",
    look_at: "square roots, logarithms and divisions of a random number",
    remedy: "Numbers lie in [0, 1): take 1 − u, which is never 0, and hold roots at 0 or above.",
};

/// See its headline.
pub static OWN_NUMBERS: Cause = Cause {
    name: "own-random-numbers",
    headline: "samples do not follow from the random numbers that are handed over",
    look_at: "the sampler, where it takes its random numbers",
    remedy: "Use the caller's numbers, or do not declare that you do.",
};

/// See its headline.
pub static NUMBERS_OF_ANOTHER: Cause = Cause {
    name: "numbers-of-another-sample",
    headline: "a sample is made of the random numbers of another one",
    look_at: "the index into the random numbers of a batch",
    remedy: "Element i of the answers belongs to element i of the numbers.",
};

/// See its headline.
pub static NUMBER_DRAWN_AGAIN: Cause = Cause {
    name: "random-number-drawn-again",
    headline: "a sample uses a random number that the sample before it has used",
    look_at: "where the generator is seeded or copied: its state must move on",
    remedy: "Draw every number from one generator that is kept, never from a copy or a fresh seed.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &DENSITY_OF_OTHER_SAMPLER,
    &UNIFORM_DENSITY_FOR_COSINE,
    &COSINE_DENSITY_FOR_UNIFORM,
    &DENSITY_WITHOUT_PI,
    &DENSITY_HALVED,
    &DENSITY_DOUBLED,
    &UNIFORM_FOR_COSINE,
    &COSINE_FOR_UNIFORM,
    &THETA_UNIFORM,
    &HALF_OF_AZIMUTHS,
    &ONE_NUMBER_TWICE,
    &DENSITY_BELOW_HORIZON,
    &DENSITY_INVERTED,
    &SAMPLES_ALL_ALIKE,
    &AROUND_Y,
    &AROUND_X,
    &BELOW_SURFACE,
    &LOBE_AROUND_VIEWER,
    &TANGENTS_SWAPPED,
    &ENDS_OF_RANGE,
    &OWN_NUMBERS,
    &NUMBERS_OF_ANOTHER,
    &NUMBER_DRAWN_AGAIN,
];
