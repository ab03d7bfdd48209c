//! Part 5: adaptive sampling, and the variance that a renderer reports.

use super::{Cause, causes};

const LOOK_AT: &str = "where the variance of a pixel is written beside its mean";
const REMEDY: &str =
    "The variance of the mean of n samples is Σ(x − mean)² / (n − 1) / n, channel by channel.";

causes! {
    DIVIDED_BY_CAP = "divided-by-cap":
        "the pixel's sum is divided by the maximum number of samples, not by those taken",
        at "adaptive sampling, where the mean of the pixel is written",
        fix "Divide by the number of samples actually taken.";
    POPULATION_VARIANCE = "population-variance":
        "the sample variance is divided by n, not n − 1 (Bessel's correction)",
        at "adaptive sampling, where the half width of the confidence interval is computed",
        fix "The confidence interval's half width is 1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    SIGMA_OVER_N = "sigma-over-n":
        "the half width uses σ/n, not σ/√n",
        at "adaptive sampling, where the half width of the confidence interval is computed",
        fix "The confidence interval's half width is 1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    WITHOUT_1_96 = "without-1-96":
        "the half width lacks the factor 1.96 of a 95 % confidence interval",
        at "adaptive sampling, where the half width of the confidence interval is computed",
        fix "The confidence interval's half width is 1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    VARIANCE_FOR_SIGMA = "variance-for-sigma":
        "the half width uses the variance, not the standard deviation",
        at "adaptive sampling, where the half width of the confidence interval is computed",
        fix "The confidence interval's half width is 1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    HALF_WIDTH_SQUARED = "half-width-squared":
        "the squared half width of the confidence interval is compared with the tolerance",
        at "adaptive sampling, where the half width is compared with the tolerance",
        fix "The confidence interval's half width is 1.96 σ/√n ≤ tolerance · μ: take the root, or square both sides.";
    TOLERANCE_ABSOLUTE = "tolerance-absolute":
        "the tolerance is absolute: it is not multiplied by the mean",
        at "adaptive sampling, where the half width is compared with the tolerance",
        fix "The confidence interval's half width is 1.96 σ/√n ≤ tolerance · μ, with σ² over n − 1.";
    NEVER_STOPS = "never-stops":
        "adaptive sampling never stops before the maximum number of samples",
        at "adaptive sampling, the loop over samples",
        fix "Stop at the end of a batch once the confidence interval is narrow enough.";
    LOOKS_AFTER_EVERY_SAMPLE = "looks-after-every-sample":
        "convergence is tested after every sample, not after every batch",
        at "adaptive sampling, the loop over samples",
        fix "Test only when the number of samples is a multiple of the batch size.";
    DIVIDED_BY_ONE_LESS = "divided-by-one-less":
        "the pixel's sum is divided by one sample less than was taken",
        at "adaptive sampling, where the mean of the pixel is written",
        fix "Divide by the number of samples actually taken.";
    COUNT_ONE_SHORT = "count-one-short":
        "the sample count n is one less than the number of samples in the sums",
        at "adaptive sampling, where the variance is computed",
        fix "Count a sample when it is added to the sums.";
    BATCH_IGNORED = "batch-ignored":
        "convergence is tested every 32 samples, whatever batch size is requested",
        at "adaptive sampling, the loop over samples",
        fix "Test whenever the number of samples is a multiple of the requested batch size.";
    REST_OF_BATCH_DROPPED = "rest-of-batch-dropped":
        "samples beyond the last full batch are not taken",
        at "adaptive sampling, the loop over samples",
        fix "Continue to the maximum number of samples, even if it is no multiple of the batch size.";
    COUNTS_ARE_CAP = "counts-are-cap":
        "the sample counts hold the maximum number of samples, not the number taken",
        at "the buffer of sample counts",
        fix "Write the number of samples actually taken.";
    BATCHES_REPEAT = "batches-repeat":
        "every batch draws the samples of the first one again",
        at "adaptive sampling, where a sample's random numbers are seeded",
        fix "Go on with the pixel's random numbers from batch to batch.";
    LAST_BATCH_NOT_COUNTED = "last-batch-not-counted":
        "the sample counts lack the last batch",
        at "the buffer of sample counts",
        fix "Write the number of samples actually taken.";
    VARIANCE_BELOW_ZERO = "variance-below-zero":
        "the variance of equal samples rounds to a negative number, and its square root is NaN",
        at "where σ² is computed from the two sums",
        fix "Keep the sums in double precision, and clamp: max(σ², 0).";
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
        "the standard deviation is reported, not the variance",
        at LOOK_AT,
        fix REMEDY;
    SQUARES_REPORTED = "squares-not-divided":
        "the sum of squared deviations is reported undivided",
        at LOOK_AT,
        fix REMEDY;
    SQUARES_CANCEL = "squares-cancel":
        "catastrophic cancellation: the variance is the difference of two nearly equal single-precision sums",
        at "the sums of samples and of their squares that a pixel keeps",
        fix "Keep the sums in double precision, or use Welford's running mean and variance (1962).";
    LOOP_ENDLESS = "adaptive-loop-endless":
        "the loop of adaptive sampling never ends: it does not stop at the maximum number of samples",
        at "adaptive sampling, the condition of the loop over samples",
        fix "End at the maximum number of samples, whatever the confidence interval is: NaN fails every comparison.";
}
