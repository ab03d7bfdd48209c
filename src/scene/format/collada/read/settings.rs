//! The course's camera file, which its program saves on a key and reads with `-c`: plain numbers, which replace
//! whatever the scene's file says of the camera.

use super::camera::radians;
use crate::scene::error::read_source;
use crate::scene::{Camera, SceneError};
use crate::text::Source;
use glam::{DMat3, DVec3};
use std::path::Path;

const COUNT: usize = 30;

/// Reads a camera file for an image of `film` pixels.
///
/// # Errors
/// If the file cannot be read, or is not 30 finite numbers that make a camera.
pub(crate) fn load_camera(path: &Path, film: [u32; 2]) -> Result<Camera, SceneError> {
    parse(&read_source(path)?, film)
}

pub(super) fn parse(source: &Source, film: [u32; 2]) -> Result<Camera, SceneError> {
    let wrong = |message: String| source.diagnostic(0..source.text.len(), message);
    let words = source.text.split_whitespace();
    let numbers: Vec<f64> = words
        .map(|word| {
            let number = word.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| wrong(format!("`{word}` is not a number")))
        })
        .collect::<Result<_, _>>()?;
    if numbers.len() != COUNT {
        let found = numbers.len();
        return Err(wrong(format!("a camera file has {COUNT} numbers, not {found}")).into());
    }
    let at = |first: usize| DVec3::new(numbers[first], numbers[first + 1], numbers[first + 2]);
    let camera = Camera {
        position: at(5),
        camera_to_world: DMat3::from_cols(at(16), at(19), at(22)).transpose(),
        horizontal_fov: radians(numbers[0]),
        vertical_fov: radians(numbers[1]),
        near: numbers[3],
        far: numbers[4],
        film,
    };
    let is_camera = (0.0..180.0).contains(&numbers[0])
        && (0.0..180.0).contains(&numbers[1])
        && (camera.camera_to_world.determinant() - 1.0).abs() < 1e-3;
    match is_camera {
        true => Ok(camera),
        false => Err(wrong("these numbers do not describe a camera".to_owned()).into()),
    }
}

/// The angle in degrees from which the course makes an angle in radians, or the nearest: about one in ten has none.
pub(crate) fn degrees_for(angle: f64) -> f64 {
    let nearest = angle.to_degrees();
    let neighbours = [nearest, nearest.next_up(), nearest.next_down()];
    neighbours.into_iter().find(|degrees| radians(*degrees) == angle).unwrap_or(nearest)
}
