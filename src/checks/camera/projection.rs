//! The projection formula, and the wrong formulas that people write instead.

use crate::cause::{Cause, camera};
use crate::scene::Camera;
use glam::{DMat3, DVec2, DVec3, Vec2Swizzles};

/// A direction of any length through a film point.
pub(crate) type Formula = fn(&Camera, DVec2) -> DVec3;

/// The right formula, as [`Camera`] states it: a sensor at distance 1 in front of the pinhole.
pub(crate) fn projection(camera: &Camera, film: DVec2) -> DVec3 {
    camera.camera_to_world * (centred(film) * half_sensor(camera)).extend(-1.0)
}

/// Film coordinates from −1 to 1.
fn centred(film: DVec2) -> DVec2 {
    2.0 * film - 1.0
}

/// Half the width and height of the sensor.
fn half_sensor(camera: &Camera) -> DVec2 {
    DVec2::new((camera.horizontal_fov / 2.0).tan(), (camera.vertical_fov / 2.0).tan())
}

/// The same camera with other angles of view.
fn with_fov(camera: &Camera, angle: impl Fn(f64) -> f64) -> Camera {
    Camera {
        horizontal_fov: angle(camera.horizontal_fov),
        vertical_fov: angle(camera.vertical_fov),
        ..*camera
    }
}

/// A formula that people write instead.
pub(crate) struct Mistake {
    /// What was done.
    pub(crate) cause: &'static Cause,
    /// The rays it makes.
    pub(crate) formula: Formula,
}

/// Each predicts other rays than the rest for a camera in general position, so that the one which predicts all
/// rays of all cameras is the one that was made.
pub(crate) const MISTAKES: &[Mistake] = &[
    Mistake {
        cause: &camera::FOV_NOT_HALVED,
        formula: |camera, film| projection(&with_fov(camera, |fov| 2.0 * fov), film),
    },
    Mistake {
        cause: &camera::FOV_TO_RADIANS_TWICE,
        formula: |camera, film| projection(&with_fov(camera, f64::to_radians), film),
    },
    Mistake {
        cause: &camera::FOV_TO_DEGREES,
        formula: |camera, film| projection(&with_fov(camera, f64::to_degrees), film),
    },
    Mistake {
        cause: &camera::FOV_WITHOUT_TANGENT,
        formula: |camera, film| {
            let half = DVec2::new(camera.horizontal_fov, camera.vertical_fov) / 2.0;
            camera.camera_to_world * (centred(film) * half).extend(-1.0)
        },
    },
    Mistake {
        cause: &camera::SENSOR_HALF_SIZE,
        formula: |camera, film| {
            camera.camera_to_world * (0.5 * centred(film) * half_sensor(camera)).extend(-1.0)
        },
    },
    Mistake {
        cause: &camera::FOVS_SWAPPED,
        formula: |camera, film| {
            camera.camera_to_world * (centred(film) * half_sensor(camera).yx()).extend(-1.0)
        },
    },
    Mistake {
        cause: &camera::HORIZONTAL_FOV_FOR_BOTH,
        formula: |camera, film| {
            camera.camera_to_world * (centred(film) * half_sensor(camera).xx()).extend(-1.0)
        },
    },
    Mistake {
        cause: &camera::FILM_Y_DOWN,
        formula: |camera, film| projection(camera, DVec2::new(film.x, 1.0 - film.y)),
    },
    Mistake {
        cause: &camera::FILM_X_LEFT,
        formula: |camera, film| projection(camera, DVec2::new(1.0 - film.x, film.y)),
    },
    Mistake {
        cause: &camera::FILM_TRANSPOSED,
        formula: |camera, film| projection(camera, film.yx()),
    },
    Mistake {
        cause: &camera::FILM_NOT_CENTRED,
        formula: |camera, film| projection(camera, 0.5 * film + 0.5),
    },
    Mistake {
        cause: &camera::HALF_PIXEL_TWICE,
        formula: |camera, film| {
            let pixel = DVec2::new(f64::from(camera.film[0]), f64::from(camera.film[1])).recip();
            projection(camera, film + 0.5 * pixel)
        },
    },
    Mistake {
        cause: &camera::LOOKS_ALONG_PLUS_Z,
        formula: |camera, film| {
            camera.camera_to_world * (centred(film) * half_sensor(camera)).extend(1.0)
        },
    },
    Mistake {
        cause: &camera::CAMERA_TO_WORLD_TRANSPOSED,
        formula: |camera, film| {
            let transposed = camera.camera_to_world.transpose();
            projection(&Camera { camera_to_world: transposed, ..*camera }, film)
        },
    },
    Mistake {
        cause: &camera::CAMERA_TO_WORLD_FORGOTTEN,
        formula: |camera, film| {
            projection(&Camera { camera_to_world: DMat3::IDENTITY, ..*camera }, film)
        },
    },
    Mistake {
        cause: &camera::POSITION_ADDED_TO_DIRECTION,
        formula: |camera, film| projection(camera, film) + camera.position,
    },
];
