//! The images of a case: reference, renders and errors in one viewer; without scripts, beside each other.

use super::View;
use super::develop::{Look, gradient, scale};
use super::pixels::Packed;
use super::view::escaped;
use crate::checks::{PictureRole, RejectedCell};
use crate::image::exr::Exr;
use crate::image::{Image, ImageError, exr};
use crate::report::digest::CaseGroup;
use crate::run::TrialRecord;
use crate::run::record::PictureFile;
use crate::scene::reference::ERROR_PREFIX;
use crate::text::number::count;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use std::path::Path;

struct Shot<'a> {
    trial: &'a TrialRecord,
    file: &'a PictureFile,
    image: Result<Noisy, String>,
}

/// An image, and the standard error of each value if it is known.
#[derive(Clone, PartialEq)]
struct Noisy {
    image: Image,
    standard_error: Option<Image>,
    /// Width and height in its file, if it is smaller here.
    shrunk_from: Option<[usize; 2]>,
}

impl Noisy {
    fn of(file: &Exr) -> Result<Self, ImageError> {
        let standard_error = file.colours(ERROR_PREFIX).ok();
        Ok(Self { image: file.image()?, standard_error, shrunk_from: None })
    }

    /// With no side longer than this. The noise of its larger pixels is not known.
    fn shrunk_to(self, longest: usize) -> Self {
        let size = self.image.size();
        if size[0].max(size[1]) <= longest {
            return self;
        }
        let image = self.image.shrunk_to(longest);
        Self { image, standard_error: None, shrunk_from: Some(size) }
    }
}

struct Frame<'a> {
    shot: Shot<'a>,
    label: String,
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
    role: PictureRole,
    /// How its values become colours: as radiance, or on a scale of their own.
    kind: &'static str,
    /// Pixels that are NaN, and those that are infinite.
    nan: usize,
    infinite: usize,
    rejected: &'a [RejectedCell],
    image: Packed,
    #[serde(skip_serializing_if = "Option::is_none")]
    noise: Option<Packed>,
}

/// The viewers of a case: one for each round of pictures that its check has kept.
pub(crate) fn pictures(view: &View<'_>, case: &CaseGroup<'_>) -> Markup {
    html! {
        @for round in 0..rounds(case) {
            @let name = if round == 0 { "images".to_owned() } else { format!("images-{}", round + 1) };
            (viewer(view, &frames(view, case, round), &format!("{}:{name}", case.first().case)))
        }
    }
}

/// How often the busiest role occurs in a trial.
fn rounds(case: &CaseGroup<'_>) -> usize {
    let of_trial = |trial: &&TrialRecord| {
        trial.pictures.iter().map(|file| round_of(trial, file) + 1).max().unwrap_or(0)
    };
    case.trials.iter().map(of_trial).max().unwrap_or(0)
}

/// How many pictures of the same role come before this one.
fn round_of(trial: &TrialRecord, file: &PictureFile) -> usize {
    let before = trial.pictures.iter().take_while(|other| other.file != file.file);
    before.filter(|other| other.role == file.role).count()
}

/// The pictures of one round: reference first, then what the cores made, then the errors.
fn frames<'a>(view: &View<'_>, case: &CaseGroup<'a>, round: usize) -> Vec<Frame<'a>> {
    let mut shots = Vec::new();
    for trial in &case.trials {
        for file in trial.pictures.iter().filter(|file| round_of(trial, file) == round) {
            let path = view.tree.picture_path(trial, file);
            let image = exr::read(&path).and_then(|file| Noisy::of(&file));
            let image = image.map(|noisy| noisy.shrunk_to(view.longest));
            let image = image.map_err(|error| error.to_string());
            shots.push(Shot { trial, file, image });
        }
    }
    without_equal_references(&mut shots);
    shots.sort_by_key(|shot| rank(shot.file.role));
    shots.into_iter().map(|shot| Frame { label: label(&shot), shot }).collect()
}

/// Cores that were held against the same reference share one picture of it.
fn without_equal_references(shots: &mut Vec<Shot<'_>>) {
    let is_reference = |shot: &Shot<'_>| shot.file.role == PictureRole::Reference;
    let first =
        shots.iter().find(|shot| is_reference(shot)).and_then(|shot| shot.image.clone().ok());
    let mut seen = false;
    shots.retain(|shot| {
        let repeats =
            is_reference(shot) && shot.image.is_ok() && shot.image.as_ref().ok() == first.as_ref();
        let keep = !(repeats && seen);
        seen |= repeats;
        keep
    });
}

const fn rank(role: PictureRole) -> usize {
    match role {
        PictureRole::Reference => 0,
        PictureRole::Render => 1,
        PictureRole::SignedError => 2,
        PictureRole::SampleRate => 3,
    }
}

fn label(shot: &Shot<'_>) -> String {
    let core = &shot.trial.core;
    match shot.file.role {
        PictureRole::Reference => "reference".to_owned(),
        PictureRole::Render => core.clone(),
        PictureRole::SignedError => format!("error of {core}"),
        PictureRole::SampleRate => format!("samples of {core}"),
    }
}

/// What the viewer says to those who only hear it.
const ABOUT: &str = "Images. The key ? lists the keys of the viewer.";

fn viewer(view: &View<'_>, frames: &[Frame<'_>], id: &str) -> Markup {
    let radiance = frames.iter().filter(|frame| scale(frame.shot.file.role).is_none());
    let first = radiance.filter_map(|frame| frame.shot.image.as_ref().ok()).next();
    let look = Look::for_picture(first.map(|noisy| &noisy.image));
    html! {
        figure.viewer id=(id) tabindex="0" aria-label=(ABOUT) {
            div.frames { @for frame in frames { (frame_markup(view, frame, look)) } }
            @if let Some(payload) = payload(frames, look) {
                script type="application/json" { (PreEscaped(payload)) }
            }
        }
    }
}

/// The images in one size as the viewer reads them. Errors that it can work out itself are left out.
fn payload(frames: &[Frame<'_>], look: Look) -> Option<String> {
    let shown = frames.iter().filter_map(|frame| Some((frame, frame.shot.image.as_ref().ok()?)));
    let size = shown.clone().next()?.1.image.size();
    let same: Vec<_> = shown.filter(|(_, noisy)| noisy.image.size() == size).collect();
    let is_radiance = |frame: &Frame<'_>| scale(frame.shot.file.role).is_none();
    let works_out_errors =
        same.iter().all(|(frame, noisy)| !is_radiance(frame) || noisy.standard_error.is_some());
    let is_needed =
        |frame: &Frame<'_>| frame.shot.file.role != PictureRole::SignedError || !works_out_errors;
    let needed = same.into_iter().filter(|(frame, _)| is_needed(frame));
    let frames = needed.map(|(frame, noisy)| packed(frame, noisy)).collect();
    let payload = Payload { width: size[0], height: size[1], stops: look.stops, frames };
    // In a page, only `<` could end a script.
    Some(serde_json::to_string(&payload).ok()?.replace('<', "\\u003c"))
}

fn packed<'a>(frame: &'a Frame<'_>, noisy: &Noisy) -> PackedFrame<'a> {
    let Shot { file, .. } = &frame.shot;
    let pixels = &noisy.image.pixels;
    let with = |is: fn(f32) -> bool| pixels.iter().filter(|p| p.iter().any(|v| is(*v))).count();
    PackedFrame {
        label: &frame.label,
        caption: caption(file, noisy),
        role: file.role,
        kind: match file.role {
            PictureRole::Reference | PictureRole::Render => "radiance",
            PictureRole::SignedError => "signed",
            PictureRole::SampleRate => "magnitude",
        },
        nan: with(f32::is_nan),
        infinite: with(f32::is_infinite),
        // Cells are places in the image as it was.
        rejected: if noisy.shrunk_from.is_none() { &file.rejected } else { &[] },
        image: Packed::of(&noisy.image),
        noise: noisy.standard_error.as_ref().map(Packed::of),
    }
}

/// What an image shows, and that its pixels were averaged where they were.
fn caption(file: &PictureFile, noisy: &Noisy) -> String {
    let Some([width, height]) = noisy.shrunk_from else { return file.caption.clone() };
    let [columns, rows] = noisy.image.size();
    format!("{}; {columns} × {rows} of {width} × {height} pixels", file.caption)
}

fn frame_markup(view: &View<'_>, frame: &Frame<'_>, look: Look) -> Markup {
    let Shot { trial, file, image } = &frame.shot;
    let path = view.tree.picture_path(trial, file);
    html! {
        div.frame {
            p.label { (frame.label) }
            @match image {
                Ok(noisy) => { (drawing(&noisy.image, file, &frame.label, look)) }
                Err(error) => { p.missing { "This image cannot be shown. " (error) } }
            }
            p.faint { (file.caption) " · " (source(view, &path)) }
        }
    }
}

fn drawing(image: &Image, file: &PictureFile, label: &str, look: Look) -> Markup {
    let bad =
        image.pixels.iter().filter(|pixel| !pixel.iter().all(|value| value.is_finite())).count();
    html! {
        @match look.address(image, file.role) {
            Ok(address) => { img src=(address) alt={ (label) ": " (file.caption) }; }
            Err(error) => { p.missing { "This image cannot be shown. " (error) } }
        }
        (legend(file.role))
        @if bad > 0 { p.bad { (count(bad, "pixel")) " not finite, in magenta" } }
    }
}

/// What the colours mean, where they are false.
fn legend(role: PictureRole) -> Markup {
    let (low, high) = match role {
        PictureRole::SignedError => ("too dark", "too bright"),
        _ => ("few", "the cap"),
    };
    html! {
        @if let Some(scale) = scale(role) {
            p.legend { (low) " " span.scale style=(gradient(scale)) {} " " (high) }
        }
    }
}

/// A link to the file, where the page stands in or above the folder of the run.
fn source(view: &View<'_>, path: &Path) -> Markup {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let relative =
        path.strip_prefix(view.folder).map(|path| path.to_string_lossy().replace('\\', "/"));
    html! {
        @match relative {
            Ok(relative) => { a href={ (view.up()) (escaped(&relative)) } { (name) } }
            Err(_) => { code { (name) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::digest::by_case;
    use crate::report::example::Example;
    use crate::report::html::view::Place;
    use crate::report::tree::RunTree;

    /// The markup of the only case with pictures.
    fn shown(example: &Example, folder: &Path) -> String {
        example.write(folder);
        let tree = RunTree::load(folder).unwrap();
        let view = View::new(&tree, folder, Place::Top);
        let cases = by_case(&tree);
        let case = cases.iter().find(|case| !case.first().pictures.is_empty()).unwrap();
        pictures(&view, case).into_string()
    }

    #[test]
    fn two_cores_share_their_reference() {
        let folder = tempfile::tempdir().unwrap();
        let markup = shown(&Example::green(), folder.path());
        assert_eq!(markup.matches("alt=\"reference").count(), 1);
        assert_eq!(markup.matches("<img").count(), 1 + 3 + 3);
    }

    #[test]
    fn a_missing_picture_is_shown_as_missing() {
        let folder = tempfile::tempdir().unwrap();
        shown(&Example::green(), folder.path());
        let tree = RunTree::load(folder.path()).unwrap();
        let trial = tree.trials.iter().find(|trial| !trial.pictures.is_empty()).unwrap();
        std::fs::remove_file(tree.picture_path(trial, &trial.pictures[1])).unwrap();
        let view = View::new(&tree, folder.path(), Place::Top);
        let cases = by_case(&tree);
        let case = cases.iter().find(|case| case.first().case == trial.case).unwrap();
        let markup = pictures(&view, case).into_string();
        assert_eq!(markup.matches("This image cannot be shown").count(), 1);
        assert_eq!(markup.matches("<img").count(), 6);
    }

    #[test]
    fn pixels_that_are_not_numbers_are_counted() {
        let folder = tempfile::tempdir().unwrap();
        let markup = shown(&Example::mixed(), folder.path());
        assert!(markup.contains("1 pixel not finite, in magenta"));
    }
}
