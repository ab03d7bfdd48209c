//! Part 1: from a point on the film to a ray through the world.

use super::steps::Steps;
use crate::contract::Ray;
use crate::scene::Camera;
use glam::{DVec2, DVec3};

/// The ray of `camera` through `film` ((0, 0) bottom left, (1, 1) top right).
pub(crate) fn generate_ray(camera: &Camera, film: DVec2, steps: &Steps) -> Ray {
    let half_size =
        steps.fields_of_view(camera).map(|field_of_view| steps.half_size(field_of_view));
    let sensor = steps.sensor_point(camera, film, half_size.into());
    let direction = steps.unit(steps.turned_to_world(camera, sensor));
    let (t_min, t_max) = steps.clip_distances(camera, direction);
    Ray { origin: camera.position, t_min, direction, t_max }
}

/// Of the width and of the height of the film.
pub(crate) fn fields_of_view(camera: &Camera) -> [f64; 2] {
    [camera.horizontal_fov, camera.vertical_fov]
}

/// Half the width or height of a sensor at distance 1.
pub(crate) fn half_size(field_of_view: f64) -> f64 {
    (field_of_view / 2.0).tan()
}

/// Where a point of the film lies on the sensor, in camera space. The sensor stands at distance 1
/// before the pinhole; the camera looks along its own −z.
pub(crate) fn sensor_point(_camera: &Camera, film: DVec2, half_size: DVec2) -> DVec3 {
    ((2.0 * film - 1.0) * half_size).extend(-1.0)
}

/// A direction of camera space, in the world.
pub(crate) fn turned_to_world(camera: &Camera, direction: DVec3) -> DVec3 {
    camera.camera_to_world * direction
}

/// Directions of camera rays have length 1: t is a distance.
pub(crate) fn unit(direction: DVec3) -> DVec3 {
    direction.normalize()
}

/// What lies before the near or behind the far clip distance is not seen.
pub(crate) fn clip_distances(camera: &Camera, _direction: DVec3) -> (f64, f64) {
    (camera.near, camera.far)
}
