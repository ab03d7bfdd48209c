//! Files in, words and exit codes out.

use super::*;
use crate::image::exr::{self, Exr, Storage};
use crate::image::metric::METRICS;
use crate::image::{Image, pfm, png};
use crate::math::rng::{Seed, uniform};
use crate::report::comparison::told_of;
use crate::scene::reference::{ERROR_PREFIX, Layers};
use crate::stats::Comparison;
use clap::Parser;
use std::path::Path;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    compare: CompareArguments,
}

fn measured(words: &[&str]) -> Result<Comparisons, Failure> {
    let line = Line::try_parse_from(std::iter::once("compare").chain(words.iter().copied()));
    measure(&line.unwrap().compare).map(|(comparisons, _)| comparisons)
}

/// What was found of the only image.
pub(super) fn compared(words: &[&str]) -> Result<Comparison, Failure> {
    let mut images = measured(words)?.images;
    assert_eq!(images.len(), 1);
    Ok(images.remove(0).comparison)
}

pub(super) fn path_of(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn scene(x: usize, y: usize) -> f64 {
    let stripe = if (x + y / 2) % 40 < 16 { 0.5 } else { 1.0 };
    stripe * (0.05 + 0.001 * x as f64 + 0.0008 * y as f64)
}

fn render(seed: u64, amount: f64, factor: f64) -> Image {
    let mut stream = Seed(seed).stream();
    Image::from_fn(192, 128, |x, y| {
        let noise = 1.0 + amount * (2.0 * uniform(&mut stream) - 1.0);
        [(factor * scene(x, y) * noise) as f32; 3]
    })
}

fn file(folder: &Path, name: &str, image: &Image) -> String {
    let path = folder.join(name);
    pfm::write(&path, image).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A reference that brings its own errors, as a file.
fn with_errors(folder: &Path, reference: &Image, errors: &Image) -> PathBuf {
    let path = folder.join("reference.exr");
    let exr = Exr::from_image(reference).with_colours(ERROR_PREFIX, errors, Storage::Half);
    exr::write(&path, &exr).unwrap();
    path
}

#[test]
fn a_second_render_passes_and_a_brighter_one_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let reference = file(folder.path(), "b.pfm", &render(1, 0.02, 1.0));
    let good = file(folder.path(), "good.pfm", &render(2, 0.1, 1.0));
    let bright = file(folder.path(), "bright.pfm", &render(3, 0.02, 1.05));
    let found = compared(&[&good, &reference, "--no-flip"]).unwrap();
    assert_eq!(found.verdict, Verdict::Pass, "{found:#?}");
    assert_eq!(found.metrics.len(), METRICS.len() - 2);
    let found = compared(&[&bright, &reference]).unwrap();
    let told = told_of(&found);
    assert!(told.starts_with("fail: the image has 1.05"), "{told}");
    assert!(told.contains("times as bright, alike in all channels"), "{told}");
    assert!(told.contains("FLIP"), "{told}");
}

#[test]
fn a_reference_brings_its_own_errors_and_several_renders_theirs() {
    let folder = tempfile::tempdir().unwrap();
    let reference = render(1, 0.01, 1.0);
    let errors = Image::from_fn(192, 128, |x, y| [(0.006 * scene(x, y)) as f32; 3]);
    let path = with_errors(folder.path(), &reference, &errors);
    let runs: Vec<String> = (10..18)
        .map(|seed| {
            let mut image = render(seed, 0.1, 1.0);
            image.pixels[5000] = [0.0; 3];
            file(folder.path(), &format!("{seed}.pfm"), &image)
        })
        .collect();
    let mut words: Vec<&str> = runs.iter().map(String::as_str).collect();
    words.extend([path.to_str().unwrap(), "--no-flip", "--renders"]);
    let found = compared(&words).unwrap();
    assert_eq!(found.difference.outliers.map(|odd| odd.pixels), Some(1), "{found:#?}");
    let place = format!("{},{},1,1", 5000 % 192, 5000 / 192);
    words.extend(["--ignore", &place]);
    assert_eq!(compared(&words).unwrap().verdict, Verdict::Pass);
}

/// A reference with its errors, and a noisy picture of 8 bits of it, as files.
#[test]
fn a_reference_that_holds_its_bounces_apart_tells_which_is_missing_or_there_twice() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let reference = root.join("references/cornell-six-bounces/reference.exr");
    let stored = exr::read(&reference).unwrap();
    let (mean, bounces) = (stored.image().unwrap(), Layers::read(&stored).bounces);
    assert_eq!(bounces.len(), 7);
    for (bounce, times, words) in [(3, -1.0, "is missing"), (2, 1.0, "is there too often")] {
        let mut stream = Seed(bounce as u64).stream();
        let picture = Image::from_fn(mean.width, mean.height, |x, y| {
            let noise = 1.0 + 0.05 * (2.0 * uniform(&mut stream) - 1.0);
            let i = y * mean.width + x;
            let light = |c: usize| mean.pixels[i][c] + times * bounces[bounce].pixels[i][c];
            [light(0), light(1), light(2)].map(|light| light.max(0.0) * noise as f32)
        });
        let picture = file(folder.path(), "picture.pfm", &picture);
        let found = compared(&[&picture, reference.to_str().unwrap(), "--no-flip"]).unwrap();
        let told = told_of(&found);
        let expected = format!("bounce {bounce} {words}");
        assert!(found.verdict == Verdict::Fail && told.contains(&expected), "{told}");
    }
}

fn coded(folder: &Path, seed: u64, factor: f64, encoding: Encoding) -> [String; 2] {
    let reference = render(1, 0.005, 1.0);
    let errors = Image::from_fn(192, 128, |x, y| [(0.003 * scene(x, y)) as f32; 3]);
    let exact = with_errors(folder, &reference, &errors);
    let path = folder.join(format!("{seed}.png"));
    png::write(&path, &encoding.picture(&render(seed, 0.3, factor))).unwrap();
    [&path, &exact].map(|path| path.to_str().unwrap().to_owned())
}

#[test]
fn codes_are_compared_by_their_law() {
    let folder = tempfile::tempdir().unwrap();
    let gamma = Encoding::of(Curve::Gamma(2.2));
    let told = |seed, factor, encoding, more: &[&str]| {
        let [picture, reference] = coded(folder.path(), seed, factor, encoding);
        let mut all = vec![picture.as_str(), reference.as_str(), "--encoding", "2.2", "--no-flip"];
        all.extend(more);
        let found = compared(&all).unwrap();
        (told_of(&found), found)
    };
    let (good, found) = told(5, 1.0, gamma, &[]);
    assert_eq!(found.verdict, Verdict::Pass, "{good}");
    assert!(good.contains("the noise of the image is unknown"), "{good}");
    assert!((found.difference.ratio - 1.0).abs() < 0.01, "{good}");
    let (bright, found) = told(6, 1.1, gamma, &[]);
    assert!(bright.starts_with("fail: the image has 1."), "{bright}");
    assert!((found.difference.ratio - 1.1).abs() < 0.02, "{bright}");
    let (other, _) = told(7, 1.0, Encoding::of(Curve::Srgb), &[]);
    assert!(other.starts_with("fail: encoding mismatch: the codes are sRGB, rounded"), "{other}");
    let cut = Encoding { rounding: Rounding::Down, ..gamma };
    let (cut, found) = told(8, 1.0, cut, &["--truncated"]);
    assert_eq!(found.verdict, Verdict::Pass, "{cut}");
}

#[test]
fn each_image_is_compared_with_the_last() {
    let folder = tempfile::tempdir().unwrap();
    let reference = file(folder.path(), "r.pfm", &render(1, 0.02, 1.0));
    let bright = file(folder.path(), "a.pfm", &render(2, 0.02, 1.05));
    let good = file(folder.path(), "b.pfm", &render(3, 0.1, 1.0));
    let found = measured(&[&bright, &good, &reference, "--no-flip"]).unwrap();
    let verdicts: Vec<_> = found.images.iter().map(|one| one.comparison.verdict).collect();
    assert_eq!(verdicts, [Verdict::Fail, Verdict::Pass]);
    let told = told(&found);
    for name in [&bright, &good] {
        assert!(told.contains(&format!("{name} against {reference}\n")), "{told}");
    }
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!(json["images"][1]["files"][0], good.as_str());
    assert_eq!(json["images"][1]["verdict"], "pass");
    assert_eq!(json["reference"], reference.as_str());
}

#[test]
fn a_page_holds_all_images_their_noise_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let reference =
        with_errors(folder.path(), &render(1, 0.01, 1.0), &Image::new(192, 128, [2e-3; 3]));
    let bright = file(folder.path(), "<bright>.pfm", &render(2, 0.02, 1.05));
    let good = file(folder.path(), "good.pfm", &render(3, 0.1, 1.0));
    let path = folder.path().join("page.html");
    let words = [&bright, &good, path_of(&reference), "--html", path_of(&path)];
    let line = Line::try_parse_from(std::iter::once("compare").chain(words)).unwrap();
    assert_eq!(compare(&line.compare).unwrap(), ExitCode::Failed);
    let page = std::fs::read_to_string(&path).unwrap();
    assert!(page.contains("1 of 2 images differ from"), "{page:.4000}");
    assert!(page.contains("HDR-FLIP of ") && page.contains("&lt;bright&gt;.pfm"));
    let payload = page.split(r#"<script type="application/json">"#).nth(1).unwrap();
    let payload = payload.split("</script>").next().unwrap();
    let payload: serde_json::Value = serde_json::from_str(payload).unwrap();
    let frames = payload["frames"].as_array().unwrap();
    let roles: Vec<_> = frames.iter().map(|frame| frame["role"].as_str().unwrap()).collect();
    assert_eq!(roles, ["reference", "render", "render", "flip", "flip"]);
    assert!(frames[0]["noise"].is_object() && frames[1]["noise"].is_null());
    let rejected = |number: usize| frames[number]["rejected"].as_array().unwrap();
    let cell = &rejected(1)[0];
    let ratio = cell["measured"].as_f64().unwrap() / cell["expected"].as_f64().unwrap();
    assert!((ratio - 1.05).abs() < 0.02, "{cell}");
    assert!(rejected(2).is_empty(), "{:?}", rejected(2));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"), "it stands alone");
    assert!(page.contains("#images?region="), "a rejected pattern leads to its place");
}

#[test]
fn pixels_that_are_not_numbers_are_said_counted_and_shown() {
    let folder = tempfile::tempdir().unwrap();
    let reference = file(folder.path(), "r.pfm", &render(1, 0.01, 1.0));
    let mut image = render(2, 0.02, 1.0);
    image.pixels[192 + 5] = [f32::NAN; 3];
    let spoilt = file(folder.path(), "nan.pfm", &image);
    let path = folder.path().join("page.html");
    let words = [&spoilt, &reference, "--html", path_of(&path)];
    let line = Line::try_parse_from(std::iter::once("compare").chain(words)).unwrap();
    assert_eq!(compare(&line.compare).unwrap(), ExitCode::Failed);
    let page = std::fs::read_to_string(&path).unwrap();
    assert!(page.contains("1 pixel is NaN") && page.contains("(5, 1)"), "{page:.4000}");
    assert!(page.contains(r#""nan":1,"#) && page.contains(r#"src="data:image/png"#));
}

#[test]
fn variances_stand_in_the_order_of_the_images() {
    let folder = tempfile::tempdir().unwrap();
    let reference = file(folder.path(), "r.pfm", &render(1, 0.02, 1.0));
    let good = file(folder.path(), "a.pfm", &render(2, 0.1, 1.0));
    let noise = file(folder.path(), "v.pfm", &Image::new(192, 128, [1e-4; 3]));
    let words = [&good, &good, &reference, "--no-flip", "--variance", &noise];
    let refused = measured(&words).unwrap_err().message;
    assert!(refused.contains("stands 1 times for 2 images"), "{refused}");
    let words: Vec<_> = words.into_iter().chain(["--variance", &noise]).collect();
    assert_eq!(measured(&words).unwrap().images.len(), 2);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let a = file(folder.path(), "a.pfm", &render(1, 0.1, 1.0));
    let small = file(folder.path(), "small.pfm", &Image::new(8, 8, [1.0; 3]));
    assert!(compared(&[&a, &small]).unwrap_err().message.contains("differ in size"));
    assert!(compared(&[&a, "nowhere.exr"]).unwrap_err().message.contains("nowhere.exr"));
    assert!(compared(&[&a, &a, "--ignore", "0,0,999,999"]).is_err());
    let same = compared(&[&a, &a, "--no-flip"]).unwrap();
    assert!(told_of(&same).contains("equal to the last bit"));
}

#[test]
fn a_pixel_that_is_no_number_fails() {
    let folder = tempfile::tempdir().unwrap();
    let reference = file(folder.path(), "b.pfm", &render(1, 0.02, 1.0));
    let mut broken = render(2, 0.1, 1.0);
    broken.pixels[193] = [f32::NAN; 3];
    let broken = file(folder.path(), "a.pfm", &broken);
    let told = told_of(&compared(&[&broken, &reference]).unwrap());
    assert!(told.starts_with("fail: 1 pixel is NaN"), "{told}");
}
