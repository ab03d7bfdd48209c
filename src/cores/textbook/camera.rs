//! Part 1: from a point on the film to a ray through the world.

use crate::contract::Ray;
use crate::scene::Camera;
use glam::{DVec2, DVec3};

/// The ray of `camera` through `film` ((0, 0) bottom left, (1, 1) top right).
///
/// The sensor stands at distance 1 before the pinhole; the camera looks along its own −z.
pub fn generate_ray(camera: &Camera, film: DVec2) -> Ray {
    let direction = camera.camera_to_world * sensor_point(camera, film);
    Ray {
        origin: camera.position,
        t_min: camera.near,
        direction: direction.normalize(),
        t_max: camera.far,
    }
}

/// Where `film` lies on the sensor, in camera space.
fn sensor_point(camera: &Camera, film: DVec2) -> DVec3 {
    let half_width = (camera.horizontal_fov / 2.0).tan();
    let half_height = (camera.vertical_fov / 2.0).tan();
    DVec3::new((2.0 * film.x - 1.0) * half_width, (2.0 * film.y - 1.0) * half_height, -1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        let (position, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 0.5, 1.0));
        Camera::look_at(position, target, DVec3::Y, 50.0_f64.to_radians(), [20, 14])
    }

    #[test]
    fn the_centre_of_the_film_looks_at_the_target() {
        let ray = generate_ray(&camera(), DVec2::splat(0.5));
        let towards = (DVec3::new(-2.0, 0.5, 1.0) - ray.origin).normalize();
        assert!(ray.direction.abs_diff_eq(towards, 1e-15), "{ray:?}");
    }

    #[test]
    fn a_corner_of_the_film_is_half_a_field_of_view_away_on_both_axes() {
        let camera = camera();
        let ray = generate_ray(&camera, DVec2::new(1.0, 0.0));
        let local = camera.camera_to_world.transpose() * ray.direction;
        let (right, down) = ((local.x / -local.z).atan(), (-local.y / -local.z).atan());
        assert!((right - camera.horizontal_fov / 2.0).abs() < 1e-14, "{right}");
        assert!((down - camera.vertical_fov / 2.0).abs() < 1e-14, "{down}");
    }

    #[test]
    fn rays_are_unit_and_run_between_the_clip_distances() {
        let camera = Camera { near: 0.25, far: 40.0, ..camera() };
        let ray = generate_ray(&camera, DVec2::new(0.1, 0.9));
        assert!((ray.direction.length() - 1.0).abs() < 1e-15);
        assert_eq!((ray.t_min, ray.t_max), (0.25, 40.0));
    }
}
