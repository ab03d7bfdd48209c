//! A viewer: images of one size with their errors, exposure, values and regions; without scripts, beside each other.

use super::develop::{Look, Shows, gradient};
use super::pixels::Packed;
use crate::checks::RejectedCell;
use crate::image::exr::Exr;
use crate::image::heatmap::Scale;
use crate::image::{Image, ImageError};
use crate::scene::reference::ERROR_PREFIX;
use crate::text::number::count;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

/// One image of a viewer.
pub(super) struct Frame<'a> {
    pub(super) label: String,
    pub(super) caption: String,
    pub(super) shows: Shows,
    pub(super) rejected: &'a [RejectedCell],
    pub(super) image: Result<Noisy, String>,
    /// Where the file is.
    pub(super) source: Markup,
}

/// An image, and the standard error of each value if it is known.
#[derive(Clone, PartialEq)]
pub(super) struct Noisy {
    pub(super) image: Image,
    pub(super) standard_error: Option<Image>,
    /// Width and height in its file, if it is smaller here.
    pub(super) shrunk_from: Option<[usize; 2]>,
    /// What its file holds besides, by name.
    pub(super) layers: Vec<(String, Image)>,
}

impl Noisy {
    pub(super) fn of(file: &Exr) -> Result<Self, ImageError> {
        let standard_error = file.colours(ERROR_PREFIX).ok();
        let names = file.layers().into_iter().filter(|name| !ERROR_PREFIX.starts_with(name));
        let layer = |name: &str| Some((name.to_owned(), file.colours(&format!("{name}.")).ok()?));
        let layers = names.filter_map(layer).collect();
        Ok(Self { layers, standard_error, ..Self::alone(file.image()?) })
    }

    /// An image of which nothing else is known.
    pub(super) const fn alone(image: Image) -> Self {
        Self { image, standard_error: None, shrunk_from: None, layers: Vec::new() }
    }

    /// With no side longer than this. The noise of its larger pixels is not known.
    pub(super) fn shrunk_to(self, longest: usize) -> Self {
        let size = self.image.size();
        if size[0].max(size[1]) <= longest {
            return self;
        }
        Self { shrunk_from: Some(size), ..Self::alone(self.image.shrunk_to(longest)) }
    }
}

/// What a viewer is given.
#[derive(Serialize)]
struct Payload<'a> {
    width: usize,
    height: usize,
    /// The exposure that is shown at first, powers of two.
    stops: f32,
    frames: Vec<PackedFrame<'a>>,
}

#[derive(Serialize)]
struct PackedFrame<'a> {
    label: &'a str,
    caption: String,
    role: Shows,
    /// How its values become colours: as radiance, or on a scale of their own.
    kind: &'static str,
    /// Pixels that are NaN, and those that are infinite.
    nan: usize,
    infinite: usize,
    rejected: &'a [RejectedCell],
    image: Packed,
    #[serde(skip_serializing_if = "Option::is_none")]
    noise: Option<Packed>,
    layers: Vec<PackedLayer>,
}

#[derive(Serialize)]
struct PackedLayer {
    /// `bounce 2`
    name: String,
    image: Packed,
}

/// What the viewer says to those who only hear it.
const ABOUT: &str = "Images. The key ? lists the keys of the viewer.";

/// The viewer of these images, called `id` in addresses.
pub(super) fn viewer(frames: &[Frame<'_>], id: &str, look: Look) -> Markup {
    html! {
        figure.viewer id=(id) tabindex="0" aria-label=(ABOUT) {
            div.frames { @for frame in frames { (frame_markup(frame, look)) } }
            @if let Some(payload) = payload(frames, look) {
                script type="application/json" { (PreEscaped(payload)) }
            }
        }
    }
}

/// The look that suits the first image of radiance.
pub(super) fn look(frames: &[Frame<'_>]) -> Look {
    let radiance = frames.iter().filter(|frame| frame.shows.scale().is_none());
    let first = radiance.filter_map(|frame| frame.image.as_ref().ok()).next();
    Look::for_picture(first.map(|noisy| &noisy.image))
}

/// The images in one size as the viewer reads them. Errors that it can work out itself are left out.
fn payload(frames: &[Frame<'_>], look: Look) -> Option<String> {
    let shown = frames.iter().filter_map(|frame| Some((frame, frame.image.as_ref().ok()?)));
    let size = shown.clone().next()?.1.image.size();
    let same: Vec<_> = shown.filter(|(_, noisy)| noisy.image.size() == size).collect();
    let works_out_errors = same
        .iter()
        .all(|(frame, noisy)| frame.shows.scale().is_some() || noisy.standard_error.is_some());
    let is_needed = |frame: &Frame<'_>| frame.shows != Shows::SignedError || !works_out_errors;
    let needed = same.into_iter().filter(|(frame, _)| is_needed(frame));
    let frames = needed.map(|(frame, noisy)| packed(frame, noisy)).collect();
    let payload = Payload { width: size[0], height: size[1], stops: look.stops, frames };
    // In a page, only `<` could end a script.
    Some(serde_json::to_string(&payload).ok()?.replace('<', "\\u003c"))
}

fn packed<'a>(frame: &'a Frame<'_>, noisy: &Noisy) -> PackedFrame<'a> {
    let pixels = &noisy.image.pixels;
    let with = |is: fn(f32) -> bool| pixels.iter().filter(|p| p.iter().any(|v| is(*v))).count();
    PackedFrame {
        label: &frame.label,
        caption: caption(frame, noisy),
        role: frame.shows,
        kind: match frame.shows.scale() {
            None => "radiance",
            Some(Scale::Signed { .. }) => "signed",
            Some(Scale::Magnitude { .. }) => "magnitude",
        },
        nan: with(f32::is_nan),
        infinite: with(f32::is_infinite),
        // Cells are places in the image as it was.
        rejected: if noisy.shrunk_from.is_none() { frame.rejected } else { &[] },
        image: Packed::of(&noisy.image),
        noise: noisy.standard_error.as_ref().map(Packed::of),
        layers: noisy.layers.iter().map(packed_layer).collect(),
    }
}

fn packed_layer((name, image): &(String, Image)) -> PackedLayer {
    PackedLayer { name: name.replace(['.', '-'], " "), image: Packed::roughly(image) }
}

/// What an image shows, and that its pixels were averaged where they were.
fn caption(frame: &Frame<'_>, noisy: &Noisy) -> String {
    let Some([width, height]) = noisy.shrunk_from else { return frame.caption.clone() };
    let [columns, rows] = noisy.image.size();
    format!("{}; {columns} × {rows} of {width} × {height} pixels", frame.caption)
}

fn frame_markup(frame: &Frame<'_>, look: Look) -> Markup {
    html! {
        div.frame {
            p.label { (frame.label) }
            @match &frame.image {
                Ok(noisy) => { (drawing(&noisy.image, frame, look)) }
                Err(error) => { p.missing { "This image cannot be shown. " (error) } }
            }
            p.faint { (frame.caption) " · " (frame.source) }
        }
    }
}

fn drawing(image: &Image, frame: &Frame<'_>, look: Look) -> Markup {
    let bad =
        image.pixels.iter().filter(|pixel| !pixel.iter().all(|value| value.is_finite())).count();
    html! {
        @match look.address(image, frame.shows) {
            Ok(address) => { img src=(address) alt={ (frame.label) ": " (frame.caption) }; }
            Err(error) => { p.missing { "This image cannot be shown. " (error) } }
        }
        (legend(frame.shows))
        @if bad > 0 { p.bad { (count(bad, "pixel")) " not finite, in magenta" } }
    }
}

/// What the colours mean, where they are false.
fn legend(shows: Shows) -> Markup {
    let [low, high] = shows.ends();
    html! {
        @if let Some(scale) = shows.scale() {
            p.legend { (low) " " span.scale style=(gradient(scale)) {} " " (high) }
        }
    }
}
