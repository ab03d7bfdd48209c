//! From the EXR files of a run to PNG pictures that stand in the page itself, small enough for it to stay light.

use crate::checks::PictureRole;
use crate::image::Image;
use crate::image::heatmap::{Scale, heatmap};
use crate::image::png::{self, Picture};
use crate::image::tonemap::{exposure_of, tonemap};
use crate::report::tree::RunTree;
use crate::run::TrialRecord;
use crate::run::record::PictureFile;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// What the pictures of a page may weigh together, bytes.
const PAGE_WEIGHT: f64 = 2.2e6;
/// Bytes a pixel in the page, base64 included, of a noisy render and of false colour.
const PHOTOGRAPH_WEIGHT: f64 = 2.8;
const CHART_WEIGHT: f64 = 1.1;
/// Pictures of failures are never made smaller than this, pixels.
const FAILURE_SIDE: usize = 256;
/// Steps between the middle and the end of a colour scale: no eye tells more apart, and the page is half as heavy.
const COLOUR_STEPS: f64 = 24.0;

/// How the pictures of one viewer are developed: all alike, so that they can be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// Brightening of radiance, powers of two.
    pub(crate) stops: f32,
    /// The longest side, pixels; what is larger is made smaller.
    pub(crate) side: usize,
}

impl Look {
    /// The exposure of `picture`, in half stops, so that pictures of about the same brightness are shown alike.
    pub(crate) fn for_picture(picture: Option<&Image>, side: usize) -> Self {
        let stops = picture.map_or(0.0, exposure_of);
        Self { stops: (stops * 2.0).floor() / 2.0, side }
    }

    /// The picture as an address that holds all of it. Fails if the picture is empty.
    pub(crate) fn address(self, image: &Image, role: PictureRole) -> Result<String, String> {
        let small = image.shrunk_to(self.side);
        let picture = match scale(role) {
            None => tonemap(&small, self.stops),
            Some(scale) => false_colour(&small, scale),
        };
        let file = png::encode(&picture).map_err(|error| error.to_string())?;
        Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(file)))
    }
}

/// The colours of a picture that does not show radiance.
pub(crate) const fn scale(role: PictureRole) -> Option<Scale> {
    match role {
        PictureRole::Reference | PictureRole::Render => None,
        PictureRole::SignedError => Some(Scale::Signed { limit: 1.0 }),
        PictureRole::SampleRate => Some(Scale::Magnitude { limit: 1.0 }),
    }
}

/// A CSS background that runs through a scale.
pub(crate) fn gradient(scale: Scale) -> String {
    let lowest = match scale {
        Scale::Signed { limit } => -limit,
        Scale::Magnitude { .. } => 0.0,
    };
    let colour = |step: u32| {
        let value = lowest + (scale.limit() - lowest) * f64::from(step) / 8.0;
        let [red, green, blue] = scale.colour(value);
        format!("rgb({red},{green},{blue})")
    };
    let colours: Vec<_> = (0..=8).map(colour).collect();
    format!("background:linear-gradient(90deg,{})", colours.join(","))
}

/// Of a pixel's channels the one farthest from zero, so that errors of opposite sign do not hide
/// each other; NaN is farthest.
fn false_colour(image: &Image, scale: Scale) -> Picture {
    let farther = |a: f64, b: f64| if a.is_nan() || a.abs() >= b.abs() { a } else { b };
    let value = |pixel: &[f32; 3]| pixel.map(f64::from).into_iter().fold(0.0, farther);
    let rounded = |pixel| (value(pixel) * COLOUR_STEPS).round() / COLOUR_STEPS;
    let values: Vec<_> = image.pixels.iter().map(rounded).collect();
    heatmap(&values, image.width, scale, 1)
}

/// The side to which the pictures of a case are made smaller, so that all of the run's fit the page.
pub(crate) fn longest_side(tree: &RunTree, case_failed: bool) -> usize {
    let weight: f64 = tree.trials.iter().map(|trial| weight(tree, trial)).sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let side = (PAGE_WEIGHT / weight).sqrt().clamp(64.0, 512.0) as usize;
    if case_failed { side.max(FAILURE_SIDE) } else { side }
}

/// Bytes for each pixel that the pictures of a trial add to the page. Equal references stand there once.
fn weight(tree: &RunTree, trial: &TrialRecord) -> f64 {
    let is_first = tree.run.cores.first().is_some_and(|core| core.spec == trial.core);
    let of_picture = |file: &PictureFile| match file.role {
        PictureRole::Reference if !is_first => 0.0,
        PictureRole::Reference | PictureRole::Render => PHOTOGRAPH_WEIGHT,
        PictureRole::SignedError | PictureRole::SampleRate => CHART_WEIGHT,
    };
    trial.pictures.iter().map(of_picture).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example::Example;

    #[test]
    fn errors_of_opposite_sign_do_not_hide_each_other() {
        let scale = Scale::Signed { limit: 1.0 };
        let shown = |colour| false_colour(&Image::new(1, 1, colour), scale).pixels[0];
        assert_eq!(shown([0.5, -1.0, 0.5]), scale.colour(-1.0));
        assert_eq!(shown([0.5, f32::NAN, -1.0]), scale.colour(f64::NAN));
    }

    #[test]
    fn a_legend_runs_from_end_to_end() {
        let scale = Scale::Signed { limit: 2.0 };
        let [[r, g, b], [x, y, z]] = [-2.0, 2.0].map(|value| scale.colour(value));
        let gradient = gradient(scale);
        assert!(gradient.contains(&format!("90deg,rgb({r},{g},{b})")), "{gradient}");
        assert!(gradient.ends_with(&format!("rgb({x},{y},{z}))")), "{gradient}");
    }

    #[test]
    fn more_pictures_are_smaller_pictures_but_not_those_of_failures() {
        let (few, many) = (Example::green().tree(), Example::of_default_size().tree());
        assert!(longest_side(&many, false) < longest_side(&few, false));
        assert!(longest_side(&many, true) >= FAILURE_SIDE);
    }

    #[test]
    fn exposures_are_half_stops_and_none_without_a_picture() {
        let dim = Image::new(4, 4, [0.013; 3]);
        let doubled = f64::from(Look::for_picture(Some(&dim), 64).stops) * 2.0;
        assert!(doubled > 0.0 && doubled.fract() == 0.0, "{doubled}");
        assert_eq!(Look::for_picture(None, 64), Look { stops: 0.0, side: 64 });
    }
}
