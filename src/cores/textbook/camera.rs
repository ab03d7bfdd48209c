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
    let (t_min, t_max) = steps.clip_distances(camera);
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
pub(crate) fn clip_distances(camera: &Camera) -> (f64, f64) {
    (camera.near, camera.far)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cores::textbook::steps::LESSON;

    fn camera() -> Camera {
        let (position, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 0.5, 1.0));
        Camera::look_at(position, target, DVec3::Y, 50.0_f64.to_radians(), [20, 14])
    }

    #[test]
    fn the_centre_of_the_film_looks_at_the_target() {
        let ray = generate_ray(&camera(), DVec2::splat(0.5), &LESSON);
        let towards = (DVec3::new(-2.0, 0.5, 1.0) - ray.origin).normalize();
        assert!(ray.direction.abs_diff_eq(towards, 1e-15), "{ray:?}");
    }

    #[test]
    fn a_corner_of_the_film_is_half_a_field_of_view_away_on_both_axes() {
        let camera = camera();
        let ray = generate_ray(&camera, DVec2::new(1.0, 0.0), &LESSON);
        let local = camera.camera_to_world.transpose() * ray.direction;
        let (right, down) = ((local.x / -local.z).atan(), (-local.y / -local.z).atan());
        assert!((right - camera.horizontal_fov / 2.0).abs() < 1e-14, "{right}");
        assert!((down - camera.vertical_fov / 2.0).abs() < 1e-14, "{down}");
    }

    #[test]
    fn rays_are_unit_and_run_between_the_clip_distances() {
        let camera = Camera { near: 0.25, far: 40.0, ..camera() };
        let ray = generate_ray(&camera, DVec2::new(0.1, 0.9), &LESSON);
        assert!((ray.direction.length() - 1.0).abs() < 1e-15);
        assert_eq!((ray.t_min, ray.t_max), (0.25, 40.0));
    }
}
