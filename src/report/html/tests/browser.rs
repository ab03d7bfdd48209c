//! The pages in real browsers, opened from disk and driven from within: what a page saw it sends to the test that opened
//! it. Where a browser is not installed, each test says so and passes without it; `FURNACE_CHROMIUM` and
//! `FURNACE_FIREFOX` name those that are not on the path. What keeps people from reading a page, axe finds: `npm install -g
//! axe-core`, or `FURNACE_AXE` names its file.

use crate::diagnosis::{Diagnosis, Headline};
use crate::image::encoding::{Curve, Encoding};
use crate::image::exr::Exr;
use crate::image::file::load;
use crate::image::tonemap::{NOT_A_NUMBER, srgb_code, tonemap};
use crate::image::{Image, exr};
use crate::report::comparison::{Compared, Comparisons};
use crate::report::example::{Example, FAILING};
use crate::report::html::comparison::{Page as ComparisonPage, Pixels};
use crate::report::html::pixels::as_unpacked;
use crate::report::html::{BESIDE, write, write_single};
use crate::report::tree::RunTree;
use crate::run::TrialRecord;
use crate::stats::{Question, Side, compare};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use half::f16;
use serde::Deserialize;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Before all other scripts: what goes wrong is kept.
const EARLY: &str = "const drivenErrors=[];\
    addEventListener('error',e=>drivenErrors.push(e.message));\
    addEventListener('unhandledrejection',e=>drivenErrors.push(String(e.reason)));\
    console.error=console.warn=(...words)=>drivenErrors.push(words.join(' '));";
/// How long a page may take to be driven.
const PATIENCE: Duration = Duration::from_secs(120);
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
    saved: Vec<String>,
    #[serde(default)]
    hover: Value,
    #[serde(default)]
    canvas: [f64; 2],
    #[serde(default)]
    parts: Value,
    #[serde(default)]
    insets: Value,
    /// The trials of the index that a filter leaves.
    #[serde(default)]
    listed: Vec<String>,
    /// Of a page without scripts: the sizes of its images, what only scripts could use, its text.
    #[serde(default)]
    plain: Value,
    /// What axe finds that is serious, everything unfolded.
    #[serde(default)]
    barriers: Vec<String>,
}

/// A program that shows pages.
struct Browser {
    program: PathBuf,
    arguments: &'static [&'static str],
    /// The arguments of a profile of its own.
    profile: fn(&Path) -> Vec<String>,
}

const CHROMIUM: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

fn chromium() -> Option<Browser> {
    let arguments = &["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1280,900"];
    let program = installed("Chromium", "FURNACE_CHROMIUM", &CHROMIUM)?;
    let profile = |folder: &Path| vec![format!("--user-data-dir={}", folder.display())];
    Some(Browser { program, arguments, profile })
}

fn firefox() -> Option<Browser> {
    let arguments = &["--headless", "--no-remote", "--width=1280", "--height=900"];
    let program = installed("Firefox", "FURNACE_FIREFOX", &["firefox", "firefox-esr"])?;
    let profile = |folder: &Path| vec!["--profile".to_owned(), folder.display().to_string()];
    Some(Browser { program, arguments, profile })
}

fn browsers() -> impl Iterator<Item = Browser> {
    [chromium, firefox].into_iter().filter_map(|browser| browser())
}

/// Where a browser is: one that the environment names, or else the first on the path.
fn installed(name: &str, variable: &str, programs: &[&str]) -> Option<PathBuf> {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let on_path =
        |name: &&str| std::env::split_paths(&paths).map(|f| f.join(name)).find(|p| p.is_file());
    let named = std::env::var_os(variable).map(PathBuf::from);
    let found = named.or_else(|| programs.iter().find_map(on_path));
    if found.is_none() {
        println!("skipped: no {name} is installed; {variable} can name one");
    }
    found
}

impl Browser {
    fn command(&self, profile: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.args(self.arguments).args((self.profile)(profile));
        // What a browser that is ended leaves behind goes with its profile.
        command.env("TMPDIR", profile).stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// What the script of a driven page sends.
    fn seen(&self, driven: &Driven, address: &str) -> Seen {
        let profile = tempfile::tempdir().unwrap();
        let mut child = self.command(profile.path()).arg(address).spawn().unwrap();
        let text = driven.sent();
        child.kill().unwrap();
        child.wait().unwrap();
        let text = text.unwrap_or_else(|| panic!("{address} sends nothing"));
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text:.400}"))
    }
}

/// The body of a request.
fn body_of(stream: &TcpStream) -> std::io::Result<String> {
    stream.set_nonblocking(false)?;
    let mut lines = BufReader::new(stream);
    let mut length = 0;
    loop {
        let mut line = String::new();
        lines.read_line(&mut line)?;
        let line = line.trim().to_lowercase();
        if let Some(words) = line.strip_prefix("content-length:") {
            length = words.trim().parse().unwrap_or(0);
        }
        if line.is_empty() {
            break;
        }
    }
    let mut body = vec![0; length];
    lines.read_exact(&mut body)?;
    (&mut &*stream).write_all(b"HTTP/1.1 204 No Content\r\n\r\n")?;
    Ok(String::from_utf8_lossy(&body).into_owned())
}

/// The pages of a run, with a copy of one that drives itself.
struct Driven {
    /// The run stands alone in it: what stands beside a run is taken for earlier ones.
    _temporary: TempDir,
    folder: PathBuf,
    tree: RunTree,
    /// Where its pages send what they saw.
    listener: TcpListener,
}

impl Driven {
    fn of(example: &Example) -> Self {
        let temporary = tempfile::tempdir().unwrap();
        let folder = temporary.path().join("run");
        example.write(&folder);
        let tree = RunTree::load(&folder).unwrap();
        write(&tree, &folder).unwrap();
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        listener.set_nonblocking(true).unwrap();
        Self { _temporary: temporary, folder, tree, listener }
    }

    /// What the next page sends, if it does so in time.
    fn sent(&self) -> Option<String> {
        let started = Instant::now();
        while started.elapsed() < PATIENCE {
            match self.listener.accept() {
                Ok((stream, _)) => return body_of(&stream).ok(),
                Err(_) => std::thread::sleep(Duration::from_millis(20)),
            }
        }
        None
    }

    /// The address of a page that drives itself.
    fn address(&self, page: &str) -> String {
        self.address_with(page, "")
    }

    /// The same of one with more in its head.
    fn address_with(&self, page: &str, more: &str) -> String {
        let path = self.folder.join(page);
        let text = std::fs::read_to_string(&path).unwrap();
        let early = format!("<head><script>{EARLY}</script>{more}");
        let driving = format!("<script>'use strict';{DRIVE}</script></body>");
        let text = text.replacen("<head>", &early, 1).replacen("</body>", &driving, 1);
        std::fs::write(&path, text).unwrap();
        let port = self.listener.local_addr().unwrap().port();
        format!("file://{}?{port}", path.display())
    }

    /// The first images of the case, as a viewer unpacks them, in the order of the viewer.
    fn images(&self) -> Vec<Image> {
        let trial = |core: &str| {
            let of = |t: &&TrialRecord| t.core == core && t.case == "image/cornell-spheres";
            self.tree.trials.iter().find(of).unwrap()
        };
        let (ours, other) = (trial("builtin"), trial("textbook"));
        let files =
            [(ours, 0), (ours, 1), (other, 1), (ours, 2), (other, 2), (ours, 3), (other, 3)];
        let read = |(trial, number): (&TrialRecord, usize)| {
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
    let driven = Driven::of(&Example::mixed());
    let address = driven.address(CASE);
    for browser in browsers() {
        shows_the_pixels_of_the_files(&driven, &browser.seen(&driven, &address));
    }
}

fn shows_the_pixels_of_the_files(driven: &Driven, seen: &Seen) {
    assert_eq!(seen.errors, Vec::<String>::new());
    assert_eq!(seen.fetched, Vec::<String>::new());
    assert_eq!(seen.dead, Vec::<String>::new(), "keys and controls without effect");
    assert_eq!(seen.saved, ["image-cornell-spheres-images.png"; 2]);
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
    // Three layers of half the image each, to 6 bits.
    let names =
        ["whole image", "bounce 0", "bounce 1", "bounce 2", "bounces 0 to 1", "bounces 0 to 2"];
    assert_eq!(seen.parts["names"].as_array().unwrap()[..6], names);
    let number = |name: &str| seen.parts[name].as_f64().unwrap();
    let ratio = number("sum") / number("whole");
    assert!((ratio - 1.5).abs() < 0.02, "{ratio}");
    assert_eq!(
        seen.parts["labels"],
        serde_json::json!(["reference · whole image", "builtin · light sampling"])
    );
    // As high as half of a pane is wide, and in the colours of the image.
    let [without, with] = ["without", "with"].map(|name| seen.insets[name].as_f64().unwrap());
    assert!(with > without + 100.0, "{without}, {with}");
    assert_eq!(seen.insets["colour"], seen.insets["expected"]);
}

#[test]
fn tone_mapping_is_that_of_the_bench_byte_for_byte() {
    let driven = Driven::of(&Example::mixed());
    let address = driven.address(CASE);
    for browser in browsers() {
        maps_tones_as_the_bench_does(&driven, &browser.seen(&driven, &address));
    }
}

fn maps_tones_as_the_bench_does(driven: &Driven, seen: &Seen) {
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
    let driven = Driven::of(&Example::mixed());
    let view = "show=2&under=1&layout=wipe&stops=2.5&tone=filmic&channel=G&zoom=6&x=3&y=4&wipe=0.3&region=1+2+3+4\
        &insets=1,2,3,4+5,6,7,8&part=bounces+0+to+1";
    let address = format!("{}#image/cornell-spheres:images?{view}", driven.address(CASE));
    let expected = serde_json::json!({
        "show": 2, "under": 1, "layout": "wipe", "stops": 2.5, "tone": "filmic", "channel": "G",
        "zoom": 6, "x": 3, "y": 4, "wipe": 0.3, "region": [1, 2, 3, 4],
        "insets": [[1, 2, 3, 4], [5, 6, 7, 8]], "part": "bounces 0 to 1",
    });
    for browser in browsers() {
        let state = browser.seen(&driven, &address).state;
        for (name, value) in expected.as_object().unwrap() {
            assert_eq!(&state[name], value, "{name}");
        }
    }
}

#[test]
fn which_trials_were_listed_stands_in_the_address() {
    let driven = Driven::of(&Example::mixed());
    let address =
        format!("{}#trials?words=textbook+bvh&status=crashed", driven.address("index.html"));
    for browser in browsers() {
        let seen = browser.seen(&driven, &address);
        assert_eq!(seen.errors, Vec::<String>::new());
        let [listed] = &seen.listed[..] else { panic!("{:?}", seen.listed) };
        assert!(listed.contains("bvh/a-flat-box-is-hit"), "{listed}");
    }
}

/// Shows a page in a frame that runs no scripts, and sends what stands in it.
fn without_scripts(driven: &Driven, page: &str) -> String {
    let path = driven.folder.join(page);
    let text = std::fs::read_to_string(&path).unwrap();
    let text = text.replace('&', "&amp;").replace('"', "&quot;");
    let port = driven.listener.local_addr().unwrap().port();
    let show = "const inside = document.querySelector('iframe').contentDocument;\
        const isSeen = element => element.getClientRects().length > 0;\
        const shown = name => [...inside.querySelectorAll(name)].filter(isSeen);\
        const images = shown('img').map(image => [image.naturalWidth, image.clientWidth]);\
        const seen = { errors: drivenErrors, fetched: [], width: [0, 0],\
            plain: { images, scripted: shown('.scripted').length, text: inside.body.innerText } };";
    let framing = format!(
        "<!DOCTYPE html><meta charset=utf-8><script>{EARLY}function send() {{{show}\
        fetch('http://127.0.0.1:{port}/', {{ method: 'POST', mode: 'no-cors', body: JSON.stringify(seen) }});}}</script>\
        <iframe sandbox=allow-same-origin width=1280 height=900 onload=send() srcdoc=\"{text}\"></iframe>"
    );
    let framed = path.with_extension("framed.html");
    std::fs::write(&framed, framing).unwrap();
    format!("file://{}", framed.display())
}

#[test]
fn a_page_without_scripts_shows_what_matters() {
    let driven = Driven::of(&Example::mixed());
    let [index, case] = ["index.html", CASE].map(|page| without_scripts(&driven, page));
    for browser in browsers() {
        let [index, case] = [&index, &case].map(|page| browser.seen(&driven, page).plain);
        for page in [&index, &case] {
            assert_eq!(page["scripted"], 0, "controls that do nothing are seen");
        }
        let says = |page: &Value, words: &str| page["text"].as_str().unwrap().contains(words);
        assert!(says(&index, "Start here.") && says(&index, "cargo furnace run"), "{index}");
        let images = case["images"].as_array().unwrap();
        let is_shown = |image: &Value| (0..2).all(|side| image[side].as_u64().unwrap() > 0);
        assert!(images.len() >= 4 && images.iter().all(is_shown), "{images:?}");
    }
}

/// A page in the light or the dark, so many pixels wide.
fn framed(driven: &Driven, address: &str, scheme: &str, width: u32) -> String {
    let text = format!(
        "<!DOCTYPE html><meta name=color-scheme content={scheme}><body>\
        <iframe src=\"{address}\" width={width} height=844 style=\"color-scheme:{scheme}\"></iframe>"
    );
    let path = driven.folder.join("framed.html");
    std::fs::write(&path, text).unwrap();
    format!("file://{}", path.display())
}

#[test]
fn a_phone_scrolls_in_one_direction_whatever_the_core_is_called() {
    let mut example = Example::mixed();
    example.rename_core("textbook", "a-path-tracer-with-forty-letters-in-name");
    let driven = Driven::of(&example);
    for page in ["index.html", "case/bvh/a-flat-box-is-hit.html"] {
        let phone = framed(&driven, &driven.address(page), "light", 390);
        for browser in browsers() {
            let seen = browser.seen(&driven, &phone);
            assert_eq!(seen.errors, Vec::<String>::new());
            let [page_width, width] = seen.width;
            assert!(width <= 390.0 && page_width <= width, "{page}: {:?}", seen.width);
        }
    }
}

/// The pages that the index of a run takes on paper, and the file that stands alone; nothing where there is no Chromium.
fn printed(example: &Example) -> Option<[usize; 2]> {
    let chromium = chromium()?;
    let driven = Driven::of(example);
    write_single(&driven.tree, &driven.folder).unwrap();
    let pages = |name: &str| {
        let file = driven.folder.join(name).with_extension("pdf");
        let address = format!("file://{}", driven.folder.join(name).display());
        let profile = tempfile::tempdir().unwrap();
        let mut command = chromium.command(profile.path());
        command.arg(format!("--print-to-pdf={}", file.display())).arg(address).status().unwrap();
        let text = String::from_utf8_lossy(&std::fs::read(&file).unwrap()).into_owned();
        text.matches("/Type /Page\n").count()
    };
    Some(["index.html", "report.html"].map(pages))
}

/// The default suite on two cores, where nothing passes, half of it is of forty causes with much to say of each, and of the
/// other half no cause is known.
fn everything_wrong() -> Example {
    let mut example = Example::of_default_size();
    let mixed = Example::mixed().trials;
    let has_plot = |trial: &&TrialRecord| trial.core == "builtin" && trial.case == FAILING;
    let wrong = mixed.iter().find(has_plot).unwrap().outcome.clone();
    example.trials.iter_mut().for_each(|trial| trial.outcome = wrong.clone());
    let long = "the farther root is used where the nearer one is valid; ".repeat(12);
    for core in &mut example.run.cores {
        let of_core = example.trials.iter().filter(|trial| trial.core == core.spec);
        let cases: Vec<_> = of_core.map(|trial| trial.case.clone()).collect();
        let (explained, unexplained) = cases.split_at(cases.len() / 2);
        let headline = |number: usize| Headline {
            mistake: format!("{number}: {long}"),
            look_at: long.clone(),
            fix: long.clone(),
            evidence: vec![long.clone(); 4],
            ruled_out: vec![long.clone(); 4],
            explains: explained.to_vec(),
            may_follow: explained.to_vec(),
            ..Headline::default()
        };
        let headlines = (0..40).map(headline).collect();
        core.diagnosis = Some(Diagnosis { headlines, unexplained: unexplained.to_vec() });
    }
    example
}

#[test]
fn four_pages_of_paper_are_enough_whatever_fails() {
    for example in [Example::mixed(), everything_wrong()] {
        for pages in printed(&example).into_iter().flatten() {
            assert!((1..=4).contains(&pages), "{pages} pages");
        }
    }
}

/// The file that finds barriers, where it is installed.
fn axe() -> Option<PathBuf> {
    let global = || {
        let told = Command::new("npm").args(["root", "-g"]).output().ok()?;
        let folder = String::from_utf8(told.stdout).ok()?;
        Some(Path::new(folder.trim()).join("axe-core/axe.min.js"))
    };
    let file = std::env::var_os("FURNACE_AXE").map(PathBuf::from).or_else(global);
    let file = file.filter(|file| file.is_file());
    if file.is_none() {
        println!("skipped: no axe is installed; FURNACE_AXE can name its axe.min.js");
    }
    file
}

/// The page of two images that differ.
fn write_comparison(path: &Path) {
    let [image, reference] =
        [1.2, 1.0].map(|gain| Image::from_fn(64, 48, |x, y| [gain * (1 + x + y) as f32; 3]));
    let side = |image: &Image| {
        let file = path.with_extension("exr");
        exr::write(&file, &Exr::from_image(image)).unwrap();
        Side::of(load(&file, None).unwrap(), None, Vec::new())
    };
    let encoding = Encoding::of(Curve::Srgb);
    let question = Question { encoding, counted: vec![true; 64 * 48], slow_metrics: true };
    let comparison = compare(&side(&image), &side(&reference), question).unwrap();
    let images = vec![Compared { files: vec!["a.exr".to_owned()], comparison }];
    let comparisons = Comparisons { reference: "b.exr".to_owned(), images };
    let pixels = |image| Pixels { image, standard_error: None, flip: None, is_coded: false };
    let command = "furnace compare a.exr b.exr --html a.html".to_owned();
    let (images, reference) = (vec![pixels(image)], pixels(reference));
    let page = ComparisonPage { comparisons: &comparisons, images, reference, command };
    page.write(path).unwrap();
}

#[test]
fn nothing_keeps_people_from_reading_a_page() {
    let (Some(axe), Some(chromium)) = (axe(), chromium()) else { return };
    let axe = format!("<script src=\"file://{}\"></script>", axe.display());
    let driven = Driven::of(&Example::mixed());
    write_comparison(&driven.folder.join("comparison.html"));
    let beside = BESIDE.iter().map(|(name, _)| *name);
    let pages = ["index.html", CASE, "case/bvh/a-flat-box-is-hit.html", "comparison.html"];
    for page in pages.into_iter().chain(beside) {
        let address = driven.address_with(page, &axe);
        for (scheme, width) in [("light", 1280), ("dark", 390)] {
            let seen = chromium.seen(&driven, &framed(&driven, &address, scheme, width));
            assert_eq!(seen.errors, Vec::<String>::new(), "{page}");
            assert_eq!(seen.barriers, Vec::<String>::new(), "{page}, {scheme}, {width} wide");
        }
    }
}
