//! Rays through film points.

use crate::contract::Ray;
use crate::scene::Camera;
use glam::{DVec2, dvec3};

/// A camera with its film's half sizes at distance 1 worked out.
pub(crate) struct Pinhole {
    camera: Camera,
    half_size: DVec2,
}

impl Pinhole {
    pub(crate) fn new(camera: &Camera) -> Self {
        let half_size =
            DVec2::new((camera.horizontal_fov / 2.0).tan(), (camera.vertical_fov / 2.0).tan());
        Self { camera: *camera, half_size }
    }

    /// The ray through `film`, a point of [0, 1]² with (0, 0) bottom left.
    pub(crate) fn ray(&self, film: DVec2) -> Ray {
        let on_sensor = (2.0 * film - 1.0) * self.half_size;
        let direction = self.camera.camera_to_world * dvec3(on_sensor.x, on_sensor.y, -1.0);
        Ray {
            origin: self.camera.position,
            direction: direction.normalize(),
            t_min: self.camera.near,
            t_max: self.camera.far,
        }
    }

    /// The ray through the point `jitter` ∈ [0, 1)² of a pixel: column `x`, row `y` counted from the top.
    pub(crate) fn ray_through_pixel(
        &self,
        [x, y]: [u32; 2],
        [width, height]: [u32; 2],
        jitter: DVec2,
    ) -> Ray {
        let column = (f64::from(x) + jitter.x) / f64::from(width);
        let row = (f64::from(y) + jitter.y) / f64::from(height);
        self.ray(DVec2::new(column, 1.0 - row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn pinhole() -> Pinhole {
        let position = dvec3(1.0, -2.0, 0.5);
        let camera = Camera::look_at(
            position,
            dvec3(3.0, 1.0, 2.0),
            DVec3::Z,
            50_f64.to_radians(),
            [20, 14],
        );
        Pinhole::new(&camera)
    }

    #[test]
    fn row_zero_is_the_top_of_the_film() {
        let pinhole = pinhole();
        let top_left = pinhole.ray_through_pixel([0, 0], [20, 14], DVec2::ZERO);
        assert_eq!(top_left, pinhole.ray(DVec2::new(0.0, 1.0)));
    }
}
