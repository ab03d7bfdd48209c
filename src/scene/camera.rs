//! The pinhole camera: no thin lens, so no depth of field.

use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A pinhole camera. A film point (x, y) of [0, 1]² looks along
/// `camera_to_world · ((2x − 1) tan(h/2), (2y − 1) tan(v/2), −1)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Camera {
    /// The pinhole, world space.
    pub position: DVec3,
    /// Columns: right, up, backward. A rotation.
    pub camera_to_world: DMat3,
    /// Whole angle from the left to the right edge, radians.
    pub horizontal_fov: f64,
    /// Whole angle from the bottom to the top edge, radians.
    pub vertical_fov: f64,
    /// Rays start at this distance (their `t_min`).
    pub near: f64,
    /// Rays end at this distance (their `t_max`).
    pub far: f64,
    /// Pixels in a row and rows, where a case does not say otherwise.
    pub film: [u32; 2],
}

impl Camera {
    /// A camera at `position` that looks at `target` with `up` upwards in the image; the vertical field of
    /// view follows from square pixels.
    pub fn look_at(
        position: DVec3,
        target: DVec3,
        up: DVec3,
        horizontal_fov: f64,
        film: [u32; 2],
    ) -> Self {
        let backward = (position - target).normalize();
        let right = up.cross(backward).normalize();
        Self {
            position,
            camera_to_world: DMat3::from_cols(right, backward.cross(right), backward),
            horizontal_fov,
            vertical_fov: of_square_pixels(horizontal_fov, film),
            near: 1e-3,
            far: 1e6,
            film,
        }
    }

    /// The same with a film of another size: as wide, with square pixels if they were square.
    pub(crate) fn with_film(self, film: [u32; 2]) -> Self {
        let vertical_fov = match self.has_square_pixels() {
            true => of_square_pixels(self.horizontal_fov, film),
            false => self.vertical_fov,
        };
        Self { film, vertical_fov, ..self }
    }

    /// The film points at the centres of the pixels, row by row from the top.
    pub(crate) fn pixel_centres(&self) -> impl Iterator<Item = DVec2> {
        let [width, height] = self.film;
        let centre = move |x: u32, y: u32| {
            let from_top = (f64::from(y) + 0.5) / f64::from(height);
            DVec2::new((f64::from(x) + 0.5) / f64::from(width), 1.0 - from_top)
        };
        (0..height).flat_map(move |y| (0..width).map(move |x| centre(x, y)))
    }

    /// The unit direction through a film point.
    pub(crate) fn towards(&self, film: DVec2) -> DVec3 {
        let half_sensor =
            DVec2::new((self.horizontal_fov / 2.0).tan(), (self.vertical_fov / 2.0).tan());
        let sensor = (2.0 * film - 1.0) * half_sensor;
        (self.camera_to_world * sensor.extend(-1.0)).normalize()
    }

    /// Whether the pixels of `film` are as high as they are wide.
    pub(crate) fn has_square_pixels(&self) -> bool {
        let [width, height] = self.film.map(f64::from);
        let ratio = (self.vertical_fov / 2.0).tan() / (self.horizontal_fov / 2.0).tan();
        (ratio * width / height - 1.0).abs() < 1e-9
    }
}

/// The vertical field of view of a film whose pixels are as high as they are wide.
fn of_square_pixels(horizontal_fov: f64, film: [u32; 2]) -> f64 {
    let aspect = f64::from(film[1]) / f64::from(film[0]);
    2.0 * ((horizontal_fov / 2.0).tan() * aspect).atan()
}
