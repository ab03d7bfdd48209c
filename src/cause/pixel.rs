//! Part 1: where the samples of a pixel lie.

use super::Cause;

const LOOK_AT: &str =
    "the loop over a pixel's samples, where two random numbers become a film point";

/// See its headline.
pub static PIXEL_CENTRE: Cause = Cause {
    name: "samples-at-pixel-centre",
    headline: "every sample of a pixel goes through its centre",
    look_at: LOOK_AT,
    remedy: "Add two fresh numbers in [0, 1) to the pixel's column and row for each sample.",
};

/// See its headline.
pub static PIXEL_CORNER: Cause = Cause {
    name: "samples-at-pixel-corner",
    headline: "every sample of a pixel goes through its corner",
    look_at: LOOK_AT,
    remedy: "Add two fresh numbers in [0, 1) to the pixel's column and row for each sample.",
};

/// See its headline.
pub static HALF_A_PIXEL: Cause = Cause {
    name: "half-a-pixel-off",
    headline: "the samples of a pixel are shifted by half a pixel",
    look_at: LOOK_AT,
    remedy: "Column and row are a pixel's corner: random numbers in [0, 1) need no half added to them.",
};

/// See its headline.
pub static WHOLE_PIXEL: Cause = Cause {
    name: "one-pixel-off",
    headline: "the samples of a pixel lie in its neighbour",
    look_at: LOOK_AT,
    remedy: "Column 0 begins at x = 0, row 0 at y = 1: y = 1 − (row + v)/height.",
};

/// See its headline.
pub static JITTER_TOO_NARROW: Cause = Cause {
    name: "jitter-too-narrow",
    headline: "the samples of a pixel fill only a quarter of it",
    look_at: LOOK_AT,
    remedy: "The random offset runs over the whole pixel: 0 to 1 in both directions.",
};

/// See its headline.
pub static JITTER_TOO_WIDE: Cause = Cause {
    name: "jitter-too-wide",
    headline: "the samples of a pixel reach into its neighbours",
    look_at: LOOK_AT,
    remedy: "The random offset runs from 0 to 1, evenly; no filter is asked for.",
};

/// See its headline.
pub static ONE_NUMBER_TWICE: Cause = Cause {
    name: "pixel-jitter-is-one-number",
    headline: "one random number serves as both offsets, so that all samples lie on the pixel's diagonal",
    look_at: LOOK_AT,
    remedy: "Draw two numbers for each sample, one for x and one for y.",
};

/// See its headline.
pub static ONE_AXIS_ONLY: Cause = Cause {
    name: "pixel-jitter-on-one-axis",
    headline: "the samples of a pixel are spread along one axis only",
    look_at: LOOK_AT,
    remedy: "Draw two numbers for each sample, one for x and one for y.",
};

const STRATA: &str =
    "the loop over a pixel's samples, where the number of a sample becomes a cell of the grid";

/// See its headline.
pub static STRATA_IGNORED: Cause = Cause {
    name: "strata-ignored",
    headline: "the samples of a pixel are not stratified at all",
    look_at: STRATA,
    remedy: "Of k · k samples number i belongs to column i mod k and row i / k of the grid.",
};

/// See its headline.
pub static STRATA_UNEVEN: Cause = Cause {
    name: "strata-uneven",
    headline: "some cells of a pixel get several samples, and others none",
    look_at: STRATA,
    remedy: "Of k · k samples number i belongs to column i mod k and row i / k of the grid.",
};

/// See its headline.
pub static STRATUM_CENTRE: Cause = Cause {
    name: "stratum-centre",
    headline: "every sample lies in the middle of its cell",
    look_at: STRATA,
    remedy: "Within its cell a sample is a random point: (cell + number in [0, 1)) / k in each direction.",
};

/// See its headline.
pub static STRATUM_HALF: Cause = Cause {
    name: "stratum-half",
    headline: "samples fill only half the width of their cells",
    look_at: STRATA,
    remedy: "Within its cell a sample is a random point: (cell + number in [0, 1)) / k in each direction.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &PIXEL_CENTRE,
    &PIXEL_CORNER,
    &HALF_A_PIXEL,
    &WHOLE_PIXEL,
    &JITTER_TOO_NARROW,
    &JITTER_TOO_WIDE,
    &ONE_NUMBER_TWICE,
    &ONE_AXIS_ONLY,
    &STRATA_IGNORED,
    &STRATA_UNEVEN,
    &STRATUM_CENTRE,
    &STRATUM_HALF,
];
