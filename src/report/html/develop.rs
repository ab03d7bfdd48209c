//! From the EXR files of a run to PNG pictures that stand in the page itself, small enough for it to stay light.

use crate::checks::PictureRole;
use crate::image::Image;
use crate::image::heatmap::{Scale, heatmap};
use crate::image::png::{self, Picture};
use crate::image::tonemap::{exposure_of, tonemap};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;

/// The longest side of the pictures that are seen without scripts, pixels.
const SIDE: usize = 512;
/// Steps between the middle and the end of a colour scale: no eye tells more apart, and the page is half as heavy.
const COLOUR_STEPS: f64 = 24.0;

/// What an image of a viewer shows, and so how its values become colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Shows {
    Reference,
    Render,
    /// What an earlier run rendered.
    Earlier,
    SignedError,
    SampleRate,
    /// FLIP of every pixel, from 0 to 1.
    Flip,
}

impl From<PictureRole> for Shows {
    fn from(role: PictureRole) -> Self {
        match role {
            PictureRole::Reference => Self::Reference,
            PictureRole::Render => Self::Render,
            PictureRole::SignedError => Self::SignedError,
            PictureRole::SampleRate => Self::SampleRate,
        }
    }
}

impl Shows {
    /// The colours of what is not radiance.
    pub(crate) const fn scale(self) -> Option<Scale> {
        match self {
            Self::Reference | Self::Render | Self::Earlier => None,
            Self::SignedError => Some(Scale::Signed { limit: 1.0 }),
            Self::SampleRate | Self::Flip => Some(Scale::Magnitude { limit: 1.0 }),
        }
    }

    /// The words at both ends of that scale.
    pub(super) const fn ends(self) -> [&'static str; 2] {
        match self {
            Self::SignedError => ["too dark", "too bright"],
            Self::SampleRate => ["few", "the cap"],
            Self::Flip => ["looks alike", "as different as can be"],
            Self::Reference | Self::Render | Self::Earlier => ["", ""],
        }
    }
}

/// How the pictures of one viewer are developed: all alike, so that they can be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// Brightening of radiance, powers of two.
    pub(crate) stops: f32,
}

impl Look {
    /// The exposure of `picture`, in half stops, so that pictures of about the same brightness are shown alike.
    pub(crate) fn for_picture(picture: Option<&Image>) -> Self {
        let stops = picture.map_or(0.0, exposure_of);
        Self { stops: (stops * 2.0).floor() / 2.0 }
    }

    /// The picture as an address that holds all of it. Fails if the picture is empty.
    pub(super) fn address(self, image: &Image, shows: Shows) -> Result<String, String> {
        let picture = self.picture(image, shows);
        let file = png::encode(&picture).map_err(|error| error.to_string())?;
        Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(file)))
    }

    /// The picture, small enough to be looked at beside others.
    pub(crate) fn picture(self, image: &Image, shows: Shows) -> Picture {
        let small = image.shrunk_to(SIDE);
        match shows.scale() {
            None => tonemap(&small, self.stops),
            Some(scale) => false_colour(&small, scale),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn exposures_are_half_stops_and_none_without_a_picture() {
        let dim = Image::new(4, 4, [0.013; 3]);
        let doubled = f64::from(Look::for_picture(Some(&dim)).stops) * 2.0;
        assert!(doubled > 0.0 && doubled.fract() == 0.0, "{doubled}");
        assert_eq!(Look::for_picture(None), Look { stops: 0.0 });
    }
}
