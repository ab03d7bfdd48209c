//! Images as a whole: film, encoding, alignment.

use super::{Cause, causes};

causes! {
    NOT_DIVIDED = "pixel-not-divided-by-samples":
        "the sum over a pixel's samples is not divided by their number",
        at "the film, where the samples of a pixel become its value",
        fix "Divide the sum of radiance by the number of samples, once.";
    DIVIDED_TWICE = "pixel-divided-twice":
        "the sum over a pixel's samples is divided by their number twice",
        at "the film, where the samples of a pixel become its value",
        fix "Weight each sample with 1/n or divide the sum by n, not both.";
    DIVIDED_BY_ONE_MORE = "pixel-divided-by-one-too-many":
        "a pixel's sum is divided by one sample more than was added",
        at "the loop over the samples of a pixel, and its counter after the last one",
        fix "Count a sample where it is added; a loop's counter may be one off when it ends.";
    ONE_SAMPLE_TOO_MANY = "pixel-adds-one-too-many":
        "one sample more is added to a pixel than its sum is divided by",
        at "the loop over the samples of a pixel: its first and its last turn",
        fix "Take exactly as many samples as the sum is divided by.";
    CLAMPED = "film-clamped":
        "radiance is clamped to 1 before it is stored",
        at "the film, where radiance is stored",
        fix "Store radiance as it is; clamp only when an 8-bit picture is written.";
    SAMPLES_CLAMPED = "samples-clamped":
        "bright samples are cut off before they are averaged: energy is lost with the fireflies",
        at "where the radiance of one path is added to its pixel",
        fix "Add every sample as it is; more samples, not a limit, make fireflies fade.";
    DISPLACED = "picture-displaced":
        "the whole picture lies beside its place",
        at "the way from a pixel's column and row to a film point",
        fix "Sample (u, v) of the pixel in column c and row r is ((c + u)/width, 1 − (r + v)/height).";
    MAGNIFIED = "picture-magnified":
        "the whole picture is larger or smaller than it should be",
        at "the field of view, and the division by the film's size",
        fix "The film spans 2 tan(fov/2): divide by width and height, not by one less.";
    FACTOR = "picture-factor":
        "the whole picture is too bright or too dark by one factor",
        at "the division by the number of samples, and the strength of the lights",
        fix "Divide the sum of all samples by how many there were, once.";
    STRIPE = "picture-stripe":
        "some columns or rows side by side are brighter or darker than all others",
        at "what those columns or rows have of their own: a tile, a thread, lanes of a vector, the last of a loop",
        fix "Give every column and row the same samples, each with numbers of its own, and divide by their number.";
    GAMMA_TWICE = "gamma-in-film":
        "the film holds gamma-encoded values where linear radiance belongs",
        at "the film, where radiance is stored",
        fix "Write linear radiance; encode only when an 8-bit picture is written.";
    ENCODED_OTHERWISE = "encoded-otherwise":
        "the 8-bit picture is encoded with another curve than is declared",
        at "where radiance becomes codes: the exponent, or the sRGB curve",
        fix "Encode with the curve that is declared, or declare the one that is used.";
    ROUNDED_OTHERWISE = "codes-rounded-otherwise":
        "the codes of the 8-bit picture lie half a code off: cut off where they should be rounded",
        at "the conversion of a number to a byte",
        fix "Round to the nearest code: floor(255 v + 0.5). A cast alone cuts off.";
    CHANNELS_SWAPPED = "channels-swapped":
        "red and blue are swapped",
        at "the film, where the three channels of a pixel are stored",
        fix "A pixel is red, green, blue, in this order.";
    BORDER_LEFT_OUT = "picture-border-left-out":
        "the first or the last row and column of the picture are not rendered",
        at "the loops over rows and columns: where they begin and end",
        fix "Columns run from 0 to width − 1 and rows from 0 to height − 1, all included.";
    PARTIAL_TILES_LEFT_OUT = "partial-tiles-left-out":
        "what is left over when the picture is cut into tiles is not rendered",
        at "the number of tiles, and the size of the last one in each direction",
        fix "Round the number of tiles up, and cut the last tile off at the picture's border.";
    COUNTS_OFF_BY_ONE = "sample-counts-off-by-one":
        "the count of samples is one off",
        at "the loop over the samples of a pixel, and its counter after the last one",
        fix "Count a sample where it is added to the pixel.";
    UPSIDE_DOWN = "picture-upside-down":
        "the picture is upside down",
        at "the step from the row of a pixel to the film's y, or the order of rows in the film",
        fix "Row 0 is the top of the picture, and the film's y grows upwards: y = 1 − (row + v)/height.";
    MIRRORED = "picture-mirrored":
        "left and right of the picture are swapped",
        at "the step from the column of a pixel to the film's x, or the camera's right axis",
        fix "Column 0 is on the left: x = (column + u)/width, and right is up × backward.";
    TURNED = "picture-turned-round":
        "the picture is turned by 180°",
        at "the signs of the camera's right and up axes",
        fix "The camera looks along −z of its frame; with +z both axes come out reversed.";
    TRANSPOSED = "picture-transposed":
        "rows and columns of the picture are swapped",
        at "the index of a pixel in the film, or x and y in the step from pixel to film point",
        fix "The pixel of column x and row y stands at y · width + x, and x goes with the width.";
}
