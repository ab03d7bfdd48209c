//! A reference that is not what it should be is *broken*, never a pass and never the core's fault, and the message
//! says which command makes it.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::case::load_one;
use furnace::image::{Image, exr};
use furnace::project::Project;
use furnace::run::{Outcome, Plan, Request, attempt};
use furnace::scene::reference::{fingerprint, picture_path, provenance_path};
use std::fs;
use std::path::Path;
use std::sync::Arc;

const NAME: &str = "point-light-plane";
const CASE: &str = "image/point-light-plane-matches-mitsuba";

/// The outcome of the case with the committed reference, changed by `spoil` in a folder of its own.
fn outcome_after(spoil: impl Fn(&Path)) -> Outcome {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join(NAME)).unwrap();
    for path in [picture_path, provenance_path] {
        fs::copy(path(&project.references(), NAME), path(folder.path(), NAME)).unwrap();
    }
    spoil(folder.path());
    let request = Request { cores: vec!["builtin".parse().unwrap()], ..Request::default() };
    let case = load_one(&project.cases(), CASE).unwrap();
    let plan = Plan::new(project, request.clone(), &[Arc::clone(&case)]).unwrap();
    let mut bench = plan.bench();
    bench.references = vec![folder.path().to_owned()];
    attempt(&bench, &case, request.cores[0].make().unwrap().as_mut()).outcome
}

fn assert_broken_by(spoil: impl Fn(&Path), words: &str) {
    let outcome = outcome_after(spoil);
    let Outcome::Broken { why } = outcome else { panic!("not broken but {outcome:?}") };
    assert!(why.contains(words), "`{words}` is not in: {why}");
    assert!(why.contains("furnace reference make point-light-plane"), "no command in: {why}");
}

#[test]
fn the_unspoilt_copy_is_not_broken() {
    assert!(outcome_after(|_| ()).finding().is_some());
}

#[test]
fn a_missing_reference_is_broken() {
    assert_broken_by(|folder| fs::remove_dir_all(folder.join(NAME)).unwrap(), "does not exist");
}

#[test]
fn a_truncated_reference_is_broken() {
    let truncate = |folder: &Path| {
        let path = picture_path(folder, NAME);
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    };
    assert_broken_by(truncate, "is damaged");
}

#[test]
fn a_reference_of_another_size_is_broken() {
    let shrink = |folder: &Path| {
        let error = Image::new(16, 16, [0.01; 3]);
        let small = exr::Exr::from_image(&Image::new(16, 16, [0.5; 3]));
        let path = picture_path(folder, NAME);
        let before = fingerprint(&fs::read(&path).unwrap());
        exr::write(&path, &small.with_colours("se.", &error, exr::Storage::Single)).unwrap();
        let after = fingerprint(&fs::read(&path).unwrap());
        let provenance = provenance_path(folder, NAME);
        let text = fs::read_to_string(&provenance).unwrap();
        assert!(text.contains(&before), "the provenance does not know its picture");
        fs::write(&provenance, text.replace(&before, &after)).unwrap();
    };
    assert_broken_by(shrink, "16");
}

#[test]
fn a_reference_of_another_scene_is_broken() {
    let exchange = |folder: &Path| {
        let path = provenance_path(folder, NAME);
        let text = fs::read_to_string(&path).unwrap();
        let (before, hash) = text.split_once("scene-hash = ").unwrap();
        let (_, after) = hash.split_once('\n').unwrap();
        fs::write(&path, format!("{before}scene-hash = \"00\"\n{after}")).unwrap();
    };
    assert_broken_by(exchange, "of another scene");
}
