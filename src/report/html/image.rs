//! The images of a case: reference, renders and errors in one viewer; without scripts, beside each other.

use super::View;
use super::view::escaped;
use super::viewer::{Frame, Noisy, look, viewer};
use crate::checks::PictureRole;
use crate::image::exr;
use crate::report::digest::CaseGroup;
use crate::run::TrialRecord;
use crate::run::record::PictureFile;
use maud::{Markup, html};
use std::path::Path;

struct Shot<'a> {
    trial: &'a TrialRecord,
    file: &'a PictureFile,
    image: Result<Noisy, String>,
}

/// The viewers of a case: one for each round of pictures that its check has kept.
pub(crate) fn pictures(view: &View<'_>, case: &CaseGroup<'_>) -> Markup {
    html! {
        @for round in 0..rounds(case) {
            @let name = if round == 0 { "images".to_owned() } else { format!("images-{}", round + 1) };
            @let frames = frames(view, case, round);
            (viewer(&frames, &format!("{}:{name}", case.first().case), look(&frames)))
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
    shots.into_iter().map(|shot| frame(view, shot)).collect()
}

fn frame<'a>(view: &View<'_>, shot: Shot<'a>) -> Frame<'a> {
    Frame {
        label: label(&shot),
        caption: shot.file.caption.clone(),
        shows: shot.file.role.into(),
        rejected: &shot.file.rejected,
        source: source(view, &view.tree.picture_path(shot.trial, shot.file)),
        image: shot.image,
    }
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
