//! From film points to rays, and from samples to pixels: where the samples of a pixel lie, where pixels stand, what
//! becomes of their sum.

mod constant_film;
mod exposed;
#[cfg(test)]
pub(in crate::checks) mod fake;
mod film_law;
mod film_mistakes;
mod orientation;
mod painting;
mod pattern;
mod pixel_laws;
mod pixel_samples;
mod projection;
mod rays_through_film;
mod shots;
mod strata;
mod strata_pattern;
mod stratified_samples;
mod view_coverage;

pub(in crate::checks) use projection::projection;

use super::checks;

checks! {
    rays_through_film::RaysThroughFilm,
    constant_film::ConstantFilm,
    orientation::PictureOrientation,
    pixel_samples::PixelSamples,
    stratified_samples::StratifiedSamples,
    view_coverage::ViewCoverage,
}
