//! Part 5: adaptive sampling, and the variance that a renderer reports.

use super::{Cause, causes};

const LOOK_AT: &str = "where the variance of a pixel is written beside its mean";
const REMEDY: &str =
    "The variance of the mean of n samples is Σ(x − mean)² / (n − 1) / n, channel by channel.";

causes! {
    DIVIDED_BY_CAP = "divided-by-cap":
        "the sum is divided by the most samples allowed, not by those taken",
        at "adaptive sampling, where the mean of the pixel is written",
        fix "Divide by the number of samples that were really taken.";
    POPULATION_VARIANCE = "population-variance":
        "the variance is divided by n, not n − 1",
        at "adaptive sampling, where the interval's half width is computed",
        fix "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    SIGMA_OVER_N = "sigma-over-n":
        "σ is divided by n, not by its root",
        at "adaptive sampling, where the interval's half width is computed",
        fix "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    WITHOUT_1_96 = "without-1-96":
        "the factor 1.96 is missing",
        at "adaptive sampling, where the interval's half width is computed",
        fix "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    VARIANCE_FOR_SIGMA = "variance-for-sigma":
        "the variance stands where σ should",
        at "adaptive sampling, where the interval's half width is computed",
        fix "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    TOLERANCE_ABSOLUTE = "tolerance-absolute":
        "the tolerance is not multiplied by the mean",
        at "adaptive sampling, where the half width is compared",
        fix "1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    NEVER_STOPS = "never-stops":
        "it never stops before the cap",
        at "adaptive sampling, the loop over samples",
        fix "Stop once the half width is small enough, at the end of a batch.";
    LOOKS_AFTER_EVERY_SAMPLE = "looks-after-every-sample":
        "it looks after every sample, not after every batch",
        at "adaptive sampling, the loop over samples",
        fix "Look only when the number of samples is a multiple of the batch.";
    DIVIDED_BY_ONE_LESS = "divided-by-one-less":
        "the sum is divided by one sample less than were taken",
        at "adaptive sampling, where the mean of the pixel is written",
        fix "Divide by the number of samples that were really taken.";
    COUNT_ONE_SHORT = "count-one-short":
        "n is one short of the samples in the sums",
        at "adaptive sampling, where the variance is computed",
        fix "Count a sample when it is added to the sums.";
    BATCH_IGNORED = "batch-ignored":
        "the rule looks after 32 samples, whatever batch is asked for",
        at "adaptive sampling, the loop over samples",
        fix "Look whenever the number of samples is a multiple of the batch that is asked for.";
    REST_OF_BATCH_DROPPED = "rest-of-batch-dropped":
        "samples beyond the last whole batch are not taken",
        at "adaptive sampling, the loop over samples",
        fix "Go on to the cap, also where it is no multiple of the batch.";
    COUNTS_ARE_CAP = "counts-are-cap":
        "the picture of counts says the most that was allowed, not what was taken",
        at "the buffer of sample counts",
        fix "Write the number of samples that were really taken.";
    LAST_BATCH_NOT_COUNTED = "last-batch-not-counted":
        "the picture of counts lacks the last batch",
        at "the buffer of sample counts",
        fix "Write the number of samples that were really taken.";
    VARIANCE_BELOW_ZERO = "variance-below-zero":
        "the variance of equal samples rounds to less than 0, and its root is no number",
        at "where σ² is made of the two sums",
        fix "Keep the sums in double precision, and take max(σ², 0).";
    ADAPTIVE_ALWAYS = "adaptive-always":
        "pixels stop early though adaptive sampling is off",
        at "the choice between adaptive and fixed sampling",
        fix "Without adaptive sampling every pixel takes all its samples.";
    VARIANCE_OF_SAMPLE = "variance-of-a-sample":
        "the variance of one sample is reported, not that of the pixel's mean",
        at LOOK_AT,
        fix REMEDY;
    DIVIDED_TWICE = "variance-divided-twice":
        "the reported variance is divided by the number of samples once too often",
        at LOOK_AT,
        fix REMEDY;
    DEVIATION_REPORTED = "deviation-for-variance":
        "the standard deviation is reported in place of the variance",
        at LOOK_AT,
        fix REMEDY;
    SQUARES_REPORTED = "squares-not-divided":
        "the sum of squared deviations is reported undivided",
        at LOOK_AT,
        fix REMEDY;
    SQUARES_CANCEL = "squares-cancel":
        "the variance is the difference of two nearly equal sums in single precision, and drowns in their rounding",
        at "the sums of samples and of their squares that a pixel keeps",
        fix "Keep the sums in double precision, or the running mean and deviations of Welford (1962).";
}
