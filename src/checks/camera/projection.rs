//! The projection formula, and the wrong formulas that people write instead.

use crate::scene::Camera;
use glam::{DMat3, DVec2, DVec3, Vec2Swizzles};

/// A direction of any length through a film point.
pub type Formula = fn(&Camera, DVec2) -> DVec3;

/// The right formula, as [`Camera`] states it: a sensor at distance 1 in front of the pinhole.
pub fn projection(camera: &Camera, film: DVec2) -> DVec3 {
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
pub struct Mistake {
    /// What was done, after a colon.
    pub words: &'static str,
    /// The rays it makes.
    pub formula: Formula,
}

/// Each predicts other rays than the rest for a camera in general position, so that the one which predicts all
/// rays of all cameras is the one that was made.
pub const MISTAKES: &[Mistake] = &[
    Mistake {
        words: "the sensor is tan(fov) wide on each side, not tan(fov/2)",
        formula: |camera, film| projection(&with_fov(camera, |fov| 2.0 * fov), film),
    },
    Mistake {
        words: "the field of view is in radians and was converted from degrees once more",
        formula: |camera, film| projection(&with_fov(camera, f64::to_radians), film),
    },
    Mistake {
        words: "the field of view was converted to degrees before its tangent was taken",
        formula: |camera, film| projection(&with_fov(camera, f64::to_degrees), film),
    },
    Mistake {
        words: "the angle fov/2 stands where its tangent belongs",
        formula: |camera, film| {
            let half = DVec2::new(camera.horizontal_fov, camera.vertical_fov) / 2.0;
            camera.camera_to_world * (centred(film) * half).extend(-1.0)
        },
    },
    Mistake {
        words: "the sensor is half as large as it should be: it spans ±tan(fov/2)/2",
        formula: |camera, film| {
            camera.camera_to_world * (0.5 * centred(film) * half_sensor(camera)).extend(-1.0)
        },
    },
    Mistake {
        words: "horizontal and vertical field of view are swapped",
        formula: |camera, film| {
            camera.camera_to_world * (centred(film) * half_sensor(camera).yx()).extend(-1.0)
        },
    },
    Mistake {
        words: "the horizontal field of view is used in both directions",
        formula: |camera, film| {
            camera.camera_to_world * (centred(film) * half_sensor(camera).xx()).extend(-1.0)
        },
    },
    Mistake {
        words: "the film's y axis points down",
        formula: |camera, film| projection(camera, DVec2::new(film.x, 1.0 - film.y)),
    },
    Mistake {
        words: "the film's x axis points left",
        formula: |camera, film| projection(camera, DVec2::new(1.0 - film.x, film.y)),
    },
    Mistake {
        words: "the film's x and y are swapped",
        formula: |camera, film| projection(camera, film.yx()),
    },
    Mistake {
        words: "the film is not centred: (0, 0) looks straight ahead",
        formula: |camera, film| projection(camera, 0.5 * film + 0.5),
    },
    Mistake {
        words: "half a pixel is added to film points that already are exact",
        formula: |camera, film| {
            let pixel = DVec2::new(f64::from(camera.film[0]), f64::from(camera.film[1])).recip();
            projection(camera, film + 0.5 * pixel)
        },
    },
    Mistake {
        words: "the camera looks along its +z axis, not −z",
        formula: |camera, film| {
            camera.camera_to_world * (centred(film) * half_sensor(camera)).extend(1.0)
        },
    },
    Mistake {
        words: "camera_to_world is transposed",
        formula: |camera, film| {
            let transposed = camera.camera_to_world.transpose();
            projection(&Camera { camera_to_world: transposed, ..*camera }, film)
        },
    },
    Mistake {
        words: "camera_to_world is not applied",
        formula: |camera, film| {
            projection(&Camera { camera_to_world: DMat3::IDENTITY, ..*camera }, film)
        },
    },
    Mistake {
        words: "the camera's position is added to the direction, as if it were a point",
        formula: |camera, film| projection(camera, film) + camera.position,
    },
];
