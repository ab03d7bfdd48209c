//! A reference that is not whole, or not of this scene, is no reference.

use super::*;
use crate::image::exr::{Exr, Storage};
use crate::scene::Camera;
use glam::DVec3;
use tempfile::TempDir;

fn scene() -> SceneDescription {
    let camera = Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::Y, 1.0, [32, 64]);
    SceneDescription { name: "room".to_owned(), camera: Some(camera), ..Default::default() }
}

/// A folder with one good reference `room` of an image of this size.
fn written(width: usize, height: usize, mean: f32) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("room")).unwrap();
    let path = picture_path(folder.path(), "room");
    let error = Image::new(width, height, [0.125; 3]);
    let file = Exr::from_image(&Image::new(width, height, [mean; 3]));
    exr::write(&path, &file.with_colours(ERROR_PREFIX, &error, Storage::Half)).unwrap();
    let provenance = Provenance {
        scene: "room".to_owned(),
        scene_hash: content_hash(&scene()),
        bounces: [0, 5],
        film: [32, 64],
        renderer: "mitsuba".to_owned(),
        version: "3.9.1".to_owned(),
        variant: "llvm_ad_rgb".to_owned(),
        sampler: "multijitter".to_owned(),
        passes: 64,
        samples_per_pass: 64,
        seeds: vec![[0, 63]],
        picture_hash: fingerprint(&std::fs::read(&path).unwrap()),
        ..Provenance::default()
    };
    let text = toml::to_string(&provenance).unwrap();
    std::fs::write(provenance_path(folder.path(), "room"), text).unwrap();
    folder
}

fn complaint(folder: &TempDir) -> String {
    load(folder.path(), "room", &scene()).unwrap_err().to_string()
}

#[test]
fn a_good_reference_comes_back_with_mean_error_and_provenance() {
    let folder = written(32, 64, 0.75);
    let reference = load(folder.path(), "room", &scene()).unwrap();
    assert_eq!(reference.mean.pixels[0], [0.75; 3]);
    assert_eq!(reference.standard_error.pixels[0], [0.125; 3]);
    assert_eq!(reference.provenance.samples_per_pixel(), 4096);
}

#[test]
fn a_missing_reference_names_the_command_that_makes_it() {
    let folder = tempfile::tempdir().unwrap();
    let message = complaint(&folder);
    assert!(message.starts_with("reference `room` does not exist"), "{message}");
    assert!(message.ends_with("hint: `furnace reference make room`"), "{message}");
    let folder = written(32, 64, 0.75);
    std::fs::remove_file(picture_path(folder.path(), "room")).unwrap();
    assert!(complaint(&folder).contains("reference.exr"));
}

#[test]
fn a_truncated_reference_is_damaged() {
    let folder = written(32, 64, 0.75);
    let path = picture_path(folder.path(), "room");
    let whole = std::fs::read(&path).unwrap();
    for length in [0, 100, whole.len() - 1] {
        std::fs::write(&path, &whole[..length]).unwrap();
        let message = complaint(&folder);
        assert!(message.contains("is damaged"), "{message}");
        assert!(message.ends_with("`furnace reference make room --replace`"), "{message}");
    }
}

#[test]
fn an_exchanged_picture_is_noticed() {
    let folder = written(32, 64, 0.75);
    let other = written(32, 64, 0.5);
    let path = |folder: &TempDir| picture_path(folder.path(), "room");
    std::fs::copy(path(&other), path(&folder)).unwrap();
    assert!(complaint(&folder).contains("does not match its provenance"));
}

#[test]
fn a_reference_of_another_size_is_refused() {
    let message = complaint(&written(64, 64, 0.75));
    assert!(message.contains("is [64, 64] pixels in size"), "{message}");
    assert!(message.contains("film is [32, 64]"), "{message}");
}

#[test]
fn a_reference_of_a_changed_scene_is_refused() {
    let folder = written(32, 64, 0.75);
    let mut changed = scene();
    changed.camera.as_mut().unwrap().position = DVec3::Y;
    let message = load(folder.path(), "room", &changed).unwrap_err().to_string();
    assert!(message.contains("`room` has changed since it was made"), "{message}");
}

#[test]
fn a_reference_with_light_that_cannot_be_is_refused() {
    for mean in [f32::NAN, f32::INFINITY, -0.5] {
        assert!(complaint(&written(32, 64, mean)).contains("negative or NaN"), "{mean}");
    }
}

#[test]
fn provenance_with_an_unknown_word_is_damaged() {
    let folder = written(32, 64, 0.75);
    let path = provenance_path(folder.path(), "room");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("samples = 3\n{text}")).unwrap();
    assert!(complaint(&folder).contains("unknown field `samples`"));
}

#[test]
fn a_picture_says_in_its_header_how_to_make_it_again() {
    let folder = written(32, 64, 0.75);
    let mut provenance = read_provenance(folder.path(), "room").unwrap();
    provenance.seeds = vec![[0, 31], [40, 71]];
    let header = provenance.header();
    let lines: Vec<&str> = header.lines().collect();
    assert!(lines[0].starts_with("furnace "), "{header}");
    assert_eq!(lines[1], format!("scene room {}", provenance.scene_hash));
    assert_eq!(lines[2], "bounces 0 to 5");
    assert_eq!(lines[3], "mitsuba 3.9.1, llvm_ad_rgb, multijitter");
    assert_eq!(lines[4], "64 passes of 64 samples a pixel, seeds 0 to 31 and 40 to 71");
}
