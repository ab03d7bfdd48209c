//! Part 3: sampling directions and their densities.

use super::{Cause, causes};

causes! {
    DENSITY_OF_OTHER_SAMPLER = "density-of-other-sampler":
        "directions are drawn by one sampler and their density is that of another",
        at "the sampler, where the pdf is written",
        fix "Cosine-distributed directions have density cos θ/π, uniform ones 1/2π.";
    UNIFORM_DENSITY_FOR_COSINE = "uniform-density-for-cosine":
        "directions are cosine-distributed, but their density is that of uniform ones",
        at "the sampler, where the pdf is written",
        fix "Cosine-distributed directions have density cos θ/π.";
    COSINE_DENSITY_FOR_UNIFORM = "cosine-density-for-uniform":
        "directions are uniform, but their density is that of cosine-distributed ones",
        at "the sampler, where the pdf is written",
        fix "Uniform directions of the hemisphere have density 1/2π.";
    DENSITY_WITHOUT_PI = "density-without-pi":
        "1/π is missing in the density",
        at "the sampler, where the pdf is written",
        fix "The cosine-weighted density is cos θ/π, the uniform one 1/2π.";
    DENSITY_HALVED = "density-halved":
        "the density is half of what it should be: that of the whole sphere, or over 2π",
        at "the sampler, where the pdf is written",
        fix "Cosine-distributed directions have density cos θ/π, uniform ones of the hemisphere 1/2π.";
    DENSITY_DOUBLED = "density-doubled":
        "the density is twice what it should be: 1/π stands where 1/2π belongs",
        at "the sampler, where the pdf is written",
        fix "Uniform directions of the hemisphere have density 1/2π.";
    UNIFORM_FOR_COSINE = "uniform-for-cosine":
        "directions are uniform over the hemisphere where cosine-distributed ones belong",
        at "the sampler, where two random numbers become a direction",
        fix "cos θ = √u for cosine-distributed directions, u for uniform ones.";
    COSINE_FOR_UNIFORM = "cosine-for-uniform":
        "directions are cosine-distributed where uniform ones belong",
        at "the sampler, where two random numbers become a direction",
        fix "cos θ = u for uniform directions, √u for cosine-distributed ones.";
    THETA_UNIFORM = "theta-uniform":
        "the angle θ is drawn uniformly: directions are too dense at the pole",
        at "the sampler, where two random numbers become a direction",
        fix "Draw cos θ, not θ: equal steps of height cut the sphere into equal areas.";
    HALF_OF_AZIMUTHS = "half-of-azimuths":
        "a part of the azimuths is never drawn",
        at "the sampler, where two random numbers become a direction",
        fix "φ = 2π u runs all the way round.";
    ONE_NUMBER_TWICE = "one-number-twice":
        "both coordinates of a direction come from the same random number",
        at "the sampler, where two random numbers become a direction",
        fix "Draw a number of its own for each coordinate.";
    DENSITY_BELOW_HORIZON = "density-below-horizon":
        "the density is not 0 below the horizon, where nothing is drawn",
        at "the sampler, where the pdf is written",
        fix "Answer 0 for directions with cos θ ≤ 0.";
    DENSITY_INVERTED = "density-inverted":
        "the density is upside down: 2π or π stands where its reciprocal belongs",
        at "the sampler, where the pdf is written",
        fix "A uniform density is one over the area it covers: 1/2π for the hemisphere.";
    SAMPLES_ALL_ALIKE = "samples-all-alike":
        "all samples of one estimate are the same sample: more of them do not help",
        at "where the random numbers of a sample are drawn",
        fix "Draw new random numbers for each sample.";
    AROUND_Y = "hemisphere-around-y":
        "directions are drawn around +y where the normal is +z",
        at "the sampler, where height and azimuth become x, y and z",
        fix "In the local frame the normal is +z: z is the height, x and y the azimuth.";
    AROUND_X = "hemisphere-around-x":
        "directions are drawn around +x where the normal is +z",
        at "the sampler, where height and azimuth become x, y and z",
        fix "In the local frame the normal is +z: z is the height, x and y the azimuth.";
    BELOW_SURFACE = "samples-below-surface":
        "directions are drawn into the surface: z is negative where it should be positive",
        at "the sampler, where height and azimuth become x, y and z",
        fix "Directions point away from the surface: z = cos θ > 0.";
    LOBE_AROUND_VIEWER = "lobe-around-viewer":
        "a lobe leans towards the viewer where it should lean to the other side of the normal",
        at "the step from a half vector or a mirror direction to wi",
        fix "Both directions point away from the surface: wi = 2 (wo·h) h − wo.";
    TANGENTS_SWAPPED = "tangents-swapped":
        "the two tangents of the local frame are swapped",
        at "the sampler, where height and azimuth become x, y and z",
        fix "x = sin θ cos φ and y = sin θ sin φ, in the frame in which wo is given.";
    ENDS_OF_RANGE = "ends-of-range-forgotten":
        "random numbers of 0, or just below 1, give samples without density or none at all",
        at "square roots, logarithms and divisions of a random number",
        fix "Numbers lie in [0, 1): take 1 − u, which is never 0, and hold roots at 0 or above.";
    OWN_NUMBERS = "own-random-numbers":
        "samples do not follow from the random numbers that are handed over",
        at "the sampler, where it takes its random numbers",
        fix "Use the caller's numbers, or do not declare that you do.";
    NUMBERS_OF_ANOTHER = "numbers-of-another-sample":
        "a sample is made of the random numbers of another one",
        at "the index into the random numbers of a batch",
        fix "Element i of the answers belongs to element i of the numbers.";
    NUMBER_DRAWN_AGAIN = "random-number-drawn-again":
        "a sample uses a random number that the sample before it has used",
        at "where the generator is seeded or copied: its state must move on",
        fix "Draw every number from one generator that is kept, never from a copy or a fresh seed.";
}
