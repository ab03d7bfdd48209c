//! The projection formula, and the wrong steps that people put into it instead.

use crate::cause::{Cause, camera};
use crate::scene::Camera;
use glam::{DVec2, DVec3, Vec2Swizzles};

/// From a film point to a direction of any length, step by step.
#[derive(Clone, Copy)]
pub(crate) struct Projection {
    /// The film point that is used.
    film: fn(&Camera, DVec2) -> DVec2,
    fields_of_view: fn(&Camera) -> DVec2,
    /// Half the size of the sensor that a field of view makes.
    half_size: fn(f64) -> f64,
    /// Where the sensor stands on the z axis of the camera.
    sensor_z: f64,
    to_world: fn(&Camera, DVec3) -> DVec3,
}

impl Projection {
    /// The right one, as [`Camera`] states it: a sensor at distance 1 in front of the pinhole.
    pub(crate) const RIGHT: Self = Self {
        film: |_, film| film,
        fields_of_view: |camera| DVec2::new(camera.horizontal_fov, camera.vertical_fov),
        half_size: |field_of_view| (field_of_view / 2.0).tan(),
        sensor_z: -1.0,
        to_world: |camera, direction| camera.camera_to_world * direction,
    };

    pub(crate) fn direction(&self, camera: &Camera, film: DVec2) -> DVec3 {
        let half_sensor = (self.fields_of_view)(camera).map(self.half_size);
        let sensor = (2.0 * (self.film)(camera, film) - 1.0) * half_sensor;
        (self.to_world)(camera, sensor.extend(self.sensor_z))
    }
}

/// A direction of any length through a film point.
pub(crate) fn projection(camera: &Camera, film: DVec2) -> DVec3 {
    Projection::RIGHT.direction(camera, film)
}

/// A wrong step that people make.
pub(crate) struct Mistake {
    pub(crate) cause: &'static Cause,
    /// The same projection with it.
    pub(crate) made_in: fn(Projection) -> Projection,
}

const fn mistake(cause: &'static Cause, made_in: fn(Projection) -> Projection) -> Mistake {
    Mistake { cause, made_in }
}

/// Each predicts other rays than the rest for a camera in general position, so that the one which predicts all
/// rays of all cameras is the one that was made.
pub(crate) const MISTAKES: &[Mistake] = &[
    mistake(&camera::FOV_NOT_HALVED, |p| Projection { half_size: f64::tan, ..p }),
    mistake(&camera::FOV_TO_RADIANS_TWICE, |p| Projection {
        half_size: |fov| (fov.to_radians() / 2.0).tan(),
        ..p
    }),
    mistake(&camera::FOV_TO_DEGREES, |p| Projection {
        half_size: |fov| (fov.to_degrees() / 2.0).tan(),
        ..p
    }),
    mistake(&camera::FOV_WITHOUT_TANGENT, |p| Projection { half_size: |fov| fov / 2.0, ..p }),
    mistake(&camera::SENSOR_HALF_SIZE, |p| Projection {
        half_size: |fov| 0.5 * (fov / 2.0).tan(),
        ..p
    }),
    mistake(&camera::HALF_TANGENT, |p| Projection { half_size: |fov| fov.tan() / 2.0, ..p }),
    mistake(&camera::FOVS_SWAPPED, |p| Projection {
        fields_of_view: |camera| DVec2::new(camera.vertical_fov, camera.horizontal_fov),
        ..p
    }),
    mistake(&camera::HORIZONTAL_FOV_FOR_BOTH, |p| Projection {
        fields_of_view: |camera| DVec2::splat(camera.horizontal_fov),
        ..p
    }),
    mistake(&camera::FILM_Y_DOWN, |p| Projection {
        film: |_, film| DVec2::new(film.x, 1.0 - film.y),
        ..p
    }),
    mistake(&camera::FILM_X_LEFT, |p| Projection {
        film: |_, film| DVec2::new(1.0 - film.x, film.y),
        ..p
    }),
    mistake(&camera::FILM_TRANSPOSED, |p| Projection { film: |_, film| film.yx(), ..p }),
    mistake(&camera::FILM_NOT_CENTRED, |p| Projection { film: |_, film| 0.5 * film + 0.5, ..p }),
    // On a sensor of the right size: to the one side and to the other.
    mistake(&camera::FILM_NOT_CENTRED, |p| Projection { film: |_, film| film + 0.5, ..p }),
    mistake(&camera::FILM_NOT_CENTRED, |p| Projection { film: |_, film| film - 0.5, ..p }),
    mistake(&camera::HALF_PIXEL_TWICE, |p| Projection {
        film: |camera, film| film + 0.5 / DVec2::from(camera.film.map(f64::from)),
        ..p
    }),
    mistake(&camera::LOOKS_ALONG_PLUS_Z, |p| Projection { sensor_z: 1.0, ..p }),
    mistake(&camera::CAMERA_TO_WORLD_TRANSPOSED, |p| Projection {
        to_world: |camera, direction| camera.camera_to_world.transpose() * direction,
        ..p
    }),
    mistake(&camera::CAMERA_TO_WORLD_FORGOTTEN, |p| Projection {
        to_world: |_, direction| direction,
        ..p
    }),
    mistake(&camera::POSITION_ADDED_TO_DIRECTION, |p| Projection {
        to_world: |camera, direction| camera.camera_to_world * direction + camera.position,
        ..p
    }),
];
