//! The pages in a real browser, opened from disk and driven from within. Where there is no Chromium, each test says so
//! and passes; `FURNACE_CHROMIUM` names one that is not on the path.

use crate::image::encoding::{Curve, Encoding};
use crate::image::tonemap::{NOT_A_NUMBER, srgb_code, tonemap};
use crate::image::{Image, exr};
use crate::report::example::Example;
use crate::report::html::pixels::as_unpacked;
use crate::report::html::write;
use crate::report::tree::RunTree;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use half::f16;
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Keeps a page loading until it was driven, image after image: Chromium tells of a page once it has loaded.
const HOLD: &str = "(function hold(){const image=new Image();\
    image.onload=image.onerror=()=>{document.getElementById('driven')||hold()};\
    image.src='data:image/gif,'+Math.random()})();";
/// Before all other scripts: what goes wrong is kept.
const EARLY: &str = "const drivenErrors=[];\
    addEventListener('error',e=>drivenErrors.push(e.message));\
    addEventListener('unhandledrejection',e=>drivenErrors.push(String(e.reason)));\
    console.error=console.warn=(...words)=>drivenErrors.push(words.join(' '));";
const DRIVE: &str = include_str!("drive.js");
/// The case with images of [`Example::mixed`].
const CASE: &str = "case/image/cornell-spheres.html";

#[derive(Debug, Deserialize)]
struct Seen {
    errors: Vec<String>,
    fetched: Vec<String>,
    width: [f64; 2],
    #[serde(default)]
    state: Value,
    #[serde(default)]
    values: Vec<Vec<String>>,
    #[serde(default)]
    tables: Vec<String>,
    #[serde(default)]
    shaded: Vec<Vec<String>>,
    #[serde(default)]
    dead: Vec<String>,
    #[serde(default)]
    hover: Value,
    #[serde(default)]
    canvas: [f64; 2],
}

/// A Chromium, if one is installed.
fn chromium() -> Option<PathBuf> {
    let named = std::env::var_os("FURNACE_CHROMIUM").map(PathBuf::from);
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let on_path =
        |name: &str| std::env::split_paths(&paths).map(|f| f.join(name)).find(|p| p.is_file());
    let known = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let found = named.or_else(|| known.into_iter().find_map(on_path));
    if found.is_none() {
        println!("skipped: no Chromium is installed; FURNACE_CHROMIUM can name one");
    }
    found
}

/// What Chromium answers to a page of this address.
fn browse(chromium: &Path, arguments: &[String], address: &str) -> String {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--timeout=60000"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(arguments)
        .arg(address)
        .stderr(Stdio::null())
        .output()
        .unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What the script of a driven page left in it.
fn seen(chromium: &Path, address: &str) -> Seen {
    let arguments = ["--dump-dom".to_owned(), "--window-size=1280,900".to_owned()];
    let page = browse(chromium, &arguments, address);
    let left =
        page.split("<pre id=\"driven\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let text = left.unwrap_or_else(|| panic!("nothing was driven: {} bytes", page.len()));
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text:.400}"))
}

/// The pages of a run, with a copy of one that drives itself.
struct Driven {
    folder: TempDir,
    tree: RunTree,
}

impl Driven {
    fn of(example: &Example) -> Self {
        let folder = tempfile::tempdir().unwrap();
        example.write(folder.path());
        let tree = RunTree::load(folder.path()).unwrap();
        write(&tree, folder.path()).unwrap();
        Self { folder, tree }
    }

    /// The address of a page that drives itself.
    fn address(&self, page: &str) -> String {
        let path = self.folder.path().join(page);
        let text = std::fs::read_to_string(&path).unwrap();
        let early = format!("<head><script>{EARLY}{HOLD}</script>");
        let driving = format!("<script>'use strict';{DRIVE}</script></body>");
        let text = text.replacen("<head>", &early, 1).replacen("</body>", &driving, 1);
        std::fs::write(&path, text).unwrap();
        format!("file://{}", path.display())
    }

    /// The first images of the case, as a viewer unpacks them, in the order of the viewer.
    fn images(&self) -> Vec<Image> {
        let trial = |core: &str| {
            let of =
                |t: &&crate::run::TrialRecord| t.core == core && t.case == "image/cornell-spheres";
            self.tree.trials.iter().find(of).unwrap()
        };
        let (ours, other) = (trial("builtin"), trial("textbook"));
        let files =
            [(ours, 0), (ours, 1), (other, 1), (ours, 2), (other, 2), (ours, 3), (other, 3)];
        let read = |(trial, number): (&crate::run::TrialRecord, usize)| {
            let path = self.tree.picture_path(trial, &trial.pictures[number]);
            as_unpacked(&exr::read_image(&path).unwrap())
        };
        files.map(read).to_vec()
    }
}

/// Narkowicz's fit of the ACES curve, for which no picture of furnace has a use.
fn filmic(light: f32) -> f64 {
    let light = f64::from(light).max(0.0);
    light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14)
}

/// The curves of the viewer, in its order, from exposed light to codes.
const CURVES: [fn(f32) -> u8; 4] = [
    srgb_code,
    |light| Encoding::of(Curve::Gamma(2.2)).code(f64::from(light)),
    |light| Encoding::of(Curve::Linear).code(f64::from(light)),
    |light| Encoding::of(Curve::Srgb).code(filmic(light)),
];

/// The factor of so many stops, as [`tonemap`] takes it.
fn gain(stops: f32) -> f32 {
    f64::from(stops).exp2() as f32
}

fn decoded(text: &str) -> Vec<u8> {
    BASE64_STANDARD.decode(text).unwrap()
}

#[test]
fn a_viewer_shows_the_pixels_of_the_files_and_obeys_every_key_and_control() {
    let Some(chromium) = chromium() else { return };
    let driven = Driven::of(&Example::mixed());
    let seen = seen(&chromium, &driven.address(CASE));
    assert_eq!(seen.errors, Vec::<String>::new());
    assert_eq!(seen.fetched, Vec::<String>::new());
    assert_eq!(seen.dead, Vec::<String>::new(), "keys without effect");
    assert!(seen.width[0] <= seen.width[1], "{:?}", seen.width);
    let images = driven.images();
    assert_eq!(seen.values.len(), images.len());
    for (values, image) in seen.values.iter().zip(&images) {
        for (text, value) in values.iter().zip(image.pixels.as_flattened()) {
            let shown: f64 = text.parse().unwrap();
            let same = shown == f64::from(*value) || shown.is_nan() && value.is_nan();
            assert!(same, "{text} is shown and {value} is in the file");
        }
    }
    // Four times 24 pixels, and side by side.
    assert!(seen.canvas[0] > 1000.0, "{:?}", seen.canvas);
    assert_eq!(seen.hover["pointer"], serde_json::json!([2, 1]));
    let first = images[0].pixels[24 + 2][0];
    let shown: f32 = seen.hover["rows"][0][0].as_str().unwrap().parse().unwrap();
    assert!((shown - first).abs() <= 1e-3 * first, "{shown} for {first}");
}

#[test]
fn tone_mapping_is_that_of_the_bench_byte_for_byte() {
    let Some(chromium) = chromium() else { return };
    let driven = Driven::of(&Example::mixed());
    let seen = seen(&chromium, &driven.address(CASE));
    assert_eq!([seen.tables.len(), seen.shaded.len()], [CURVES.len(); 2]);
    for (table, curve) in seen.tables.iter().zip(CURVES) {
        let table = decoded(table);
        assert_eq!(table.len(), 1 << 16);
        for code in 0..=u16::MAX {
            let light = gain(0.3) * f16::from_bits(code).to_f32();
            let expected = if light.is_nan() { 0 } else { curve(light) };
            assert_eq!(table[usize::from(code)], expected, "half float {code:#06x}");
        }
    }
    let bytes = |pixels: Vec<[u8; 3]>| -> Vec<u8> {
        pixels.into_iter().flat_map(|[r, g, b]| [r, g, b, 255]).collect()
    };
    let image = &driven.images()[1];
    assert!(image.pixels.iter().any(|pixel| pixel[0].is_nan()));
    assert_eq!(decoded(&seen.shaded[0][1]), bytes(tonemap(image, 1.3).pixels));
    for (shaded, curve) in seen.shaded.iter().zip(CURVES) {
        let colour = |pixel: &[f32; 3]| match pixel.iter().all(|value| value.is_finite()) {
            true => pixel.map(|value| curve(gain(1.3) * value)),
            false => NOT_A_NUMBER,
        };
        assert_eq!(decoded(&shaded[1]), bytes(image.pixels.iter().map(colour).collect()));
    }
}

#[test]
fn what_was_looked_at_stands_in_the_address() {
    let Some(chromium) = chromium() else { return };
    let driven = Driven::of(&Example::mixed());
    let view = "show=2&under=1&layout=wipe&stops=2.5&tone=filmic&channel=G&zoom=6&x=3&y=4&wipe=0.3&region=1+2+3+4";
    let address = driven.address(CASE);
    let state = seen(&chromium, &format!("{address}#image/cornell-spheres:images?{view}")).state;
    let expected = serde_json::json!({
        "show": 2, "under": 1, "layout": "wipe", "stops": 2.5, "tone": "filmic", "channel": "G",
        "zoom": 6, "x": 3, "y": 4, "wipe": 0.3, "region": [1, 2, 3, 4],
    });
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(&state[name], value, "{name}");
    }
}

/// A page as wide as a phone.
fn on_a_phone(driven: &Driven, page: &str) -> String {
    let address = driven.address(page);
    let text = format!(
        "<!DOCTYPE html><body><iframe src=\"{address}\" width=\"390\" height=\"844\"></iframe><script>{HOLD}\
         addEventListener('message', event => document.body.append(Object.assign(document.createElement('pre'), \
         {{ id: 'driven', textContent: event.data }})));</script>"
    );
    let path = driven.folder.path().join("phone.html");
    std::fs::write(&path, text).unwrap();
    format!("file://{}", path.display())
}

#[test]
fn a_phone_scrolls_in_one_direction_whatever_the_core_is_called() {
    let Some(chromium) = chromium() else { return };
    let mut example = Example::mixed();
    example.rename_core("textbook", "a-path-tracer-with-forty-letters-in-name");
    let driven = Driven::of(&example);
    for page in ["index.html", "case/bvh/a-flat-box-is-hit.html"] {
        let seen = seen(&chromium, &on_a_phone(&driven, page));
        assert_eq!(seen.errors, Vec::<String>::new());
        assert!(
            seen.width[1] <= 390.0 && seen.width[0] <= seen.width[1],
            "{page}: {:?}",
            seen.width
        );
    }
}

#[test]
fn the_index_prints_on_four_pages_at_most() {
    let Some(chromium) = chromium() else { return };
    let driven = Driven::of(&Example::mixed());
    let file = driven.folder.path().join("index.pdf");
    let address = format!("file://{}", driven.folder.path().join("index.html").display());
    browse(&chromium, &[format!("--print-to-pdf={}", file.display())], &address);
    let text = String::from_utf8_lossy(&std::fs::read(&file).unwrap()).into_owned();
    let pages = text.matches("/Type /Page\n").count();
    assert!((1..=4).contains(&pages), "{pages} pages");
}
