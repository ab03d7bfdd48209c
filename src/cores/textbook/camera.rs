//! Part 1: from a point on the film to a ray through the world.

use super::change::Change;
use crate::contract::Ray;
use crate::scene::Camera;
use glam::{DVec2, DVec3};

/// The ray of `camera` through `film` ((0, 0) bottom left, (1, 1) top right).
///
/// The sensor stands at distance 1 before the pinhole; the camera looks along its own −z.
pub fn generate_ray(camera: &Camera, film: DVec2, change: Change) -> Ray {
    let sensor = sensor_point(camera, film, change);
    let direction = match change {
        Change::CameraSpaceDirection => sensor,
        Change::CameraTransposed => camera.camera_to_world.transpose() * sensor,
        _ => camera.camera_to_world * sensor,
    };
    let direction = match change {
        Change::DirectionNotUnit => direction,
        _ => direction.normalize(),
    };
    let (t_min, t_max) = match change {
        Change::ClipsIgnored => (0.0, f64::INFINITY),
        _ => (camera.near, camera.far),
    };
    Ray { origin: camera.position, t_min, direction, t_max }
}

/// Where `film` lies on the sensor, in camera space.
fn sensor_point(camera: &Camera, film: DVec2, change: Change) -> DVec3 {
    let half_width = half_size(camera.horizontal_fov, change);
    let half_height = match change {
        Change::HorizontalFovForBoth => half_width,
        _ => half_size(camera.vertical_fov, change),
    };
    let film = match change {
        Change::FilmNotCentred => (film + 1.0) / 2.0,
        Change::FilmYDown => DVec2::new(film.x, 1.0 - film.y),
        Change::HalfPixelBothWays => film + half_pixel(camera.film),
        _ => film,
    };
    let depth = if change == Change::LooksAlongPlusZ { 1.0 } else { -1.0 };
    DVec3::new((2.0 * film.x - 1.0) * half_width, (2.0 * film.y - 1.0) * half_height, depth)
}

/// Half the width or height of the sensor.
fn half_size(field_of_view: f64, change: Change) -> f64 {
    match change {
        Change::FovNotHalved => field_of_view.tan(),
        Change::FovToDegrees => (field_of_view.to_degrees() / 2.0).tan(),
        Change::SensorHalfSize => (field_of_view / 2.0).tan() / 2.0,
        _ => (field_of_view / 2.0).tan(),
    }
}

/// Half a pixel of a film of this many.
pub fn half_pixel([width, height]: [u32; 2]) -> DVec2 {
    0.5 / DVec2::new(f64::from(width), f64::from(height))
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
        let ray = generate_ray(&camera(), DVec2::splat(0.5), Change::None);
        let towards = (DVec3::new(-2.0, 0.5, 1.0) - ray.origin).normalize();
        assert!(ray.direction.abs_diff_eq(towards, 1e-15), "{ray:?}");
    }

    #[test]
    fn a_corner_of_the_film_is_half_a_field_of_view_away_on_both_axes() {
        let camera = camera();
        let ray = generate_ray(&camera, DVec2::new(1.0, 0.0), Change::None);
        let local = camera.camera_to_world.transpose() * ray.direction;
        let (right, down) = ((local.x / -local.z).atan(), (-local.y / -local.z).atan());
        assert!((right - camera.horizontal_fov / 2.0).abs() < 1e-14, "{right}");
        assert!((down - camera.vertical_fov / 2.0).abs() < 1e-14, "{down}");
    }

    #[test]
    fn rays_are_unit_and_run_between_the_clip_distances() {
        let camera = Camera { near: 0.25, far: 40.0, ..camera() };
        let ray = generate_ray(&camera, DVec2::new(0.1, 0.9), Change::None);
        assert!((ray.direction.length() - 1.0).abs() < 1e-15);
        assert_eq!((ray.t_min, ray.t_max), (0.25, 40.0));
    }
}
