//! Pictures as a whole: film, encoding, alignment.

use super::Cause;

/// See its headline.
pub static NOT_DIVIDED: Cause = Cause {
    name: "pixel-not-divided-by-samples",
    headline: "the sum over a pixel's samples is not divided by their number",
    look_at: "the film, where the samples of a pixel become its value",
    remedy: "Divide the sum of radiance by the number of samples, once.",
};

/// See its headline.
pub static DIVIDED_TWICE: Cause = Cause {
    name: "pixel-divided-twice",
    headline: "the sum over a pixel's samples is divided by their number twice",
    look_at: "the film, where the samples of a pixel become its value",
    remedy: "Weight each sample with 1/n or divide the sum by n, not both.",
};

/// See its headline.
pub static DIVIDED_BY_ONE_MORE: Cause = Cause {
    name: "pixel-divided-by-one-too-many",
    headline: "a pixel's sum is divided by one sample more than was added",
    look_at: "the loop over the samples of a pixel, and its counter after the last one",
    remedy: "Count a sample where it is added; a loop's counter may be one off when it ends.",
};

/// See its headline.
pub static ONE_SAMPLE_TOO_MANY: Cause = Cause {
    name: "pixel-adds-one-too-many",
    headline: "one sample more is added to a pixel than its sum is divided by",
    look_at: "the loop over the samples of a pixel: its first and its last turn",
    remedy: "Take exactly as many samples as the sum is divided by.",
};

/// See its headline.
pub static CLAMPED: Cause = Cause {
    name: "film-clamped",
    headline: "radiance is clamped to 1 before it is stored",
    look_at: "the film, where radiance is stored",
    remedy: "Store radiance as it is; clamp only when an 8-bit picture is written.",
};

/// See its headline.
pub static SAMPLES_CLAMPED: Cause = Cause {
    name: "samples-clamped",
    headline: "bright samples are cut off before they are averaged: energy is lost with the fireflies",
    look_at: "where the radiance of one path is added to its pixel",
    remedy: "Add every sample as it is; more samples, not a limit, make fireflies fade.",
};

/// See its headline.
pub static DISPLACED: Cause = Cause {
    name: "picture-displaced",
    headline: "the whole picture lies beside its place",
    look_at: "the way from a pixel's column and row to a film point",
    remedy: "Sample (u, v) of the pixel in column c and row r is ((c + u)/width, 1 − (r + v)/height).",
};

/// See its headline.
pub static MAGNIFIED: Cause = Cause {
    name: "picture-magnified",
    headline: "the whole picture is larger or smaller than it should be",
    look_at: "the field of view, and the division by the film's size",
    remedy: "The film spans 2 tan(fov/2): divide by width and height, not by one less.",
};

/// See its headline.
pub static FACTOR: Cause = Cause {
    name: "picture-factor",
    headline: "the whole picture is too bright or too dark by one factor",
    look_at: "the division by the number of samples, and the strength of the lights",
    remedy: "Divide the sum of all samples by how many there were, once.",
};

/// See its headline.
pub static STRIPE: Cause = Cause {
    name: "picture-stripe",
    headline: "some columns or rows side by side are brighter or darker than all others",
    look_at: "what those columns or rows have of their own: a tile, a thread, lanes of a vector, the last of a loop",
    remedy: "Give every column and row the same samples, each with numbers of its own, and divide by their number.",
};

/// See its headline.
pub static GAMMA_TWICE: Cause = Cause {
    name: "gamma-in-film",
    headline: "the film holds gamma-encoded values where linear radiance belongs",
    look_at: "the film, where radiance is stored",
    remedy: "Write linear radiance; encode only when an 8-bit picture is written.",
};

/// See its headline.
pub static ENCODED_OTHERWISE: Cause = Cause {
    name: "encoded-otherwise",
    headline: "the 8-bit picture is encoded with another curve than is declared",
    look_at: "where radiance becomes codes: the exponent, or the sRGB curve",
    remedy: "Encode with the curve that is declared, or declare the one that is used.",
};

/// See its headline.
pub static ROUNDED_OTHERWISE: Cause = Cause {
    name: "codes-rounded-otherwise",
    headline: "the codes of the 8-bit picture lie half a code off: cut off where they should be rounded",
    look_at: "the conversion of a number to a byte",
    remedy: "Round to the nearest code: floor(255 v + 0.5). A cast alone cuts off.",
};

/// See its headline.
pub static CHANNELS_SWAPPED: Cause = Cause {
    name: "channels-swapped",
    headline: "red and blue are swapped",
    look_at: "the film, where the three channels of a pixel are stored",
    remedy: "A pixel is red, green, blue, in this order.",
};

/// See its headline.
pub static BORDER_LEFT_OUT: Cause = Cause {
    name: "picture-border-left-out",
    headline: "the first or the last row and column of the picture are not rendered",
    look_at: "the loops over rows and columns: where they begin and end",
    remedy: "Columns run from 0 to width − 1 and rows from 0 to height − 1, all included.",
};

/// See its headline.
pub static PARTIAL_TILES_LEFT_OUT: Cause = Cause {
    name: "partial-tiles-left-out",
    headline: "what is left over when the picture is cut into tiles is not rendered",
    look_at: "the number of tiles, and the size of the last one in each direction",
    remedy: "Round the number of tiles up, and cut the last tile off at the picture's border.",
};

/// See its headline.
pub static COUNTS_OFF_BY_ONE: Cause = Cause {
    name: "sample-counts-off-by-one",
    headline: "the count of samples is one off",
    look_at: "the loop over the samples of a pixel, and its counter after the last one",
    remedy: "Count a sample where it is added to the pixel.",
};

/// See its headline.
pub static UPSIDE_DOWN: Cause = Cause {
    name: "picture-upside-down",
    headline: "the picture is upside down",
    look_at: "the step from the row of a pixel to the film's y, or the order of rows in the film",
    remedy: "Row 0 is the top of the picture, and the film's y grows upwards: y = 1 − (row + v)/height.",
};

/// See its headline.
pub static MIRRORED: Cause = Cause {
    name: "picture-mirrored",
    headline: "left and right of the picture are swapped",
    look_at: "the step from the column of a pixel to the film's x, or the camera's right axis",
    remedy: "Column 0 is on the left: x = (column + u)/width, and right is up × backward.",
};

/// See its headline.
pub static TURNED: Cause = Cause {
    name: "picture-turned-round",
    headline: "the picture is turned by 180°",
    look_at: "the signs of the camera's right and up axes",
    remedy: "The camera looks along −z of its frame; with +z both axes come out reversed.",
};

/// See its headline.
pub static TRANSPOSED: Cause = Cause {
    name: "picture-transposed",
    headline: "rows and columns of the picture are swapped",
    look_at: "the index of a pixel in the film, or x and y in the step from pixel to film point",
    remedy: "The pixel of column x and row y stands at y · width + x, and x goes with the width.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &NOT_DIVIDED,
    &DIVIDED_TWICE,
    &DIVIDED_BY_ONE_MORE,
    &ONE_SAMPLE_TOO_MANY,
    &CLAMPED,
    &SAMPLES_CLAMPED,
    &DISPLACED,
    &MAGNIFIED,
    &FACTOR,
    &STRIPE,
    &GAMMA_TWICE,
    &ENCODED_OTHERWISE,
    &ROUNDED_OTHERWISE,
    &CHANNELS_SWAPPED,
    &BORDER_LEFT_OUT,
    &PARTIAL_TILES_LEFT_OUT,
    &COUNTS_OFF_BY_ONE,
    &UPSIDE_DOWN,
    &MIRRORED,
    &TURNED,
    &TRANSPOSED,
];
