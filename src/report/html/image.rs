//! Pictures of a case: reference, renders and errors in one viewer, to flip, to wipe, or side by side.

use super::View;
use super::develop::{Look, gradient, longest_side, scale};
use super::parts::escaped;
use crate::checks::PictureRole;
use crate::image::{Image, exr};
use crate::report::digest::CaseGroup;
use crate::run::TrialRecord;
use crate::run::record::PictureFile;
use crate::text::number::count;
use maud::{Markup, html};
use std::path::Path;

struct Shot<'a> {
    trial: &'a TrialRecord,
    file: &'a PictureFile,
    image: Result<Image, String>,
}

struct Frame<'a> {
    shot: Shot<'a>,
    label: String,
    key: Option<char>,
}

/// The viewers of a case: one for each round of pictures that its check has kept.
pub(crate) fn pictures(view: &View<'_>, case: &CaseGroup<'_>) -> Markup {
    let failed = case.trials.iter().any(|trial| trial.outcome.status().is_failure());
    let side = longest_side(view.tree, failed);
    html! {
        @for round in 0..rounds(case) { (viewer(view, &frames(view, case, round), side)) }
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
            let image = exr::read_image(&path).map_err(|error| error.to_string());
            shots.push(Shot { trial, file, image });
        }
    }
    without_equal_references(&mut shots);
    shots.sort_by_key(|shot| rank(shot.file.role));
    let role = |number: usize| shots[number].file.role;
    let alike = |number: usize| (0..number).filter(|n| role(*n) == role(number)).count();
    let keys: Vec<_> = (0..shots.len()).map(|number| key(role(number), alike(number))).collect();
    let frame = |(shot, key)| Frame { label: label(&shot), key, shot };
    shots.into_iter().zip(keys).map(frame).collect()
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

/// The viewer's key for a picture that comes after so many of its role: 1 is the reference, 2 and 3 what was rendered,
/// 4 and 5 its error.
fn key(role: PictureRole, before: usize) -> Option<char> {
    let keys = match role {
        PictureRole::Reference => "1",
        PictureRole::Render => "23",
        PictureRole::SignedError => "45",
        PictureRole::SampleRate => "",
    };
    keys.chars().nth(before)
}

/// What the viewer says to those who only hear it.
const KEYS: &str = "Images. Keys 1 to 5 choose, space flips, w wipes, g shows all.";

fn viewer(view: &View<'_>, frames: &[Frame<'_>], side: usize) -> Markup {
    let radiance = frames.iter().filter(|frame| scale(frame.shot.file.role).is_none());
    let first = radiance.filter_map(|frame| frame.shot.image.as_ref().ok()).next();
    let look = Look::for_picture(first, side);
    html! {
        figure.viewer tabindex="0" aria-label=(KEYS) {
            (tools(frames))
            div.frames { @for frame in frames { (frame_markup(view, frame, look)) } }
            figcaption.faint {
                "Radiance at " (format!("{:+.1}", look.stops)) " EV, sRGB"
                (made_smaller(first, side)) ". "
                span.scripted { "Click an image to see it alone, again to flip back." }
            }
        }
    }
}

/// That pixels were averaged, where they were.
fn made_smaller(picture: Option<&Image>, side: usize) -> Markup {
    let sizes = picture.map(|large| (large, large.shrunk_to(side)));
    html! {
        @if let Some((large, small)) = sizes && small.width != large.width {
            ", " (small.width) " × " (small.height) " of " (large.width) " × " (large.height)
            " pixels: the EXR files have all of them"
        }
    }
}

fn tools(frames: &[Frame<'_>]) -> Markup {
    html! {
        div.tools.scripted role="toolbar" aria-label="Picture" {
            @for (number, frame) in frames.iter().enumerate() {
                button type="button" data-show=(number) data-key=[frame.key] aria-pressed="false" {
                    @if let Some(key) = frame.key { kbd { (key) } " " }
                    (frame.label)
                }
            }
            span.gap {}
            button type="button" data-layout="wipe" aria-pressed="false" { kbd { "w" } " wipe" }
            button type="button" data-layout="all" aria-pressed="false" {
                kbd { "g" } " side by side"
            }
            input.wipe type="range" min="0" max="100" value="50" aria-label="Position of the wipe";
        }
    }
}

fn frame_markup(view: &View<'_>, frame: &Frame<'_>, look: Look) -> Markup {
    let Shot { trial, file, image } = &frame.shot;
    let path = view.tree.picture_path(trial, file);
    html! {
        div.frame {
            p.label { (frame.label) }
            @match image {
                Ok(image) => { (drawing(image, file, &frame.label, look)) }
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
        @if bad > 0 { p.bad { (count(bad, "pixel")) " not finite; NaN is magenta" } }
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
            Ok(relative) => { a href=(escaped(&relative)) { (name) } }
            Err(_) => { code { (name) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::digest::by_case;
    use crate::report::example::Example;
    use crate::report::tree::RunTree;

    /// The markup of the only case with pictures.
    fn shown(example: &Example, folder: &Path) -> String {
        example.write(folder);
        let tree = RunTree::load(folder).unwrap();
        let view = View { tree: &tree, folder };
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
        let keys: Vec<_> = markup.split("data-key=\"").skip(1).map(|rest| &rest[..1]).collect();
        assert_eq!(keys, ["1", "2", "3", "4", "5"]);
    }

    #[test]
    fn a_missing_picture_is_shown_as_missing() {
        let folder = tempfile::tempdir().unwrap();
        shown(&Example::green(), folder.path());
        let tree = RunTree::load(folder.path()).unwrap();
        let trial = tree.trials.iter().find(|trial| !trial.pictures.is_empty()).unwrap();
        std::fs::remove_file(tree.picture_path(trial, &trial.pictures[1])).unwrap();
        let view = View { tree: &tree, folder: folder.path() };
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
        assert!(markup.contains("1 pixel not finite"));
    }
}
