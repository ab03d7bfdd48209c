//! `[camera]`

use super::Context;
use crate::scene::Camera;
use crate::text::{Angle, Between, Diagnostic, Direction, Positive, Spanned, Vector};
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::PI;

tables! {
    pub(super) struct Entry {
        /// The pinhole.
        position: Vector,
        /// A point in the middle of the image.
        look_at: Spanned<Vector>,
        /// Upwards in the image; y unless said otherwise.
        up: Option<Direction>,
        /// From the left edge of the image to the right one.
        horizontal_fov: Spanned<Angle>,
        /// Square pixels unless said otherwise.
        vertical_fov: Option<Spanned<Angle>>,
        /// Columns and rows of pixels.
        film: [Between<1, 65536>; 2],
        /// `t_min` of camera rays; 0.001 unless said otherwise.
        near: Option<Positive>,
        /// `t_max` of camera rays; a million unless said otherwise.
        far: Option<Positive>,
    }
}

impl Entry {
    pub(crate) fn resolve(self, context: &Context<'_>) -> Result<Camera, Diagnostic> {
        let up = self.up.map_or(DVec3::Y, |up| up.0);
        let target = self.look_at.get_ref().0;
        if (target - self.position.0).cross(up).try_normalize().is_none() {
            let problem = "invalid camera: `look-at` equals the position, or lies along `up`";
            return Err(context.wrong(self.look_at.span(), problem));
        }
        let horizontal_fov = field_of_view(&self.horizontal_fov, context)?;
        let film = self.film.map(|pixels| pixels.0);
        let mut camera = Camera::look_at(self.position.0, target, up, horizontal_fov, film);
        if let Some(vertical_fov) = &self.vertical_fov {
            camera.vertical_fov = field_of_view(vertical_fov, context)?;
        }
        camera.near = self.near.map_or(camera.near, |near| near.0);
        camera.far = self.far.map_or(camera.far, |far| far.0);
        Ok(camera)
    }
}

fn field_of_view(angle: &Spanned<Angle>, context: &Context<'_>) -> Result<f64, Diagnostic> {
    let Angle(radians) = *angle.get_ref();
    let is_valid = radians > 0.0 && radians < PI;
    is_valid.then_some(radians).ok_or_else(|| {
        context.wrong(angle.span(), "invalid field of view: must be between 0 and 180 deg")
    })
}
