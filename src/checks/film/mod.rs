//! Pictures as films: where the samples of a pixel lie, where pixels stand, what becomes of their
//! sum.

mod constant_film;
mod film_mistakes;
mod orientation;
mod pattern;
mod pixel_laws;
mod pixel_samples;
mod strata_pattern;
mod stratified_samples;
mod view_coverage;

pub use constant_film::ConstantFilm;
pub use orientation::PictureOrientation;
pub use pixel_samples::PixelSamples;
pub use stratified_samples::StratifiedSamples;
pub use view_coverage::ViewCoverage;

#[cfg(test)]
pub(in crate::checks) mod fake;
