//! `furnace writeup`: everything that the course shows is there, or says why it is not; its commands make its figures;
//! and what is there is not made again.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use furnace::image::exr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use support::{compile_core, cpp_compiler, root};

/// A folder for one write-up.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
        command.args(words).arg("--project").arg(root()).arg("-q").current_dir(self.0.path());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn writeup(&self, words: &[&str]) -> Output {
        let all = ["writeup", "--budget", "quick", "-o", "."];
        self.command(&[&all[..], words].concat()).output().unwrap()
    }

    fn markdown(&self) -> String {
        std::fs::read_to_string(self.path("writeup.md")).unwrap()
    }
}

/// The first line that the command prints: made, taken, missing.
fn counts(output: &Output) -> [usize; 3] {
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let number =
        regex_lite::Regex::new(r"(\d+) figures? made in [^,]*, (\d+) taken, (\d+) missing");
    let found = number.unwrap().captures(&text).unwrap_or_else(|| panic!("{text}"));
    [1, 2, 3].map(|group| found[group].parse().unwrap())
}

/// Part, title, and the first cells of its table: the rows of the write-ups that the bench was founded on.
const SHOWN: &[(&str, &str, &[&str])] = &[
    (
        "Part 1",
        "Surface normals",
        &["CBspheres_lambertian.dae", "CBempty.dae", "CBcoil.dae", "banana.dae", "CBbunny.dae"],
    ),
    (
        "Part 2",
        "BVH",
        &[
            "cow.dae",
            "teapot.dae",
            "beetle.dae",
            "maxplanck.dae",
            "bunny.dae",
            "dragon.dae",
            "CBlucy.dae",
            "wall-e.dae",
        ],
    ),
    ("Part 3", "Hemisphere and light sampling", &["hemisphere sampling", "light sampling"]),
    ("Part 3", "Soft shadows by light rays", &["l = 1", "l = 4", "l = 16", "l = 64"]),
    ("Part 4", "bounces accumulated", DEPTHS),
    (
        "Part 4",
        "not accumulated",
        &["bounce 0", "bounce 1", "bounce 2", "bounce 3", "bounce 4", "bounce 5"],
    ),
    ("Part 4", "Direct and indirect light", &["direct light alone", "indirect light alone"]),
    ("Part 4", "stop 0.3 ", TO_A_HUNDRED),
    ("Part 4", "stop 0.35 ", TO_A_HUNDRED),
    ("Part 4", "stop 0.4 ", TO_A_HUNDRED),
    ("Part 4", "stop 0.05 ", TO_A_HUNDRED),
    (
        "Part 4",
        "Samples per pixel",
        &["s = 1", "s = 2", "s = 4", "s = 8", "s = 16", "s = 64", "s = 1024"],
    ),
    ("Part 5", "Adaptive sampling", &["CBspheres_lambertian.dae", "CBbunny.dae", "CBdragon.dae"]),
];
const DEPTHS: &[&str] = &["m = 0", "m = 1", "m = 2", "m = 3", "m = 4", "m = 5"];
const TO_A_HUNDRED: &[&str] = &["m = 0", "m = 1", "m = 2", "m = 3", "m = 4", "m = 5", "m = 100"];

/// A section of the page and its rows, the cells between bars.
fn rows<'a>(markdown: &'a str, part: &str, title: &str) -> Vec<Vec<&'a str>> {
    let mut sections = markdown.split("\n## ");
    let is_it = |section: &&str| {
        let head = section.lines().next().unwrap();
        head.starts_with(part) && head.contains(title)
    };
    let section = sections.find(is_it).unwrap_or_else(|| panic!("no {part}: {title}"));
    // Tables of images come first; their rules are of another kind.
    let table = section.lines().skip_while(|line| !line.starts_with("| --- |"));
    let lines = table.skip(1).take_while(|line| line.starts_with('|'));
    lines.map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect()).collect()
}

fn holds_every_row(markdown: &str) {
    for (part, title, labels) in SHOWN {
        let rows = rows(markdown, part, title);
        for label in *labels {
            let is_it = |row: &Vec<&str>| row[0].contains(label);
            assert!(rows.iter().any(is_it), "{part}: {title}: no row `{label}` in {rows:?}");
        }
        let is_empty = |row: &&Vec<&str>| row[1].is_empty();
        assert!(rows.iter().find(is_empty).is_none(), "{part}: {title}: {rows:?}");
    }
}

fn images(markdown: &str) -> Vec<&str> {
    markdown.split("](figures/").skip(1).map(|rest| rest.split(')').next().unwrap()).collect()
}

#[test]
fn a_core_that_can_do_all_shows_all_and_its_commands_make_the_same_figures() {
    let place = Place::new();
    let made = counts(&place.writeup(&["--size", "16x12"]));
    let markdown = place.markdown();
    holds_every_row(&markdown);
    let images = images(&markdown);
    assert!(images.len() > 70 && images.contains(&"adaptive-bunny-rate.png"), "{images:?}");
    assert!(images.iter().all(|image| place.path("figures").join(image).is_file()));
    let page = std::fs::read_to_string(place.path("writeup.html")).unwrap();
    assert_eq!(page.matches("data:image/png;base64,").count(), images.len());

    // One of each kind of setting, again by its command.
    for name in ["depth-2", "bounce-3", "roulette-30-100", "adaptive-spheres", "normals-coil"] {
        let file = place.path(&format!("figures/{name}.exr"));
        let before = exr::read_image(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        let ending = format!("-o figures/{name}.exr");
        let command = markdown.lines().find(|line| line.ends_with(&ending)).unwrap();
        let words = shell_words::split(command).unwrap();
        let words: Vec<_> = words[1..].iter().map(String::as_str).collect();
        assert!(place.command(&words).status().unwrap().success(), "{command}");
        assert!(exr::read_image(&file).unwrap() == before, "{command}");
    }

    // All are taken; but for those of another size, and one that is gone.
    let [all, 0, missing] = made else { panic!("{made:?}") };
    assert_eq!(counts(&place.writeup(&["--size", "16x12"])), [0, all, missing]);
    std::fs::remove_file(place.path("figures/light-rays-4.exr")).unwrap();
    assert_eq!(counts(&place.writeup(&["--size", "16x12"])), [1, all - 1, missing]);
    assert_eq!(counts(&place.writeup(&["--size", "12x8"])), [all, 0, missing]);
}

#[test]
fn what_a_core_cannot_do_is_a_row_that_says_so() {
    let place = Place::new();
    let library = place.path("librays.so");
    let source = root().join("tests/fixtures/writeup/rays_only.cpp");
    compile_core(&cpp_compiler(), &[], &source, &library);
    let output = place.writeup(&["--core", "./librays.so", "--size", "16x12"]);
    assert_eq!(output.status.code(), Some(5), "nothing was made");
    let markdown = place.markdown();
    holds_every_row(&markdown);
    assert!(images(&markdown).is_empty(), "an empty figure");
    for (part, title, _) in SHOWN {
        for row in rows(&markdown, part, title) {
            assert!(row[1].starts_with("not made: "), "{row:?}");
        }
    }
    for needed in ["roulette", "adaptive-sampling", "isolated-bounces", "intersect", "render"] {
        assert!(markdown.contains(needed), "{needed}");
    }
}

#[test]
fn normals_that_are_not_unit_are_shown_and_told() {
    let place = Place::new();
    let core = "textbook:sphere-normal-not-unit";
    let words = ["render", "course-cornell-box", "--normals", "--core", core, "-o", "normals.exr"];
    let output = place.command(&words).args(["--size", "16x12"]).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && told.contains("_normal has length 0."), "{told}");
    assert!(place.path("normals.exr").is_file());
}

#[test]
fn a_kill_loses_at_most_the_image_in_flight() {
    let place = Place::new();
    let words = ["writeup", "--budget", "quick", "-o", ".", "--size", "32x24"];
    let mut child = place.command(&words).spawn().unwrap();
    let kept = || records(&place.path("figures"));
    while kept() < 12 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept = kept();
    let [made, taken, missing] = counts(&place.writeup(&["--size", "32x24"]));
    assert_eq!(taken, kept);
    assert!(made > 0 && missing == 1, "{made} made, {missing} missing");
}

fn records(figures: &Path) -> usize {
    let entries = std::fs::read_dir(figures).into_iter().flatten().flatten();
    entries.filter(|entry| entry.path().extension().is_some_and(|ending| ending == "json")).count()
}

#[test]
fn a_folder_without_scenes_and_a_core_that_is_not_there_are_told_kindly() {
    let place = Place::new();
    for (words, said) in [
        (["--scenes", "nowhere"], "there is no folder `nowhere`"),
        (["--scenes", "."], "holds no .dae file"),
        (["--core", "./none.so"], "there is no file `./none.so`"),
        (["--size", "big"], "not a size"),
    ] {
        let output = place.writeup(&words);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && told.contains(said), "{told}");
    }
}
