//! Part 1: camera rays and the samples of a pixel.

use super::Cause;

/// See its headline.
pub static FILM_Y_DOWN: Cause = Cause {
    name: "film-y-down",
    headline: "the film's y axis points down",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Film coordinates begin at the bottom left: y grows upwards.",
};

/// See its headline.
pub static FOV_NOT_HALVED: Cause = Cause {
    name: "fov-not-halved",
    headline: "the sensor is tan(fov) wide on each side, not tan(fov/2)",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "The sensor at distance 1 spans ±tan(fov/2).",
};

/// See its headline.
pub static FOV_TO_RADIANS_TWICE: Cause = Cause {
    name: "fov-to-radians-twice",
    headline: "the field of view is in radians and was converted from degrees once more",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Take the angle as it is: it is in radians already.",
};

/// See its headline.
pub static FOV_TO_DEGREES: Cause = Cause {
    name: "fov-to-degrees",
    headline: "the field of view was converted to degrees before its tangent was taken",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Tangents take radians: convert degrees once, where they come in.",
};

/// See its headline.
pub static FOV_WITHOUT_TANGENT: Cause = Cause {
    name: "fov-without-tangent",
    headline: "the angle fov/2 stands where its tangent belongs",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "The sensor at distance 1 spans ±tan(fov/2).",
};

/// See its headline.
pub static SENSOR_HALF_SIZE: Cause = Cause {
    name: "sensor-half-size",
    headline: "the sensor is half as large as it should be: it spans ±tan(fov/2)/2",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Film coordinates from 0 to 1 become −1 to 1 before they are multiplied by tan(fov/2).",
};

/// See its headline.
pub static FOVS_SWAPPED: Cause = Cause {
    name: "fovs-swapped",
    headline: "horizontal and vertical field of view are swapped",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "x goes with the horizontal field of view, y with the vertical one.",
};

/// See its headline.
pub static HORIZONTAL_FOV_FOR_BOTH: Cause = Cause {
    name: "horizontal-fov-for-both",
    headline: "the horizontal field of view is used in both directions",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Multiply y by the tangent of half the vertical field of view.",
};

/// See its headline.
pub static FILM_X_LEFT: Cause = Cause {
    name: "film-x-left",
    headline: "the film's x axis points left",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Film coordinates begin at the bottom left: x grows to the right.",
};

/// See its headline.
pub static FILM_TRANSPOSED: Cause = Cause {
    name: "film-transposed",
    headline: "the film's x and y are swapped",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "x runs along a row of the picture, y along a column.",
};

/// See its headline.
pub static FILM_NOT_CENTRED: Cause = Cause {
    name: "film-not-centred",
    headline: "the film is not centred: (0, 0) looks straight ahead",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Subtract ½ from film coordinates, or take 2x − 1: the centre (½, ½) looks straight ahead.",
};

/// See its headline.
pub static HALF_PIXEL_TWICE: Cause = Cause {
    name: "half-pixel-twice",
    headline: "half a pixel is added to film points that already are exact",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Take film points as they are; the sample within the pixel is already in them.",
};

/// See its headline.
pub static LOOKS_ALONG_PLUS_Z: Cause = Cause {
    name: "looks-along-plus-z",
    headline: "the camera looks along its +z axis, not −z",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "The sensor stands at z = −1 in camera space.",
};

/// See its headline.
pub static CAMERA_TO_WORLD_TRANSPOSED: Cause = Cause {
    name: "camera-to-world-transposed",
    headline: "camera_to_world is transposed",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Multiply the matrix by the column vector: camera_to_world · direction.",
};

/// See its headline.
pub static CAMERA_TO_WORLD_FORGOTTEN: Cause = Cause {
    name: "camera-to-world-forgotten",
    headline: "camera_to_world is not applied",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "Turn the direction from camera space into the world with camera_to_world.",
};

/// See its headline.
pub static POSITION_ADDED_TO_DIRECTION: Cause = Cause {
    name: "position-added-to-direction",
    headline: "the camera's position is added to the direction, as if it were a point",
    look_at: "the camera's rays, where film coordinates become directions",
    remedy: "A direction is only turned, never moved: the position is the ray's origin.",
};

/// See its headline.
pub static CLIPS_NOT_SET: Cause = Cause {
    name: "clips-not-set",
    headline: "camera rays do not begin and end at the clip distances",
    look_at: "the camera's rays, where t_min and t_max are set",
    remedy: "Set t_min to the near and t_max to the far clip distance.",
};

/// See its headline.
pub static ORIGIN_NOT_AT_CAMERA: Cause = Cause {
    name: "origin-not-at-camera",
    headline: "camera rays do not start at the camera's position",
    look_at: "the camera's rays, where the origin is set",
    remedy: "The origin of every camera ray is the camera's position in the world.",
};

/// See its headline.
pub static DIRECTION_NOT_UNIT: Cause = Cause {
    name: "direction-not-unit",
    headline: "camera rays have directions that are not of unit length",
    look_at: "the camera's rays, at the end",
    remedy: "Normalise the direction, and keep the result: `d = d.unit()`.",
};

/// Every cause of this part.
pub static CAUSES: &[&Cause] = &[
    &FILM_Y_DOWN,
    &FOV_NOT_HALVED,
    &FOV_TO_RADIANS_TWICE,
    &FOV_TO_DEGREES,
    &FOV_WITHOUT_TANGENT,
    &SENSOR_HALF_SIZE,
    &FOVS_SWAPPED,
    &HORIZONTAL_FOV_FOR_BOTH,
    &FILM_X_LEFT,
    &FILM_TRANSPOSED,
    &FILM_NOT_CENTRED,
    &HALF_PIXEL_TWICE,
    &LOOKS_ALONG_PLUS_Z,
    &CAMERA_TO_WORLD_TRANSPOSED,
    &CAMERA_TO_WORLD_FORGOTTEN,
    &POSITION_ADDED_TO_DIRECTION,
    &CLIPS_NOT_SET,
    &ORIGIN_NOT_AT_CAMERA,
    &DIRECTION_NOT_UNIT,
];
