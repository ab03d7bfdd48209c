//! Part 5: adaptive sampling.

use super::Cause;

/// See its headline.
pub static DIVIDED_BY_CAP: Cause = Cause {
    name: "divided-by-cap",
    headline: "the sum is divided by the most samples allowed, not by those taken",
    look_at: "adaptive sampling, where the mean of the pixel is written",
    remedy: "Divide by the number of samples that were really taken.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[&DIVIDED_BY_CAP];
