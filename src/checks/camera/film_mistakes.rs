//! What becomes of a constant radiance in a film that is developed wrongly.

use crate::cause::{Cause, image};

/// A pixel of a film that should hold the same radiance everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Column and row, from the top left.
    pub(crate) at: [u32; 2],
    /// Columns and rows of the film.
    pub(crate) size: [u32; 2],
    /// Camera rays per pixel.
    pub(crate) samples: u32,
}

/// A mistake and what it writes where `radiance` belongs.
pub(crate) struct FilmMistake {
    pub(crate) cause: &'static Cause,
    pub(crate) develop: fn([f64; 3], Place) -> [f64; 3],
}

/// Edges of the tiles that people cut pictures into.
pub(crate) const TILES: [u32; 6] = [64, 32, 16, 8, 4, 2];

const fn mistake(cause: &'static Cause, develop: fn([f64; 3], Place) -> [f64; 3]) -> FilmMistake {
    FilmMistake { cause, develop }
}

/// Multiplied by a factor that depends on the number of samples.
fn scaled(radiance: [f64; 3], place: Place, factor: fn(f64) -> f64) -> [f64; 3] {
    radiance.map(|value| factor(f64::from(place.samples)) * value)
}

/// What a film holds if `develop` loses all that is outside `is_inside`.
fn only(radiance: [f64; 3], is_inside: bool) -> [f64; 3] {
    if is_inside { radiance } else { [0.0; 3] }
}

/// Every mistake but those with a size of their own ([`TILES`]).
pub(crate) const MISTAKES: &[FilmMistake] = &[
    mistake(&image::NOT_DIVIDED, |radiance, place| scaled(radiance, place, |n| n)),
    mistake(&image::DIVIDED_TWICE, |radiance, place| scaled(radiance, place, f64::recip)),
    mistake(&image::DIVIDED_BY_ONE_MORE, |radiance, place| {
        scaled(radiance, place, |n| n / (n + 1.0))
    }),
    mistake(&image::DIVIDED_BY_ONE_MORE, |radiance, place| {
        scaled(radiance, place, |n| (n - 1.0) / n)
    }),
    mistake(&image::ONE_SAMPLE_TOO_MANY, |radiance, place| {
        scaled(radiance, place, |n| (n + 1.0) / n)
    }),
    mistake(&image::CLAMPED, |radiance, _| radiance.map(|value| value.min(1.0))),
    mistake(&image::GAMMA_TWICE, |radiance, _| radiance.map(|value| value.powf(1.0 / 2.2))),
    mistake(&image::GAMMA_TWICE, |radiance, _| {
        radiance.map(|value| value.min(1.0).powf(1.0 / 2.2))
    }),
    mistake(&image::CHANNELS_SWAPPED, |[red, green, blue], _| [blue, green, red]),
    mistake(&image::BORDER_LEFT_OUT, |radiance, Place { at, size, .. }| {
        only(radiance, at[0] + 1 < size[0] && at[1] + 1 < size[1])
    }),
    mistake(&image::BORDER_LEFT_OUT, |radiance, Place { at, .. }| {
        only(radiance, at[0] > 0 && at[1] > 0)
    }),
];

/// What a film holds if only whole tiles of this edge are rendered.
pub(crate) fn whole_tiles_only(
    radiance: [f64; 3],
    Place { at, size, .. }: Place,
    tile: u32,
) -> [f64; 3] {
    let is_whole = |axis: usize| at[axis] / tile < size[axis] / tile;
    only(radiance, is_whole(0) && is_whole(1))
}
