//! From film points to rays, and from samples to pixels: where the samples of a pixel lie, where pixels stand, what
//! becomes of their sum.

mod constant_film;
#[cfg(test)]
pub(in crate::checks) mod fake;
mod film_mistakes;
mod orientation;
mod pattern;
mod pixel_laws;
mod pixel_samples;
mod projection;
mod rays_through_film;
mod strata_pattern;
mod stratified_samples;
mod view_coverage;

pub use constant_film::ConstantFilm;
pub use orientation::PictureOrientation;
pub use pixel_samples::PixelSamples;
pub(in crate::checks) use projection::projection;
pub use rays_through_film::RaysThroughFilm;
pub use stratified_samples::StratifiedSamples;
pub use view_coverage::ViewCoverage;
