//! Part 1: camera rays, and where the samples of a pixel lie.

use super::{Cause, causes};

const LOOK_AT: &str =
    "the loop over a pixel's samples, where two random numbers become a film point";
const STRATA: &str =
    "the loop over a pixel's samples, where the number of a sample becomes a cell of the grid";

causes! {
    FILM_Y_DOWN = "film-y-down":
        "the film's y axis points down",
        at "the camera's rays, where film coordinates become directions",
        fix "Film coordinates begin at the bottom left: y grows upwards.";
    FOV_NOT_HALVED = "fov-not-halved":
        "the sensor is tan(fov) wide on each side, not tan(fov/2)",
        at "the camera's rays, where film coordinates become directions",
        fix "The sensor at distance 1 spans ±tan(fov/2).";
    FOV_TO_RADIANS_TWICE = "fov-to-radians-twice":
        "the field of view is in radians and was converted from degrees once more",
        at "the camera's rays, where film coordinates become directions",
        fix "Take the angle as it is: it is in radians already.";
    FOV_TO_DEGREES = "fov-to-degrees":
        "the field of view was converted to degrees before its tangent was taken",
        at "the camera's rays, where film coordinates become directions",
        fix "Tangents take radians: convert degrees once, where they come in.";
    FOV_WITHOUT_TANGENT = "fov-without-tangent":
        "the angle fov/2 stands where its tangent belongs",
        at "the camera's rays, where film coordinates become directions",
        fix "The sensor at distance 1 spans ±tan(fov/2).";
    SENSOR_HALF_SIZE = "sensor-half-size":
        "the sensor is half as large as it should be: it spans ±tan(fov/2)/2",
        at "the camera's rays, where film coordinates become directions",
        fix "Film coordinates from 0 to 1 become −1 to 1 before they are multiplied by tan(fov/2).";
    FOVS_SWAPPED = "fovs-swapped":
        "horizontal and vertical field of view are swapped",
        at "the camera's rays, where film coordinates become directions",
        fix "x goes with the horizontal field of view, y with the vertical one.";
    HORIZONTAL_FOV_FOR_BOTH = "horizontal-fov-for-both":
        "the horizontal field of view is used in both directions",
        at "the camera's rays, where film coordinates become directions",
        fix "Multiply y by the tangent of half the vertical field of view.";
    FILM_X_LEFT = "film-x-left":
        "the film's x axis points left",
        at "the camera's rays, where film coordinates become directions",
        fix "Film coordinates begin at the bottom left: x grows to the right.";
    FILM_TRANSPOSED = "film-transposed":
        "the film's x and y are swapped",
        at "the camera's rays, where film coordinates become directions",
        fix "x runs along a row of the picture, y along a column.";
    FILM_NOT_CENTRED = "film-not-centred":
        "the film is not centred: (0, 0) looks straight ahead",
        at "the camera's rays, where film coordinates become directions",
        fix "Subtract ½ from film coordinates, or take 2x − 1: the centre (½, ½) looks straight ahead.";
    HALF_PIXEL_TWICE = "half-pixel-twice":
        "half a pixel is added to film points that already are exact",
        at "the camera's rays, where film coordinates become directions",
        fix "Take film points as they are; the sample within the pixel is already in them.";
    LOOKS_ALONG_PLUS_Z = "looks-along-plus-z":
        "the camera looks along its +z axis, not −z",
        at "the camera's rays, where film coordinates become directions",
        fix "The sensor stands at z = −1 in camera space.";
    CAMERA_TO_WORLD_TRANSPOSED = "camera-to-world-transposed":
        "camera_to_world is transposed",
        at "the camera's rays, where film coordinates become directions",
        fix "Multiply the matrix by the column vector: camera_to_world · direction.";
    CAMERA_TO_WORLD_FORGOTTEN = "camera-to-world-forgotten":
        "camera_to_world is not applied",
        at "the camera's rays, where film coordinates become directions",
        fix "Turn the direction from camera space into the world with camera_to_world.";
    POSITION_ADDED_TO_DIRECTION = "position-added-to-direction":
        "the camera's position is added to the direction, as if it were a point",
        at "the camera's rays, where film coordinates become directions",
        fix "A direction is only turned, never moved: the position is the ray's origin.";
    CLIPS_NOT_SET = "clips-not-set":
        "camera rays do not begin and end at the clip distances",
        at "the camera's rays, where t_min and t_max are set",
        fix "Set t_min to the near and t_max to the far clip distance.";
    ORIGIN_NOT_AT_CAMERA = "origin-not-at-camera":
        "camera rays do not start at the camera's position",
        at "the camera's rays, where the origin is set",
        fix "The origin of every camera ray is the camera's position in the world.";
    DIRECTION_NOT_UNIT = "direction-not-unit":
        "camera rays have directions that are not of unit length",
        at "the camera's rays, at the end",
        fix "Normalise the direction, and keep the result: `d = d.unit()`.";
    PIXEL_CENTRE = "samples-at-pixel-centre":
        "every sample of a pixel goes through its centre",
        at LOOK_AT,
        fix "Add two fresh numbers in [0, 1) to the pixel's column and row for each sample.";
    PIXEL_CORNER = "samples-at-pixel-corner":
        "every sample of a pixel goes through its corner",
        at LOOK_AT,
        fix "Add two fresh numbers in [0, 1) to the pixel's column and row for each sample.";
    HALF_A_PIXEL = "half-a-pixel-off":
        "the samples of a pixel are shifted by half a pixel",
        at LOOK_AT,
        fix "Column and row are a pixel's corner: random numbers in [0, 1) need no half added to them.";
    WHOLE_PIXEL = "one-pixel-off":
        "the samples of a pixel lie in its neighbour",
        at LOOK_AT,
        fix "Column 0 begins at x = 0, row 0 at y = 1: y = 1 − (row + v)/height.";
    JITTER_TOO_NARROW = "jitter-too-narrow":
        "the samples of a pixel fill only a quarter of it",
        at LOOK_AT,
        fix "The random offset runs over the whole pixel: 0 to 1 in both directions.";
    JITTER_TOO_WIDE = "jitter-too-wide":
        "the samples of a pixel reach into its neighbours",
        at LOOK_AT,
        fix "The random offset runs from 0 to 1, evenly; no filter is asked for.";
    ONE_NUMBER_TWICE = "pixel-jitter-is-one-number":
        "one random number serves as both offsets, so that all samples lie on the pixel's diagonal",
        at LOOK_AT,
        fix "Draw two numbers for each sample, one for x and one for y.";
    ONE_AXIS_ONLY = "pixel-jitter-on-one-axis":
        "the samples of a pixel are spread along one axis only",
        at LOOK_AT,
        fix "Draw two numbers for each sample, one for x and one for y.";
    STRATA_IGNORED = "strata-ignored":
        "the samples of a pixel are not stratified at all",
        at STRATA,
        fix "Of k · k samples number i belongs to column i mod k and row i / k of the grid.";
    STRATA_UNEVEN = "strata-uneven":
        "some cells of a pixel get several samples, and others none",
        at STRATA,
        fix "Of k · k samples number i belongs to column i mod k and row i / k of the grid.";
    STRATUM_CENTRE = "stratum-centre":
        "every sample lies in the middle of its cell",
        at STRATA,
        fix "Within its cell a sample is a random point: (cell + number in [0, 1)) / k in each direction.";
    STRATUM_HALF = "stratum-half":
        "samples fill only half the width of their cells",
        at STRATA,
        fix "Within its cell a sample is a random point: (cell + number in [0, 1)) / k in each direction.";
}
