//! Part 1: camera rays, and where the samples of a pixel lie.

use super::{Cause, causes};

const LOOK_AT: &str =
    "the loop over a pixel's samples, where two random numbers become film coordinates";
const STRATA: &str = "the loop over a pixel's samples, where the sample index becomes a stratum";

causes! {
    FILM_Y_DOWN = "film-y-down":
        "the film's y axis points down",
        at "camera ray generation, where film coordinates become a direction",
        fix "Film coordinates start at the bottom left: y grows upwards.";
    FOV_NOT_HALVED = "fov-not-halved":
        "the sensor spans ±tan(fov), not ±tan(fov/2)",
        at "camera ray generation, where film coordinates become a direction",
        fix "The sensor at distance 1 spans ±tan(fov/2).";
    FOV_TO_RADIANS_TWICE = "fov-to-radians-twice":
        "the field of view is already in radians and is converted from degrees again",
        at "camera ray generation, where film coordinates become a direction",
        fix "Use the angle as it is: it is already in radians.";
    FOV_TO_DEGREES = "fov-to-degrees":
        "the field of view is converted to degrees before its tangent is taken",
        at "camera ray generation, where film coordinates become a direction",
        fix "Tangents take radians: convert degrees once, on input.";
    FOV_WITHOUT_TANGENT = "fov-without-tangent":
        "the sensor spans ±fov/2: the tangent is missing",
        at "camera ray generation, where film coordinates become a direction",
        fix "The sensor at distance 1 spans ±tan(fov/2).";
    SENSOR_HALF_SIZE = "sensor-half-size":
        "the sensor is half as large as it should be: it spans ±tan(fov/2)/2",
        at "camera ray generation, where film coordinates become a direction",
        fix "Map film coordinates from [0, 1] to [−1, 1] before multiplying by tan(fov/2).";
    HALF_TANGENT = "half-tangent":
        "the sensor spans ±tan(fov)/2: half the tangent instead of the tangent of the half",
        at "camera ray generation, where film coordinates become a direction",
        fix "The sensor at distance 1 spans ±tan(fov/2): halve the angle, then take the tangent.";
    FOVS_SWAPPED = "fovs-swapped":
        "the horizontal and the vertical field of view are swapped",
        at "camera ray generation, where film coordinates become a direction",
        fix "x uses the horizontal field of view, y the vertical one.";
    HORIZONTAL_FOV_FOR_BOTH = "horizontal-fov-for-both":
        "the horizontal field of view is used on both axes",
        at "camera ray generation, where film coordinates become a direction",
        fix "Multiply y by the tangent of half the vertical field of view.";
    FILM_X_LEFT = "film-x-left":
        "the film's x axis points left",
        at "camera ray generation, where film coordinates become a direction",
        fix "Film coordinates start at the bottom left: x grows to the right.";
    FILM_TRANSPOSED = "film-transposed":
        "the film's x and y coordinates are swapped",
        at "camera ray generation, where film coordinates become a direction",
        fix "x runs along a row of the image, y along a column.";
    FILM_NOT_CENTRED = "film-not-centred":
        "the film is not centred: a corner of it looks straight ahead, not (½, ½)",
        at "camera ray generation, where film coordinates become a direction",
        fix "Map film coordinates with 2x − 1, so that the centre (½, ½) looks straight ahead.";
    HALF_PIXEL_TWICE = "half-pixel-twice":
        "half a pixel is added to film coordinates that already include the offset within the pixel",
        at "camera ray generation, where film coordinates become a direction",
        fix "Use film coordinates as they are: the sample's offset within the pixel is already in them.";
    LOOKS_ALONG_PLUS_Z = "looks-along-plus-z":
        "the camera looks along its +z axis, not its −z axis",
        at "camera ray generation, where film coordinates become a direction",
        fix "In camera space the sensor lies at z = −1.";
    CAMERA_TO_WORLD_TRANSPOSED = "camera-to-world-transposed":
        "the camera-to-world matrix is transposed",
        at "camera ray generation, where film coordinates become a direction",
        fix "Multiply the matrix by the column vector: camera_to_world · direction.";
    CAMERA_TO_WORLD_FORGOTTEN = "camera-to-world-forgotten":
        "the camera-to-world transform is not applied",
        at "camera ray generation, where film coordinates become a direction",
        fix "Transform the direction from camera space to world space with camera_to_world.";
    POSITION_ADDED_TO_DIRECTION = "position-added-to-direction":
        "the camera's position is added to the ray direction, as if the direction were a point",
        at "camera ray generation, where film coordinates become a direction",
        fix "Rotate directions, never translate them: the camera's position is the ray's origin.";
    CLIPS_NOT_SET = "clips-not-set":
        "camera rays ignore the near and far clip distances",
        at "camera ray generation, where t_min and t_max are set",
        fix "Set t_min to the near clip distance and t_max to the far one.";
    CLIPS_ALONG_AXIS = "clips-along-the-axis":
        "the clip distances are taken along the camera's axis, not along the ray",
        at "camera ray generation, where t_min and t_max are set",
        fix "Clip distances are values of t of the unit direction: do not divide them by its cosine with the axis.";
    ORIGIN_NOT_AT_CAMERA = "origin-not-at-camera":
        "camera rays do not start at the camera's position",
        at "camera ray generation, where the origin is set",
        fix "The origin of every camera ray is the camera's position in world space.";
    DIRECTION_NOT_UNIT = "direction-not-unit":
        "camera ray directions are not normalised",
        at "camera ray generation, at the end",
        fix "Normalise the direction and keep the result: `d = d.unit()`.";
    PIXEL_CENTRE = "samples-at-pixel-centre":
        "every sample of a pixel is at its centre: there is no jitter",
        at LOOK_AT,
        fix "Add two fresh random numbers in [0, 1) to the pixel's column and row for each sample.";
    PIXEL_CORNER = "samples-at-pixel-corner":
        "every sample of a pixel is at its corner: there is no jitter",
        at LOOK_AT,
        fix "Add two fresh random numbers in [0, 1) to the pixel's column and row for each sample.";
    HALF_A_PIXEL = "half-a-pixel-off":
        "pixel samples are shifted by half a pixel",
        at LOOK_AT,
        fix "Column and row are the pixel's corner: do not add ½ to random numbers in [0, 1).";
    WHOLE_PIXEL = "one-pixel-off":
        "pixel samples land in the neighbouring pixel",
        at LOOK_AT,
        fix "Column 0 starts at x = 0, row 0 at y = 1: y = 1 − (row + v)/height.";
    JITTER_TOO_NARROW = "jitter-too-narrow":
        "pixel samples cover only a quarter of the pixel",
        at LOOK_AT,
        fix "The jitter covers the whole pixel: [0, 1) on both axes.";
    JITTER_TOO_WIDE = "jitter-too-wide":
        "pixel samples reach into neighbouring pixels",
        at LOOK_AT,
        fix "The jitter is uniform in [0, 1) on both axes: the pixel filter is a box.";
    ONE_NUMBER_TWICE = "pixel-jitter-is-one-number":
        "one random number jitters both axes, so all samples lie on the pixel's diagonal",
        at LOOK_AT,
        fix "Draw two random numbers for each sample, one for x and one for y.";
    ONE_AXIS_ONLY = "pixel-jitter-on-one-axis":
        "pixel samples are jittered along one axis only",
        at LOOK_AT,
        fix "Draw two random numbers for each sample, one for x and one for y.";
    STRATA_IGNORED = "strata-ignored":
        "pixel samples are not stratified",
        at STRATA,
        fix "Of k · k samples, sample i belongs to stratum (i mod k, i / k).";
    STRATA_UNEVEN = "strata-uneven":
        "some strata of a pixel get several samples and others none",
        at STRATA,
        fix "Of k · k samples, sample i belongs to stratum (i mod k, i / k).";
    STRATUM_CENTRE = "stratum-centre":
        "every sample is at the centre of its stratum: there is no jitter within strata",
        at STRATA,
        fix "Jitter within the stratum: (cell + random number in [0, 1)) / k on each axis.";
    STRATUM_HALF = "stratum-half":
        "samples cover only half the width of their strata",
        at STRATA,
        fix "Jitter within the stratum: (cell + random number in [0, 1)) / k on each axis.";
}
