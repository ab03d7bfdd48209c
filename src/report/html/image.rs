//! The images of a case: reference, renders and errors in one viewer; without scripts, beside each other.

use super::View;
use super::develop::Shows;
use super::overview::date;
use super::view::escaped;
use super::viewer::{Frame, Noisy, look, viewer};
use crate::checks::PictureRole;
use crate::image::exr;
use crate::report::digest::CaseGroup;
use crate::report::earlier::Earlier;
use crate::run::TrialRecord;
use crate::run::record::PictureFile;
use maud::{Markup, html};
use std::cmp::Reverse;
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
            let image = read(view, &view.tree.picture_path(trial, file));
            shots.push(Shot { trial, file, image });
        }
    }
    shots.sort_by_key(|shot| (rank(shot.file.role), Reverse(layers(shot))));
    without_equal_references(&mut shots);
    let renders = shots.iter().rposition(|shot| shot.file.role == PictureRole::Render);
    let earlier: Vec<_> =
        case.trials.iter().filter_map(|trial| earlier(view, trial, round)).collect();
    let mut frames: Vec<_> = shots.into_iter().map(|shot| frame(view, shot)).collect();
    let after = renders.map_or(frames.len(), |last| last + 1);
    frames.splice(after..after, earlier);
    frames
}

fn read(view: &View<'_>, path: &Path) -> Result<Noisy, String> {
    let image = exr::read(path).and_then(|file| Noisy::of(&file));
    let image =
        image.map(|noisy| noisy.shrunk_to(view.longest)).map_err(|error| error.to_string())?;
    let layers = if view.whole { image.layers } else { Vec::new() };
    Ok(Noisy { layers, ..image })
}

/// How many images its file has.
fn layers(shot: &Shot<'_>) -> usize {
    shot.image.as_ref().map_or(0, |noisy| noisy.layers.len())
}

/// What the same core rendered for this case in an earlier run, if it stands beside a render of this one.
fn earlier<'a>(view: &View<'_>, trial: &TrialRecord, round: usize) -> Option<Frame<'a>> {
    let is_it = |trial: &TrialRecord, file: &PictureFile| {
        file.role == PictureRole::Render && round_of(trial, file) == round
    };
    let has_render = trial.pictures.iter().any(|file| is_it(trial, file));
    let earlier = (view.whole && has_render).then(|| Earlier::of(view.tree, trial))??;
    let file = earlier.trial.pictures.iter().find(|file| is_it(&earlier.trial, file))?;
    let path = earlier.path(file);
    let status = earlier.trial.outcome.status().word();
    Some(Frame {
        label: format!("{} before: {status}", trial.core),
        caption: format!("{}: {}", earlier.started().map(date).unwrap_or_default(), file.caption),
        shows: Shows::Earlier,
        rejected: &[],
        // Its bounces are left out: what an earlier run is for is the whole image.
        image: read(view, &path).map(|noisy| Noisy { layers: Vec::new(), ..noisy }),
        source: source(view, &path),
    })
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
    let image_of = |shot: &Shot<'_>| Some(shot.image.as_ref().ok()?.image.clone());
    let first = shots.iter().find(|shot| is_reference(shot)).and_then(image_of);
    let mut seen = false;
    shots.retain(|shot| {
        let repeats = is_reference(shot) && shot.image.is_ok() && image_of(shot) == first;
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
        let runs = tempfile::tempdir().unwrap();
        let folder = &runs.path().join("run");
        let markup = shown(&Example::green(), folder);
        assert_eq!(markup.matches("alt=\"reference").count(), 1);
        assert_eq!(markup.matches("<img").count(), 1 + 3 + 3);
    }

    #[test]
    fn an_earlier_pass_stands_beside_what_fails() {
        let runs = tempfile::tempdir().unwrap();
        Example::green().write(&runs.path().join("run-0"));
        let markup = shown(&Example::mixed(), &runs.path().join("run-1"));
        assert_eq!(markup.matches("alt=\"builtin before: pass").count(), 1);
        assert_eq!(markup.matches("alt=\"reference").count(), 1);
    }

    #[test]
    fn a_missing_picture_is_shown_as_missing() {
        let runs = tempfile::tempdir().unwrap();
        let folder = &runs.path().join("run");
        shown(&Example::green(), folder);
        let tree = RunTree::load(folder).unwrap();
        let trial = tree.trials.iter().find(|trial| !trial.pictures.is_empty()).unwrap();
        std::fs::remove_file(tree.picture_path(trial, &trial.pictures[1])).unwrap();
        let view = View::new(&tree, folder, Place::Top);
        let cases = by_case(&tree);
        let case = cases.iter().find(|case| case.first().case == trial.case).unwrap();
        let markup = pictures(&view, case).into_string();
        assert_eq!(markup.matches("This image cannot be shown").count(), 1);
        assert_eq!(markup.matches("<img").count(), 6);
    }

    #[test]
    fn pixels_that_are_not_numbers_are_counted() {
        let runs = tempfile::tempdir().unwrap();
        let folder = &runs.path().join("run");
        let markup = shown(&Example::mixed(), folder);
        assert!(markup.contains("1 pixel not finite, in magenta"));
    }
}
