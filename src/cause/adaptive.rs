//! Part 5: adaptive sampling.

use super::Cause;

/// See its headline.
pub static DIVIDED_BY_CAP: Cause = Cause {
    name: "divided-by-cap",
    headline: "the sum is divided by the most samples allowed, not by those taken",
    look_at: "adaptive sampling, where the mean of the pixel is written",
    remedy: "Divide by the number of samples that were really taken.",
};

/// See its headline.
pub static POPULATION_VARIANCE: Cause = Cause {
    name: "population-variance",
    headline: "the variance is divided by n, not n − 1",
    look_at: "adaptive sampling, where the interval's half width is computed",
    remedy: "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.",
};

/// See its headline.
pub static SIGMA_OVER_N: Cause = Cause {
    name: "sigma-over-n",
    headline: "σ is divided by n, not by its root",
    look_at: "adaptive sampling, where the interval's half width is computed",
    remedy: "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.",
};

/// See its headline.
pub static WITHOUT_1_96: Cause = Cause {
    name: "without-1-96",
    headline: "the factor 1.96 is missing",
    look_at: "adaptive sampling, where the interval's half width is computed",
    remedy: "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.",
};

/// See its headline.
pub static VARIANCE_FOR_SIGMA: Cause = Cause {
    name: "variance-for-sigma",
    headline: "the variance stands where σ should",
    look_at: "adaptive sampling, where the interval's half width is computed",
    remedy: "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.",
};

/// See its headline.
pub static TOLERANCE_ABSOLUTE: Cause = Cause {
    name: "tolerance-absolute",
    headline: "the tolerance is not multiplied by the mean",
    look_at: "adaptive sampling, where the half width is compared",
    remedy: "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.",
};

/// See its headline.
pub static NEVER_STOPS: Cause = Cause {
    name: "never-stops",
    headline: "it never stops before the cap",
    look_at: "adaptive sampling, the loop over samples",
    remedy: "Stop once the half width is small enough, at the end of a batch.",
};

/// See its headline.
pub static LOOKS_AFTER_EVERY_SAMPLE: Cause = Cause {
    name: "looks-after-every-sample",
    headline: "it looks after every sample, not after every batch",
    look_at: "adaptive sampling, the loop over samples",
    remedy: "Look only when the number of samples is a multiple of the batch.",
};

/// See its headline.
pub static DIVIDED_BY_ONE_LESS: Cause = Cause {
    name: "divided-by-one-less",
    headline: "the sum is divided by one sample less than were taken",
    look_at: "adaptive sampling, where the mean of the pixel is written",
    remedy: "Divide by the number of samples that were really taken.",
};

/// See its headline.
pub static COUNT_ONE_SHORT: Cause = Cause {
    name: "count-one-short",
    headline: "n is one short of the samples in the sums",
    look_at: "adaptive sampling, where the variance is computed",
    remedy: "Count a sample when it is added to the sums.",
};

/// See its headline.
pub static BATCH_IGNORED: Cause = Cause {
    name: "batch-ignored",
    headline: "the rule looks after 32 samples, whatever batch is asked for",
    look_at: "adaptive sampling, the loop over samples",
    remedy: "Look whenever the number of samples is a multiple of the batch that is asked for.",
};

/// See its headline.
pub static REST_OF_BATCH_DROPPED: Cause = Cause {
    name: "rest-of-batch-dropped",
    headline: "samples beyond the last whole batch are not taken",
    look_at: "adaptive sampling, the loop over samples",
    remedy: "Go on to the cap, also where it is no multiple of the batch.",
};

/// See its headline.
pub static COUNTS_ARE_CAP: Cause = Cause {
    name: "counts-are-cap",
    headline: "the picture of counts says the most that was allowed, not what was taken",
    look_at: "the buffer of sample counts",
    remedy: "Write the number of samples that were really taken.",
};

/// See its headline.
pub static LAST_BATCH_NOT_COUNTED: Cause = Cause {
    name: "last-batch-not-counted",
    headline: "the picture of counts lacks the last batch",
    look_at: "the buffer of sample counts",
    remedy: "Write the number of samples that were really taken.",
};

/// See its headline.
pub static VARIANCE_BELOW_ZERO: Cause = Cause {
    name: "variance-below-zero",
    headline: "the variance of equal samples rounds to less than 0, and its root is no number",
    look_at: "where σ² is made of the two sums",
    remedy: "Keep the sums in double precision, and take max(σ², 0).",
};

/// See its headline.
pub static ADAPTIVE_ALWAYS: Cause = Cause {
    name: "adaptive-always",
    headline: "pixels stop early though adaptive sampling is off",
    look_at: "the choice between adaptive and fixed sampling",
    remedy: "Without adaptive sampling every pixel takes all its samples.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &DIVIDED_BY_CAP,
    &POPULATION_VARIANCE,
    &SIGMA_OVER_N,
    &WITHOUT_1_96,
    &VARIANCE_FOR_SIGMA,
    &TOLERANCE_ABSOLUTE,
    &NEVER_STOPS,
    &LOOKS_AFTER_EVERY_SAMPLE,
    &DIVIDED_BY_ONE_LESS,
    &COUNT_ONE_SHORT,
    &BATCH_IGNORED,
    &REST_OF_BATCH_DROPPED,
    &COUNTS_ARE_CAP,
    &LAST_BATCH_NOT_COUNTED,
    &VARIANCE_BELOW_ZERO,
    &ADAPTIVE_ALWAYS,
];
