//! Part 1: camera rays and the samples of a pixel.

use super::faults;
use crate::cause::{camera, image};
use crate::cores::textbook as lesson;
use glam::{DVec2, DVec3};
use lesson::camera::sensor_point;
use lesson::render::{film_point, stratum};

const STRATA: &str = "camera/stratified-samples-fill-every-stratum";
const RAYS: &str = "camera/rays-pass-through-their-film-points";

faults! { part 1;
    "fov-not-halved": "tan(fov) for half the width of the sensor, not tan(fov/2)",
        fails RAYS, told camera::FOV_NOT_HALVED,
        half_size = |field_of_view| field_of_view.tan();
    "fov-in-degrees": "the tangent of an angle in degrees",
        fails RAYS, told camera::FOV_TO_DEGREES,
        half_size = |field_of_view| (field_of_view.to_degrees() / 2.0).tan();
    "horizontal-fov-for-both": "y is multiplied by the tangent of the horizontal field of view",
        fails RAYS, told camera::HORIZONTAL_FOV_FOR_BOTH,
        fields_of_view = |camera| [camera.horizontal_fov; 2];
    "sensor-half-size": "(x − ½) tan(fov/2): the sensor is half as wide as it should be",
        fails RAYS, told camera::SENSOR_HALF_SIZE,
        half_size = |field_of_view| lesson::camera::half_size(field_of_view) / 2.0;
    "half-tangent": "(2x − 1) tan(fov)/2: half the tangent, not the tangent of the half",
        fails RAYS, told camera::HALF_TANGENT,
        half_size = |field_of_view| field_of_view.tan() / 2.0;
    "film-not-centred": "x and y of the film are used from 0 to 1, not from −1 to 1",
        fails RAYS, told camera::FILM_NOT_CENTRED,
        sensor_point = |camera, film, half_size| {
            sensor_point(camera, (film + 1.0) / 2.0, half_size)
        };
    "film-from-corner": "2x tan(fov/2): a corner of the film looks straight ahead",
        fails RAYS, told camera::FILM_NOT_CENTRED,
        sensor_point = |camera, film, half_size| sensor_point(camera, film + 0.5, half_size);
    "film-y-down": "the camera takes the film's y axis to point down",
        fails RAYS, told camera::FILM_Y_DOWN,
        sensor_point = |camera, film, half_size| {
            sensor_point(camera, DVec2::new(film.x, 1.0 - film.y), half_size)
        };
    "camera-space-direction": "the direction is left in camera space: c2w is forgotten",
        fails RAYS, told camera::CAMERA_TO_WORLD_FORGOTTEN,
        turned_to_world = |_, direction| direction;
    "camera-transposed": "the inverse of c2w turns the direction",
        fails RAYS, told camera::CAMERA_TO_WORLD_TRANSPOSED,
        turned_to_world = |camera, direction| camera.camera_to_world.transpose() * direction;
    "looks-along-plus-z": "the sensor stands at z = +1 in camera space",
        fails RAYS, told camera::LOOKS_ALONG_PLUS_Z,
        sensor_point = |camera, film, half_size| sensor_point(camera, film, half_size).with_z(1.0);
    "direction-not-unit": "`d.unit();` with the result thrown away",
        fails RAYS, told camera::DIRECTION_NOT_UNIT,
        unit = |direction| direction;
    "clips-ignored": "min_t and max_t are not set to the clip distances",
        fails RAYS, told camera::CLIPS_NOT_SET,
        clip_distances = |_, _| (0.0, f64::INFINITY);
    "clips-along-the-axis": "clip distances are taken along the camera's axis, not along the ray",
        fails RAYS, told camera::CLIPS_ALONG_AXIS,
        clip_distances = |camera, direction| {
            let cosine = (camera.camera_to_world * DVec3::NEG_Z).dot(direction);
            (camera.near / cosine, camera.far / cosine)
        };
    "pixel-corner": "the corner of the pixel in place of a random point of it",
        fails "camera/pixel-samples-are-uniform", told camera::PIXEL_CORNER,
        pixel_point = |random, _, _, _| 0.0 * random.point();
    "half-pixel-added": "half a pixel is added to points that are random in it already",
        fails "camera/pixel-samples-are-uniform", told camera::HALF_A_PIXEL,
        pixel_point = |random, _, _, _| random.point() + 0.5;
    "half-pixel-added-upwards":
        "half a pixel is added to points that are random in it already, where the film's y points up",
        fails "camera/pixel-samples-are-uniform", told camera::HALF_A_PIXEL,
        pixel_point = |random, _, _, _| random.point() + DVec2::new(0.5, -0.5);
    "half-pixel-both-ways":
        "half a pixel too much in the camera's rays, and taken away where pixels are sampled: \
         the picture is right",
        fails RAYS, told camera::HALF_PIXEL_TWICE,
        sensor_point = |camera, film, half_size| {
            sensor_point(camera, film + half_pixel(camera.film), half_size)
        },
        film_point = |settings, pixel, within| {
            film_point(settings, pixel, within) - half_pixel([settings.width, settings.height])
        };
    "samples-not-divided": "the sum of a pixel's samples is not divided by their number",
        fails "camera/constant-radiance-gives-a-constant-image", told image::NOT_DIVIDED,
        pixel_mean = |total, _| total;
    "picture-upside-down": "rows of the picture are counted from the bottom",
        fails "camera/image-is-upright-and-not-mirrored", told image::UPSIDE_DOWN,
        film_point = lesson::render::from_top;
    "strata-ignored": "samples are called stratified, and each is a random point of the pixel",
        fails STRATA, told camera::STRATA_IGNORED,
        stratum = |_, _, jitter| jitter;
    "strata-on-diagonal": "column and row of the cell are both i % k",
        fails STRATA, told camera::STRATA_UNEVEN,
        stratum = |sample, side, jitter| {
            (DVec2::splat(f64::from(sample % side)) + jitter) / f64::from(side)
        };
    "stratum-centre": "the middle of the cell in place of a random point of it",
        fails STRATA, told camera::STRATUM_CENTRE,
        stratum = |sample, side, _| stratum(sample, side, DVec2::splat(0.5));
    "stratum-half": "the jitter is divided by k twice: it covers half of the cell",
        fails STRATA, told camera::STRATUM_HALF,
        stratum = |sample, side, jitter| stratum(sample, side, 0.5 * jitter);
    "fields-of-view-swapped": "the horizontal field of view is the vertical one",
        fails RAYS, told camera::FOVS_SWAPPED,
        fields_of_view = |camera| [camera.vertical_fov, camera.horizontal_fov];
    "fov-without-tangent": "fov/2 for half the width of the sensor",
        fails RAYS, told camera::FOV_WITHOUT_TANGENT,
        half_size = |field_of_view| field_of_view / 2.0;
    "pixel-centre": "the middle of the pixel in place of a random point of it",
        fails "camera/pixel-samples-are-uniform", told camera::PIXEL_CENTRE,
        pixel_point = |random, _, _, _| 0.0 * random.point() + 0.5;
}

/// Half a pixel of a film of this many.
fn half_pixel([width, height]: [u32; 2]) -> DVec2 {
    0.5 / DVec2::new(f64::from(width), f64::from(height))
}
