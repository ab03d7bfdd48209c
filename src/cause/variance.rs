//! Beyond the course: the variance that a renderer reports of its pixels.

use super::Cause;

const LOOK_AT: &str = "where the variance of a pixel is written beside its mean";
const REMEDY: &str =
    "The variance of the mean of n samples is Σ(x − mean)² / (n − 1) / n, channel by channel.";

/// See its headline.
pub static VARIANCE_OF_SAMPLE: Cause = Cause {
    name: "variance-of-a-sample",
    headline: "the variance of one sample is reported, not that of the pixel's mean",
    look_at: LOOK_AT,
    remedy: REMEDY,
};

/// See its headline.
pub static DIVIDED_TWICE: Cause = Cause {
    name: "variance-divided-twice",
    headline: "the reported variance is divided by the number of samples once too often",
    look_at: LOOK_AT,
    remedy: REMEDY,
};

/// See its headline.
pub static DEVIATION_REPORTED: Cause = Cause {
    name: "deviation-for-variance",
    headline: "the standard deviation is reported in place of the variance",
    look_at: LOOK_AT,
    remedy: REMEDY,
};

/// See its headline.
pub static SQUARES_REPORTED: Cause = Cause {
    name: "squares-not-divided",
    headline: "the sum of squared deviations is reported undivided",
    look_at: LOOK_AT,
    remedy: REMEDY,
};

/// See its headline.
pub static SQUARES_CANCEL: Cause = Cause {
    name: "squares-cancel",
    headline: "the variance is the difference of two nearly equal sums in single precision, and drowns in their rounding",
    look_at: "the sums of samples and of their squares that a pixel keeps",
    remedy: "Keep the sums in double precision, or the running mean and deviations of Welford (1962).",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] =
    &[&VARIANCE_OF_SAMPLE, &DIVIDED_TWICE, &DEVIATION_REPORTED, &SQUARES_REPORTED, &SQUARES_CANCEL];
