//! Files and exit codes of images.

use super::*;
use crate::image::exr;
use crate::image::file::load;
use clap::Parser;
use std::path::Path;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    render: RenderArguments,
}

fn parsed(words: &[&str]) -> Result<RenderArguments, clap::Error> {
    let words = std::iter::once("render").chain(words.iter().copied());
    let more = ["--quiet", "--project", env!("CARGO_MANIFEST_DIR")];
    Line::try_parse_from(words.chain(more)).map(|line| line.render)
}

fn rendered(words: &[&str]) -> Answer {
    render(&parsed(words).unwrap())
}

/// A scene of the project in a file of a folder of its own.
fn file(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().unwrap().to_owned()
}

#[test]
fn every_format_shows_the_same_image() {
    let folder = tempfile::tempdir().unwrap();
    let path = |ending: &str| file(folder.path(), &format!("image.{ending}"));
    let image = |ending: &str| {
        let path = path(ending);
        let words = ["point-light-plane", "-o", &path, "--spp", "4", "--size", "16x12"];
        assert_eq!(rendered(&words).unwrap(), ExitCode::Good);
        load(Path::new(&path), None).unwrap().image
    };
    let exact = image("exr");
    assert_eq!((exact.width, exact.height), (16, 12));
    assert_eq!(image("pfm"), exact);
    // Of eight bits, and of an exponent of light; white is the end of one of them.
    for (ending, white, tolerance) in [("hdr", f32::INFINITY, 0.01), ("png", 1.0, 0.02)] {
        for (found, expected) in image(ending).pixels.iter().zip(&exact.pixels) {
            let largest = expected.iter().fold(0.1_f32, |a, b| a.max(*b));
            for (found, expected) in found.iter().zip(expected) {
                let off = found - expected.min(white);
                assert!(off.abs() <= tolerance * largest, "{ending}: {found}, {expected}");
            }
        }
    }
}

#[test]
fn an_exr_file_tells_its_noise_and_where_it_is_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(folder.path(), "image.exr");
    let words = ["cornell-diffuse-spheres", "-o", &path, "--spp", "16", "--size", "24x18"];
    assert_eq!(rendered(&words).unwrap(), ExitCode::Good);
    let found = exr::read(Path::new(&path)).unwrap();
    let errors = found.colours(crate::scene::reference::ERROR_PREFIX).unwrap();
    let noisy = errors.pixels.iter().filter(|error| error[0] > 0.0).count();
    assert!(noisy > 200, "{noisy} of {} pixels", errors.pixels.len());
    assert_eq!(found.attributes["standard-errors-from"], "the spread of the passes");
    assert_eq!(found.attributes["scene"], "cornell-diffuse-spheres");
}

#[test]
fn what_cannot_be_rendered_says_why_and_what_next() {
    let folder = tempfile::tempdir().unwrap();
    let good = file(folder.path(), "image.exr");
    let nowhere = file(folder.path(), "none/image.exr");
    for (words, said, code) in [
        (vec!["point-light-plan", "-o", &good], "point-light-plane", ExitCode::BadRequest),
        (vec!["point-light-plane", "-o", &nowhere], "there is no folder", ExitCode::BadRequest),
        (vec!["sphere-furnace", "-o", &good, "--set", "albdo=1"], "albedo", ExitCode::BadRequest),
    ] {
        let failure = rendered(&words).unwrap_err();
        assert!(failure.message.contains(said), "{}", failure.message);
        assert_eq!(failure.code, code, "{}", failure.message);
    }
    for words in [
        ["a", "-o", "image.gif", "--spp", "4"],
        ["a", "-o", "image.exr", "--spp", "0"],
        ["a", "-o", "image.exr", "--size", "640"],
        ["a", "-o", "image.exr", "--set", "x=y"],
    ] {
        assert!(parsed(&words).is_err(), "{words:?}");
    }
}

#[test]
fn another_size_leaves_pixels_square() {
    let arguments = parsed(&["point-light-plane", "-o", "a.exr", "--size", "40x10"]).unwrap();
    let library = Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
    let scene = arguments.shot.load(&library).unwrap();
    let camera = arguments.shot.camera(&scene).unwrap();
    assert_eq!(camera.film, [40, 10]);
    assert!(camera.has_square_pixels());
    assert_eq!(camera.horizontal_fov, scene.camera.unwrap().horizontal_fov);
}

#[test]
fn bars_have_their_own_looks() {
    for looks in [BAR, SPINNER] {
        assert!(ProgressStyle::with_template(looks).is_ok(), "{looks}");
    }
}
