//! Shell scripts that play renderers, good and bad.

use super::*;
use crate::contract::{CoreError, IntegratorSettings};
use crate::image::encoding::Encoding;
use crate::scene::{Library, Overrides};
use std::path::Path;
use std::sync::Arc;

/// Writes the picture of one pixel whose red is the seed and whose green is the depth.
const GOOD: &str = r#"
test -s "$1" || exit 9
{ printf 'PF\n1 1\n1.0\n'; printf '\077\200\000\000\100\000\000\000\100\100\000\000'; } > "$2"
echo "took 1,250.5 s"
"#;

fn core(folder: &Path, script: &str, change: (&str, &str)) -> CommandCore {
    std::fs::write(folder.join("renderer.sh"), script).unwrap();
    let text = adapter::tests::GOOD
        .replace(r#""-c", "true", "{scene}""#, r#""{adapter}/renderer.sh", "{scene}""#)
        .replace("\nruns", "\nlog = { seconds = 'took ([0-9.,]+) s' }\nruns")
        .replace(change.0, change.1);
    let path = folder.join("adapter.toml");
    std::fs::write(&path, text).unwrap();
    CommandCore(Program::load(&path).unwrap_or_else(|error| panic!("{error}")))
}

fn render(core: &mut CommandCore, scene: &str) -> Result<Film> {
    render_with(core, scene, 5)
}

fn render_with(core: &mut CommandCore, scene: &str, seed: u64) -> Result<Film> {
    let (scene, camera, settings) = request(scene, seed);
    let mut film = Film { width: 1, height: 1, sample_counts: vec![0], ..Film::default() };
    core.build_scene(&scene, Acceleration::DEFAULT)?.render(&camera, &settings, &mut film)?;
    Ok(film)
}

/// One pixel of four samples.
fn request(scene: &str, seed: u64) -> (Arc<SceneDescription>, Camera, RenderSettings) {
    let library = Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
    let scene = library.load(scene, &Overrides::new()).unwrap();
    let camera =
        Camera { vertical_fov: scene.camera.unwrap().horizontal_fov, ..scene.camera.unwrap() };
    let integrator = IntegratorSettings { seed, ..IntegratorSettings::default() };
    let settings = RenderSettings {
        width: 1,
        height: 1,
        samples_per_pixel: 4,
        integrator,
        ..Default::default()
    };
    (scene, camera, settings)
}

fn outcome(script: &str, change: (&str, &str)) -> Result<Film> {
    let folder = tempfile::tempdir().unwrap();
    render(&mut core(folder.path(), script, change), "point-light-plane")
}

#[test]
fn what_a_program_writes_is_the_picture() {
    let film = outcome(GOOD, ("", "")).unwrap();
    assert_eq!((film.pixels, film.sample_counts), (vec![[1.0, 2.0, 3.0]], vec![4]));
}

#[test]
fn a_program_can_be_asked_for_pictures_only() {
    let folder = tempfile::tempdir().unwrap();
    let info = core(folder.path(), GOOD, ("", "")).info();
    let takes_in = Capabilities::BUILD_SCENE | Capabilities::ROUGH_GLASS;
    assert_eq!(info.capabilities, takes_in | Capabilities::RENDER);
    let eight_bits = ("picture.pfm\", encoding = \"linear\"", "picture.png\", encoding = \"srgb\"");
    let info = core(folder.path(), GOOD, eight_bits).info();
    assert_eq!(info.capabilities, takes_in | Capabilities::RENDER_CODES);
}

#[test]
fn a_program_that_writes_8_bits_is_asked_for_its_codes() {
    let folder = tempfile::tempdir().unwrap();
    let codes = image::RgbImage::from_raw(1, 1, vec![10, 128, 255]).unwrap();
    codes.save(folder.path().join("made.png")).unwrap();
    let script = format!("cp {}/made.png $2", folder.path().display());
    let eight_bits =
        ("picture.pfm\", encoding = \"linear\"", "picture.png\", encoding = \"course\"");
    let mut core = core(folder.path(), &script, eight_bits);
    let (scene, camera, settings) = request("point-light-plane", 5);
    let mut built = core.build_scene(&scene, Acceleration::DEFAULT).unwrap();
    let mut codes = crate::image::png::Picture::default();
    let encoding = built.render_codes(&camera, &settings, &mut codes).unwrap();
    assert_eq!(encoding, Encoding::COURSE);
    assert_eq!(codes.pixels, [[10, 128, 255]]);
}

#[test]
fn times_are_read_from_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let core = core(folder.path(), GOOD, ("", ""));
    let (scene, camera, settings) = request("point-light-plane", 5);
    assert_eq!(core.0.render(&scene, &camera, &settings).unwrap().log.seconds, Some(1250.5));
}

#[test]
fn a_failing_program_is_read_to_the_end() {
    let CoreError::Crashed { how, .. } =
        outcome("echo no such scene >&2; exit 7", ("", "")).unwrap_err()
    else {
        panic!("not seen as a crash")
    };
    assert!(how.contains("exit status: 7; the end of its output: no such scene"), "{how}");
}

#[test]
fn a_program_that_hangs_is_out_of_time() {
    let error = outcome("echo on my way; sleep 60", ("time-limit = 5", "time-limit = 1"));
    let error = error.unwrap_err().to_string();
    assert!(error.contains("no answer within 1s") && error.contains("on my way"), "{error}");
}

#[test]
fn a_program_that_writes_nothing_or_something_else_is_told() {
    let nothing = outcome("echo done", ("", "")).unwrap_err().to_string();
    assert!(
        nothing.contains("without writing picture.pfm; the end of its output: done"),
        "{nothing}"
    );
    let rubbish = outcome("echo rubbish > $2", ("", "")).unwrap_err().to_string();
    assert!(rubbish.contains("picture.pfm"), "{rubbish}");
    let small = GOOD.replace("1 1", "1 2").replacen("';", "'; printf '123456789012';", 1);
    let size = outcome(&small, ("", "")).unwrap_err().to_string();
    assert!(size.contains("has 1 x 2 pixels, not 1 x 1"), "{size}");
}

#[test]
fn a_program_that_is_not_there_is_asked_for() {
    let gone = outcome(GOOD, ("default = \"sh\"", "default = \"no-such-program\""));
    let message = gone.unwrap_err().to_string();
    assert!(message.contains("set FURNACE_TEST_SHELL to a shell"), "{message}");
}

#[test]
fn what_is_beyond_the_program_or_the_format_is_skipped() {
    let lacks = ("\nruns", "\nlacks = [\"point-light\"]\nruns");
    let error = outcome(GOOD, lacks).unwrap_err();
    assert_eq!(error, CoreError::Beyond("sh has no point lights".to_owned()));
    let lacks = ("\nruns", "\nlacks = [\"area-light-pdf\"]\nruns");
    assert!(outcome(GOOD, lacks).is_ok(), "a point light has no pdf");
    let folder = tempfile::tempdir().unwrap();
    let error = render(&mut core(folder.path(), GOOD, ("", "")), "cap-cavity").unwrap_err();
    assert!(matches!(error, CoreError::Beyond(_)), "{error}");
}

#[test]
fn without_seeds_runs_differ_by_a_sample() {
    let folder = tempfile::tempdir().unwrap();
    let script = format!("{GOOD}\necho $3 $4 >> {}/asked", folder.path().display());
    std::fs::write(folder.path().join("unseeded.sh"), &script).unwrap();
    let text = adapter::tests::GOOD
        .replace(r#""-c", "true", "{scene}""#, r#""{adapter}/unseeded.sh", "{scene}""#)
        .replace(r#""{seed}"]"#, r#""{spp}", "{depth}"]"#)
        .replace("{ seed-bits = 31 }", "\"one-sample-more\"\ndepth-offset = 1");
    let path = folder.path().join("unseeded.toml");
    std::fs::write(&path, text).unwrap();
    let mut core = CommandCore(Program::load(&path).unwrap_or_else(|error| panic!("{error}")));
    for seed in [8, 9, 8] {
        render_with(&mut core, "point-light-plane", seed).unwrap();
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("asked")).unwrap(), "4 2\n5 2\n4 2\n");
}
