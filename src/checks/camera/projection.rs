//! The projection formula, and the wrong formulas that people write instead.

use crate::cause::{Cause, camera};
use crate::scene::Camera;
use glam::{DMat3, DVec2, DVec3, Vec2Swizzles};

/// A direction of any length through a film point.
pub(crate) type Formula = fn(&Camera, DVec2) -> DVec3;

/// The right formula, as [`Camera`] states it: a sensor at distance 1 in front of the pinhole.
pub(crate) fn projection(camera: &Camera, film: DVec2) -> DVec3 {
    through(camera, centred(film) * half_sensor(camera))
}

/// From the pinhole through a point of the sensor.
fn through(camera: &Camera, sensor: DVec2) -> DVec3 {
    camera.camera_to_world * sensor.extend(-1.0)
}

/// Film coordinates from −1 to 1.
fn centred(film: DVec2) -> DVec2 {
    2.0 * film - 1.0
}

/// Half the width and height of the sensor.
fn half_sensor(camera: &Camera) -> DVec2 {
    DVec2::new((camera.horizontal_fov / 2.0).tan(), (camera.vertical_fov / 2.0).tan())
}

/// The right formula with other angles of view.
fn with_fov(camera: &Camera, film: DVec2, angle: impl Fn(f64) -> f64) -> DVec3 {
    let [horizontal_fov, vertical_fov] = [camera.horizontal_fov, camera.vertical_fov].map(angle);
    projection(&Camera { horizontal_fov, vertical_fov, ..*camera }, film)
}

/// The right formula with another rotation of the camera.
fn rotated(camera: &Camera, film: DVec2, camera_to_world: DMat3) -> DVec3 {
    projection(&Camera { camera_to_world, ..*camera }, film)
}

/// A formula that people write instead.
pub(crate) struct Mistake {
    pub(crate) cause: &'static Cause,
    pub(crate) formula: Formula,
}

const fn mistake(cause: &'static Cause, formula: Formula) -> Mistake {
    Mistake { cause, formula }
}

/// Each predicts other rays than the rest for a camera in general position, so that the one which predicts all
/// rays of all cameras is the one that was made.
pub(crate) const MISTAKES: &[Mistake] = &[
    mistake(&camera::FOV_NOT_HALVED, |camera, film| with_fov(camera, film, |fov| 2.0 * fov)),
    mistake(&camera::FOV_TO_RADIANS_TWICE, |camera, film| with_fov(camera, film, f64::to_radians)),
    mistake(&camera::FOV_TO_DEGREES, |camera, film| with_fov(camera, film, f64::to_degrees)),
    mistake(&camera::FOV_WITHOUT_TANGENT, |camera, film| {
        let half = DVec2::new(camera.horizontal_fov, camera.vertical_fov) / 2.0;
        through(camera, centred(film) * half)
    }),
    mistake(&camera::SENSOR_HALF_SIZE, |camera, film| {
        through(camera, 0.5 * centred(film) * half_sensor(camera))
    }),
    mistake(&camera::HALF_TANGENT, |camera, film| {
        let tangents = DVec2::new(camera.horizontal_fov.tan(), camera.vertical_fov.tan());
        through(camera, centred(film) * tangents / 2.0)
    }),
    mistake(&camera::FOVS_SWAPPED, |camera, film| {
        through(camera, centred(film) * half_sensor(camera).yx())
    }),
    mistake(&camera::HORIZONTAL_FOV_FOR_BOTH, |camera, film| {
        through(camera, centred(film) * half_sensor(camera).xx())
    }),
    mistake(&camera::FILM_Y_DOWN, |camera, film| {
        projection(camera, DVec2::new(film.x, 1.0 - film.y))
    }),
    mistake(&camera::FILM_X_LEFT, |camera, film| {
        projection(camera, DVec2::new(1.0 - film.x, film.y))
    }),
    mistake(&camera::FILM_TRANSPOSED, |camera, film| projection(camera, film.yx())),
    mistake(&camera::FILM_NOT_CENTRED, |camera, film| projection(camera, 0.5 * film + 0.5)),
    mistake(&camera::HALF_PIXEL_TWICE, |camera, film| {
        let pixel = DVec2::from(camera.film.map(f64::from)).recip();
        projection(camera, film + 0.5 * pixel)
    }),
    mistake(&camera::LOOKS_ALONG_PLUS_Z, |camera, film| {
        camera.camera_to_world * (centred(film) * half_sensor(camera)).extend(1.0)
    }),
    mistake(&camera::CAMERA_TO_WORLD_TRANSPOSED, |camera, film| {
        rotated(camera, film, camera.camera_to_world.transpose())
    }),
    mistake(&camera::CAMERA_TO_WORLD_FORGOTTEN, |camera, film| {
        rotated(camera, film, DMat3::IDENTITY)
    }),
    mistake(&camera::POSITION_ADDED_TO_DIRECTION, |camera, film| {
        projection(camera, film) + camera.position
    }),
];
