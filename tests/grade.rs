//! `furnace grade` from outside: a core, one that never opens, and a class that is killed and goes on.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// A room with a suite of two small parts, whose submissions are single files in C++.
struct Room(tempfile::TempDir);

impl Room {
    fn new() -> Self {
        let room = Self(tempfile::tempdir().unwrap());
        let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned());
        let suite = format!(
            r#"
title   = "A small class"
version = "1"
budget  = "quick"
time    = "60 s"

[[part]]
name   = "Camera"
points = 6
cases  = ["rays-pass-through", "image-is-upright"]

[[part]]
name   = "Spheres"
points = 4
cases  = ["ray-sphere-hit-is"]

[build]
makes    = "libmine"
commands = [["{compiler}", "-std=c++17", "-O1", "-shared", "-fPIC", "-I{{bench}}/include", "{{submission}}/mine.cpp", "-o", "{{build}}/libmine.so"]]
"#
        );
        room.write("suites/small.toml", &suite);
        room
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
        command.args(words).current_dir(self.path()).stdin(Stdio::null());
        command.env("FURNACE_CACHE", self.path().join("cache"));
        command.env_remove("FURNACE_HOME").env_remove("FURNACE_SALT");
        command
    }

    fn furnace(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap()
    }
}

fn printed(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|words| String::from_utf8_lossy(words)).concat()
}

/// A camera with its field of view taken so, and what else the type has.
fn camera(half: &str, more: &str) -> String {
    format!(
        r#"#include "furnace_core.hpp"
#include <csignal>
struct Mine {{
   furnace_ray generate_ray(const furnace_camera &camera, furnace_vec2 film) {{
      {more}
      double x = (2 * film.x - 1) * std::tan(camera.horizontal_fov{half});
      double y = (2 * film.y - 1) * std::tan(camera.vertical_fov{half});
      auto direction = furnace::unit(x * camera.right + y * camera.up - camera.backward);
      return {{camera.position, camera.near_clip, direction, camera.far_clip}};
   }}
}};
FURNACE_CORE(Mine, "mine", "0.1", FURNACE_DETERMINISTIC)
"#
    )
}

/// Right, wrong, equally wrong, crashing, not compiling, empty.
fn hand_in(room: &Room) {
    let right = camera(" / 2", "");
    let wrong = camera("", "");
    for (name, text) in [
        ("ada", right),
        ("bea", wrong.clone()),
        ("cem", wrong),
        ("dan", camera(" / 2", "std::raise(SIGSEGV);")),
        ("eve", "int main( {".to_owned()),
    ] {
        room.write(&format!("handed-in/{name}/mine.cpp"), &text);
    }
    fs::create_dir_all(room.path().join("handed-in/fay")).unwrap();
}

const CLASS: [&str; 9] = [
    "grade",
    "--suite",
    "small",
    "--submissions",
    "handed-in",
    "--names",
    "--jobs",
    "2",
    "--isolate",
];

#[test]
fn a_core_is_graded_into_every_format_and_again_from_its_run() {
    let room = Room::new();
    let files = ["--gradescope", "results.json", "--junit", "grade.xml", "--csv", "grade.csv"];
    let summary = room.path().join("summary.md");
    let words =
        [&["grade", "--suite", "small", "--core", "builtin", "--github"][..], &files].concat();
    let output = room.command(&words).env("GITHUB_STEP_SUMMARY", &summary).output().unwrap();
    let told = printed(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("10 of 10") && told.contains("2 of 2 pass"), "{told}");
    let results: serde_json::Value = serde_json::from_str(&room.read("results.json")).unwrap();
    assert_eq!(results["score"], 10.0);
    assert!(room.read("grade.xml").contains("tests=\"2\""));
    assert_eq!(room.read("grade.csv").lines().count(), 4);
    assert!(fs::read_to_string(summary).unwrap().contains("10 of 10"));
    let run = fs::read_dir(room.path().join("reports/runs")).unwrap().next().unwrap().unwrap();
    let again =
        room.furnace(&["grade", "--suite", "small", "--run", &run.path().to_string_lossy()]);
    assert!(printed(&again).contains("10 of 10"), "{}", printed(&again));
}

#[test]
fn a_core_that_is_not_there_has_a_valid_file_with_nothing_earned() {
    let room = Room::new();
    let words =
        ["grade", "--suite", "small", "--core", "./gone.so", "--gradescope", "results.json"];
    let output = room.furnace(&words);
    assert_eq!(output.status.code(), Some(1), "{}", printed(&output));
    let results: serde_json::Value = serde_json::from_str(&room.read("results.json")).unwrap();
    assert_eq!(results["score"], 0.0);
    assert!(results["output"].as_str().unwrap().contains("gone.so"));
}

#[test]
fn a_class_is_graded_at_once_and_ends_the_same_however_often_it_was_killed() {
    let room = Room::new();
    hand_in(&room);
    // Killed early, in the middle, and late.
    for milliseconds in [300, 1500, 3000] {
        let mut child =
            room.command(&CLASS).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(milliseconds));
        _ = child.kill();
        child.wait().unwrap();
    }
    let output = room.furnace(&CLASS);
    let told = printed(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let table = room.read("classes/small/class.csv");
    let row = |name: &str| table.lines().find(|line| line.starts_with(name)).unwrap().to_owned();
    assert!(row("ada").starts_with("ada,3,10,0,3,0,"), "{table}");
    assert!(row("bea").starts_with("bea,") && !row("bea").starts_with("bea,3"), "{table}");
    assert_eq!(row("bea")[3..], row("cem")[3..], "equal submissions have equal grades");
    assert!(row("dan").starts_with("dan,0,10,0,"), "{table}");
    assert!(table.contains("does not compile"), "{table}");
    assert!(row("fay").contains("the submission is empty"), "{table}");
    // The same class elsewhere, never killed.
    let fresh = Room::new();
    hand_in(&fresh);
    fs::copy(room.path().join("suites/small.toml"), fresh.path().join("suites/small.toml"))
        .unwrap();
    fresh.furnace(&CLASS);
    assert_eq!(fresh.read("classes/small/class.csv"), table);
    let page = room.read("classes/small/class.html");
    assert!(page.contains("bea, cem"), "those with the same mistake stand together");
}

#[test]
fn a_class_tells_no_names_unless_asked() {
    let room = Room::new();
    room.write("handed-in/ada-lovelace/mine.cpp", "int main( {");
    let words = ["grade", "--suite", "small", "--submissions", "handed-in"];
    let told = printed(&room.furnace(&words));
    let folder: PathBuf = room.path().join("classes/small");
    let all = [
        fs::read_to_string(folder.join("class.csv")),
        fs::read_to_string(folder.join("class.html")),
    ];
    let all = all.map(Result::unwrap).concat() + &told;
    assert!(!all.contains("lovelace"), "{all}");
}
