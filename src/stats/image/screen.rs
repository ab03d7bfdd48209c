//! Screen and confirm: the only way a picture can fail.
//!
//! A few runs are screened at five scales, from the pixel to the whole picture. If no cell stands
//! out, that was all. Otherwise the most extreme cells of each scale are frozen, with their signs
//! and weights, and confirmed twice on fresh runs: one number a run, one degree of freedom. The
//! price of having looked at a hundred thousand cells is paid by that split of the data, not by a
//! threshold of seven standard errors for every pixel.
//!
//! The noise of the reference is the same in every stage, so it is no fresh noise: it widens the
//! band. The spread is the core's own, between its runs: another estimator has another variance,
//! and neighbouring pixels may hang together as they like.
//!
//! A cell stands out by its own spread and by what is known of its noise ([`super::cell_noise`]):
//! sixteen runs that all miss rare light have hardly any spread. What is too dark is confirmed by both, too; where only
//! its own spread rejects it, light may have been missed, and the picture is left open.
//!
//! 16 runs of n samples rather than 8 of 2n cost the same and see errors in single pixels a third
//! as large: Student's t at a level of 2·10⁻⁹ is 35 with 7 degrees of freedom and 12 with 15.
//!
//! Not here: 8-bit pictures, whose codes follow another law.

use super::cells::Cells;
use super::draw::{ImageDraw, ImageEffort, Levels};
use super::screening::Screening;
use super::target::Target;
use crate::image::Image;
use crate::stats::{ImageReport, Stage};

/// What a picture should be, and how well that is known.
#[derive(Clone, Copy, Debug)]
pub struct Reference<'a> {
    /// Mean radiance.
    pub mean: &'a Image,
    /// Standard error of that mean; the noise of its pixels is independent.
    pub standard_error: &'a Image,
}

/// Judges the pictures that `draw` renders against a reference of the same size.
///
/// # Panics
///
/// If a picture has another size than the reference.
pub fn judge_image<E>(
    reference: Reference<'_>,
    effort: &ImageEffort,
    draw: &mut dyn FnMut(ImageDraw) -> Result<Image, E>,
) -> Result<ImageReport, E> {
    judge_image_at(Levels::DEFAULT, reference, effort, draw)
}

/// The same at other levels, so that calibration can be simulated.
pub(super) fn judge_image_at<E>(
    levels: Levels,
    reference: Reference<'_>,
    effort: &ImageEffort,
    draw: &mut dyn FnMut(ImageDraw) -> Result<Image, E>,
) -> Result<ImageReport, E> {
    assert!(reference.mean.same_size(reference.standard_error), "mean and error of one size");
    let cells = Cells::new(reference.mean);
    let expected = cells.values(reference.mean);
    let errors = cells.standard_errors(reference.standard_error);
    let target = Target::new(cells, expected.clone(), expected, &errors);
    let mut one = |request| draw(request).map(|image| vec![image]);
    Screening::new(target, reference.mean, effort, &mut one).at(levels).judge()
}

/// Judges whether two cores, or two ways to render, have the same mean picture. `draw` renders
/// both, each with a seed of its own. A run of [`Stage::Pilot`] comes first; it only shows how
/// bright the cells are.
///
/// # Panics
///
/// If pictures differ in size.
pub fn judge_image_pair<E>(
    effort: &ImageEffort,
    draw: &mut dyn FnMut(ImageDraw) -> Result<[Image; 2], E>,
) -> Result<ImageReport, E> {
    let [left, right] = draw(ImageDraw { stage: Stage::Pilot, run: 0 })?;
    let guide = average(&left, &right);
    let cells = Cells::new(&guide);
    let scale = cells.values(&guide);
    let nothing = vec![0.0; scale.len()];
    let target = Target::new(cells, nothing.clone(), scale, &nothing);
    let mut both = |request| draw(request).map(Vec::from);
    Screening::new(target, &guide, effort, &mut both).judge()
}

fn average(left: &Image, right: &Image) -> Image {
    assert!(left.same_size(right), "two pictures of one size");
    let middle = |(a, b): (&[f32; 3], &[f32; 3])| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
    let pixels = left.pixels.iter().zip(&right.pixels).map(middle).collect();
    Image { pixels, ..*left }
}

#[cfg(test)]
mod tests;
