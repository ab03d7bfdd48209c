//! Part 1: camera rays and the samples of a pixel.

use super::Fault;
use crate::cause::{camera, picture, pixel};
use crate::cores::textbook::change::Change;

const RAYS: &str = "camera/rays-leave-through-their-film-points";

/// In the order of the lecture.
pub const FAULTS: &[Fault] = &[
    Fault {
        change: Change::FovNotHalved,
        name: "fov-not-halved",
        part: 1,
        summary: "tan(fov) for half the width of the sensor, not tan(fov/2)",
        caught_by: RAYS,
        cause: &camera::FOV_NOT_HALVED,
    },
    Fault {
        change: Change::FovToDegrees,
        name: "fov-in-degrees",
        part: 1,
        summary: "the tangent of an angle in degrees",
        caught_by: RAYS,
        cause: &camera::FOV_TO_DEGREES,
    },
    Fault {
        change: Change::HorizontalFovForBoth,
        name: "horizontal-fov-for-both",
        part: 1,
        summary: "y is multiplied by the tangent of the horizontal field of view",
        caught_by: RAYS,
        cause: &camera::HORIZONTAL_FOV_FOR_BOTH,
    },
    Fault {
        change: Change::SensorHalfSize,
        name: "sensor-half-size",
        part: 1,
        summary: "(x − ½) tan(fov/2): the sensor is half as wide as it should be",
        caught_by: RAYS,
        cause: &camera::SENSOR_HALF_SIZE,
    },
    Fault {
        change: Change::FilmNotCentred,
        name: "film-not-centred",
        part: 1,
        summary: "x and y of the film are used from 0 to 1, not from −1 to 1",
        caught_by: RAYS,
        cause: &camera::FILM_NOT_CENTRED,
    },
    Fault {
        change: Change::FilmYDown,
        name: "film-y-down",
        part: 1,
        summary: "the camera takes the film's y axis to point down",
        caught_by: RAYS,
        cause: &camera::FILM_Y_DOWN,
    },
    Fault {
        change: Change::CameraSpaceDirection,
        name: "camera-space-direction",
        part: 1,
        summary: "the direction is left in camera space: c2w is forgotten",
        caught_by: RAYS,
        cause: &camera::CAMERA_TO_WORLD_FORGOTTEN,
    },
    Fault {
        change: Change::CameraTransposed,
        name: "camera-transposed",
        part: 1,
        summary: "the inverse of c2w turns the direction",
        caught_by: RAYS,
        cause: &camera::CAMERA_TO_WORLD_TRANSPOSED,
    },
    Fault {
        change: Change::LooksAlongPlusZ,
        name: "looks-along-plus-z",
        part: 1,
        summary: "the sensor stands at z = +1 in camera space",
        caught_by: RAYS,
        cause: &camera::LOOKS_ALONG_PLUS_Z,
    },
    Fault {
        change: Change::DirectionNotUnit,
        name: "direction-not-unit",
        part: 1,
        summary: "`d.unit();` with the result thrown away",
        caught_by: RAYS,
        cause: &camera::DIRECTION_NOT_UNIT,
    },
    Fault {
        change: Change::ClipsIgnored,
        name: "clips-ignored",
        part: 1,
        summary: "min_t and max_t are not set to the clip distances",
        caught_by: RAYS,
        cause: &camera::CLIPS_NOT_SET,
    },
    Fault {
        change: Change::PixelCorner,
        name: "pixel-corner",
        part: 1,
        summary: "the corner of the pixel in place of a random point of it",
        caught_by: "camera/samples-lie-evenly-in-their-pixel",
        cause: &pixel::PIXEL_CORNER,
    },
    Fault {
        change: Change::HalfPixelAdded,
        name: "half-pixel-added",
        part: 1,
        summary: "half a pixel is added to points that are random in it already",
        caught_by: "camera/samples-lie-evenly-in-their-pixel",
        cause: &pixel::HALF_A_PIXEL,
    },
    Fault {
        change: Change::HalfPixelBothWays,
        name: "half-pixel-both-ways",
        part: 1,
        summary: "half a pixel too much in the camera's rays, and taken away where pixels are sampled: the picture is right",
        caught_by: RAYS,
        cause: &camera::HALF_PIXEL_TWICE,
    },
    Fault {
        change: Change::SamplesNotDivided,
        name: "samples-not-divided",
        part: 1,
        summary: "the sum of a pixel's samples is not divided by their number",
        caught_by: "camera/equal-samples-make-equal-pixels",
        cause: &picture::NOT_DIVIDED,
    },
    Fault {
        change: Change::PictureUpsideDown,
        name: "picture-upside-down",
        part: 1,
        summary: "rows of the picture are counted from the bottom",
        caught_by: "camera/up-is-up-and-right-is-right",
        cause: &picture::UPSIDE_DOWN,
    },
];
