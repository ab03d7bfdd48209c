//! Images as a whole: film, encoding, alignment.

use super::{Cause, causes};

causes! {
    NOT_DIVIDED = "pixel-not-divided-by-samples":
        "the sum over a pixel's samples is not divided by their number",
        at "the film, where a pixel's samples become its value",
        fix "Divide the sum of radiance by the number of samples, once.";
    DIVIDED_TWICE = "pixel-divided-twice":
        "the sum over a pixel's samples is divided by their number twice",
        at "the film, where a pixel's samples become its value",
        fix "Weight each sample by 1/n or divide the sum by n, not both.";
    DIVIDED_BY_ONE_MORE = "pixel-divided-by-one-too-many":
        "a pixel's sum is divided by one more than the number of samples added",
        at "the loop over a pixel's samples, and its counter after the last one",
        fix "Count a sample where it is added; a loop counter may be one off when the loop ends.";
    ONE_SAMPLE_TOO_MANY = "pixel-adds-one-too-many":
        "a pixel adds one sample more than its sum is divided by",
        at "the loop over a pixel's samples: its first and last iteration",
        fix "Take exactly as many samples as the sum is divided by.";
    CLAMPED = "film-clamped":
        "radiance is clamped to 1 before it is stored in the film",
        at "the film, where radiance is stored",
        fix "Store linear radiance unclamped; clamp only when writing an 8-bit image.";
    SAMPLES_CLAMPED = "samples-clamped":
        "bright samples (fireflies) are clamped before they are averaged, which loses energy",
        at "where a path's radiance is added to its pixel",
        fix "Add every sample unclamped; more samples make fireflies fade.";
    DISPLACED = "picture-displaced":
        "the whole image is shifted",
        at "the mapping from a pixel's column and row to film coordinates",
        fix "Sample (u, v) of the pixel in column c and row r is at film point ((c + u)/width, 1 − (r + v)/height).";
    MAGNIFIED = "picture-magnified":
        "the whole image is scaled about its centre",
        at "the field of view, and the division by the film's size",
        fix "The film is 2 tan(fov/2) wide, where fov is the horizontal one: divide by width and height, not by one less.";
    FACTOR = "picture-factor":
        "the whole image is too bright or too dark by one factor",
        at "the division by the number of samples, and the radiance of the lights",
        fix "Divide the sum of all samples by their number, once.";
    STRIPE = "picture-stripe":
        "a band of adjacent columns or rows is brighter or darker than the rest",
        at "what those columns or rows have in common: a tile, a thread, SIMD lanes, the end of a loop",
        fix "Give every column and row the same number of samples, each with its own random numbers, and divide by that number.";
    GAMMA_TWICE = "gamma-in-film":
        "the film holds gamma-encoded values, not linear radiance",
        at "the film, where radiance is stored",
        fix "Store linear radiance; apply the sRGB transfer function only when writing an 8-bit image.";
    ENCODED_OTHERWISE = "encoded-otherwise":
        "the 8-bit image is encoded with a different transfer function than is declared",
        at "where radiance becomes 8-bit codes: the gamma exponent, or the sRGB transfer function",
        fix "Encode with the declared transfer function, or declare the one in use.";
    ROUNDED_OTHERWISE = "codes-rounded-otherwise":
        "8-bit codes are truncated where they should be rounded: they lie half a code off",
        at "the conversion of a float to a byte",
        fix "Round to the nearest code: floor(255 v + 0.5). A cast alone truncates.";
    CHANNELS_SWAPPED = "channels-swapped":
        "the red and blue channels are swapped",
        at "the film, where the three channels of a pixel are stored",
        fix "A pixel is red, green, blue, in this order.";
    BORDER_LEFT_OUT = "picture-border-left-out":
        "the first or last row and column of the image are not rendered",
        at "the loops over rows and columns: where they begin and end",
        fix "Columns run from 0 to width − 1 and rows from 0 to height − 1, inclusive.";
    PARTIAL_TILES_LEFT_OUT = "partial-tiles-left-out":
        "partial tiles at the image border are not rendered",
        at "the number of tiles, and the size of the last one in each direction",
        fix "Round the number of tiles up, and clip the last tile at the image border.";
    COUNTS_OFF_BY_ONE = "sample-counts-off-by-one":
        "the sample count is off by one",
        at "the loop over a pixel's samples, and its counter after the last one",
        fix "Count a sample where it is added to the pixel.";
    UPSIDE_DOWN = "picture-upside-down":
        "the image is upside down",
        at "the step from a pixel's row to the film's y, the order of rows in the film, or the camera's up axis",
        fix "Row 0 is the top of the image, and the film's y grows upwards: y = 1 − (row + v)/height.";
    MIRRORED = "picture-mirrored":
        "the image is mirrored: left and right are swapped",
        at "the step from a pixel's column to the film's x, or the camera's right axis",
        fix "Column 0 is on the left: x = (column + u)/width, and right is up × backward.";
    TURNED = "picture-turned-round":
        "the image is rotated by 180°",
        at "the signs of the camera's right and up axes",
        fix "The camera looks along −z of its frame; with +z both axes come out reversed.";
    TRANSPOSED = "picture-transposed":
        "the image is transposed: rows and columns are swapped",
        at "the index of a pixel in the film, or x and y in the step from pixel to film point",
        fix "The pixel in column x and row y is at index y · width + x; x is divided by the width.";
}
