//! Where the course's program takes its images from without a window. The position in the file
//! plays no part: only the direction does, and the box around the scene.

use super::xml::{Instance, Reader, Result};
use crate::scene::{Aabb, Camera};
use glam::{DMat3, DVec3, DVec4};
use std::f64::consts::PI;

/// The size of the window that the field of view is fitted to.
const WINDOW: [f64; 2] = [800.0, 600.0];

/// A small angle that keeps the camera off the vertical: the course's `EPS_F`.
const OFF_VERTICAL: f64 = 0.00001_f32 as f64;

/// The camera of the file, as the course keeps it: degrees, in single precision.
pub(super) struct Lens {
    horizontal_fov: f32,
    vertical_fov: f32,
    near: f32,
    far: f32,
    /// Unit, from the scene towards the camera.
    towards_camera: DVec3,
}

impl Default for Lens {
    /// What there is in a file without camera.
    fn default() -> Self {
        Self {
            horizontal_fov: 50.0,
            vertical_fov: 35.0,
            near: 0.01,
            far: 100.0,
            towards_camera: DVec3::ZERO,
        }
    }
}

impl Lens {
    /// Reads a `camera` that stands in the scene with `transform`.
    pub(super) fn read<'a>(reader: &Reader<'a>, instance: &Instance<'a>) -> Result<Self> {
        let (camera, transform) = (instance.element, instance.transform);
        reader.name_of(camera)?;
        let perspective = reader.need(camera, "optics/technique_common/perspective")?;
        let number = |name, otherwise| match reader.find(perspective, name)? {
            Some(element) => reader.narrowed(element),
            None => Ok(otherwise),
        };
        let horizontal_fov = number("xfov", 50.0)?;
        let vertical_fov = match reader.find(perspective, "yfov")? {
            Some(element) => reader.narrowed(element)?,
            None => {
                let aspect = reader.narrowed(reader.need(perspective, "aspect_ratio")?)?;
                let half = radians(0.5 * f64::from(horizontal_fov));
                single(2.0 * degrees((half.tan() / f64::from(aspect)).atan()))
            }
        };
        let towards_camera = (transform * DVec4::new(0.0, 0.0, -1.0, 1.0)).truncate();
        let lens = Self {
            horizontal_fov,
            vertical_fov,
            near: number("znear", 0.001)?,
            far: number("zfar", 1000.0)?,
            towards_camera: towards_camera * towards_camera.length_recip(),
        };
        lens.check().map_err(|complaint| reader.wrong(camera, complaint))?;
        Ok(lens)
    }

    fn check(&self) -> std::result::Result<(), String> {
        let Self { horizontal_fov, vertical_fov, near, far, .. } = self;
        let is_angle = |fov: &&f32| **fov > 0.0 && **fov < 180.0;
        if let Some(fov) = [horizontal_fov, vertical_fov].into_iter().find(|fov| !is_angle(fov)) {
            return Err(format!(
                "invalid field of view of {fov} degrees: must be between 0 and 180"
            ));
        }
        if !(*near >= 0.0 && near < far) {
            return Err(format!("invalid clip distances {near} and {far}: near must be below far"));
        }
        if !self.towards_camera.is_finite() {
            return Err(
                "has no view direction: its matrix maps (0, 0, -1) to the origin".to_owned()
            );
        }
        Ok(())
    }

    /// The camera for an image of `film` pixels of a scene within `bounds`.
    pub(super) fn place(&self, bounds: &Aabb, film: [u32; 2]) -> Camera {
        let distance = self.screen_distance();
        let angle =
            |pixels: u32| radians(2.0 * degrees((f64::from(pixels) / (2.0 * distance)).atan()));
        let offset = self.camera_offset((bounds.max - bounds.min).length() / 2.0 * 1.5);
        Camera {
            position: (bounds.min + bounds.max) * 0.5 + offset,
            camera_to_world: axes(offset),
            horizontal_fov: angle(film[0]),
            vertical_fov: angle(film[1]),
            near: f64::from(self.near),
            far: f64::from(self.far),
            film,
        }
    }

    /// Pixels from the pinhole to the image. It is fitted once, to the window; another size of
    /// image leaves it alone, and so crops.
    fn screen_distance(&self) -> f64 {
        let half = |degrees: f32| (radians(f64::from(degrees)) / 2.0).tan();
        let (horizontal, vertical) = (half(self.horizontal_fov), half(self.vertical_fov));
        let aspect = WINDOW[0] / WINDOW[1];
        let mut vertical_fov = f64::from(self.vertical_fov);
        if horizontal / vertical > aspect {
            vertical_fov = 2.0 * degrees((horizontal / aspect).atan());
        }
        WINDOW[1] / (2.0 * (radians(vertical_fov) / 2.0).tan())
    }

    /// From the centre of the scene to the camera, by way of two angles, as the course does it.
    fn camera_offset(&self, half_view_distance: f64) -> DVec3 {
        let distance = half_view_distance * 2.0;
        let mut phi = self.towards_camera.y.acos();
        if phi.sin() == 0.0 {
            phi += OFF_VERTICAL;
        }
        let theta = self.towards_camera.x.atan2(self.towards_camera.z);
        let across = distance * phi.sin();
        DVec3::new(across * theta.sin(), distance * phi.cos(), across * theta.cos())
    }
}

/// Right, up and backward of a camera that stands `offset` away from what it looks at. The
/// angle to the vertical is never negative, so up is never down.
fn axes(offset: DVec3) -> DMat3 {
    let unit = |vector: DVec3| vector * vector.length_recip();
    let right = unit(DVec3::Y.cross(offset));
    DMat3::from_cols(right, unit(offset.cross(right)), unit(offset))
}

/// `f64::to_radians` multiplies by the same factor, but does not promise to.
pub(super) fn radians(degrees: f64) -> f64 {
    degrees * (PI / 180.0)
}

fn degrees(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

#[expect(clippy::cast_possible_truncation, reason = "meant: the course keeps these as floats")]
fn single(number: f64) -> f32 {
    number as f32
}
