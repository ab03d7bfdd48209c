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
fn a_class_goes_where_it_is_told_to() {
    let room = Room::new();
    hand_in(&room);
    let output = room.furnace(&[&CLASS[..], &["--report", "graded"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let table = room.read("graded/class.csv");
    assert!(table.lines().any(|line| line.starts_with("ada,3,10,0,3,0,")), "{table}");
    assert!(!room.path().join("classes").exists());
}

/// Whether no process has the number that a file holds, soon.
#[cfg(unix)]
fn is_gone(file: &Path) -> bool {
    let number = fs::read_to_string(file).unwrap();
    let is_there = || {
        let status = Command::new("kill").args(["-0", number.trim()]).output().unwrap().status;
        status.success()
    };
    (0..200).any(|_| {
        std::thread::sleep(Duration::from_millis(50));
        !is_there()
    })
}

#[cfg(unix)]
#[test]
fn an_interrupted_class_leaves_nothing_behind_and_goes_on() {
    let room = Room::new();
    hand_in(&room);
    // Every build waits for something that it has started, until it is told to go on.
    let wait = r#"commands = [["sh", "-c", "test -e {submission}/../../go || { sleep 600 & echo $! > waiting; wait; }"], "#;
    let suite = room.read("suites/small.toml").replace("commands = [", wait);
    room.write("suites/small.toml", &suite);
    let mut command = room.command(&CLASS);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let waiting = || -> Vec<PathBuf> {
        let builds = fs::read_dir(room.path().join("classes/small/builds")).into_iter().flatten();
        let files = builds.map(|build| build.unwrap().path().join("waiting"));
        files
            .filter(|file| fs::read_to_string(file).is_ok_and(|text| text.ends_with('\n')))
            .collect()
    };
    while waiting().len() < 2 {
        std::thread::sleep(Duration::from_millis(50));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    let told = printed(&output);
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains(" of 5 submissions graded\n"), "{told}");
    let again = shell_words::join(CLASS);
    assert!(told.ends_with(&format!("  resume  cargo furnace {again}\n")), "{told}");
    assert!(waiting().iter().all(|file| is_gone(file)));
    // That its build was ended says nothing about a submission.
    let runs = fs::read_dir(room.path().join("classes/small/runs")).into_iter().flatten();
    let grades = runs.map(|run| run.unwrap().path().join("grade.json"));
    let grades: String = grades.filter_map(|grade| fs::read_to_string(grade).ok()).collect();
    assert!(!grades.contains("does not compile"), "{grades}");
    room.write("go", "");
    assert_eq!(room.furnace(&CLASS).status.code(), Some(0));
    let table = room.read("classes/small/class.csv");
    assert!(table.contains("ada,3,10,0,3,0,"), "{table}");
}

#[test]
fn a_class_says_which_submission_is_graded_as_it_may_be_called() {
    let room = Room::new();
    hand_in(&room);
    let told = |words: &[&str]| String::from_utf8(room.furnace(words).stderr).unwrap();
    let named = told(&CLASS);
    assert!(named.starts_with("5 submissions; results go to "), "{named}");
    assert!(named.contains("  ada: 3 of 10\n"), "{named}");
    assert!(named.contains("5 of 5  "), "{named}");
    let words: Vec<_> = CLASS.into_iter().filter(|word| *word != "--names").collect();
    let unnamed = told(&words);
    assert!(unnamed.contains("  submission 1 of 5 (") && !unnamed.contains("ada"), "{unnamed}");
}

#[test]
fn a_graded_run_whose_time_was_up_goes_on() {
    let room = Room::new();
    let suite = room.read("suites/small.toml");
    room.write("suites/small.toml", &suite.replace("\"60 s\"", "\"1 ns\""));
    let output = room.furnace(&["grade", "--suite", "small", "--core", "builtin"]);
    let told = printed(&output);
    assert_eq!(output.status.code(), Some(5), "{told}");
    assert!(told.contains("  NOT RUN: 3 of 3 trials, for the time was up\n"), "{told}");
    let (_, resume) = told.split_once("  resume  cargo furnace ").unwrap();
    let words = shell_words::split(resume.lines().next().unwrap()).unwrap();
    let words: Vec<_> = words.iter().map(String::as_str).collect();
    room.write("suites/small.toml", &suite);
    // Another salt draws other numbers; and without the suite it would be another run.
    let salted = room.command(&words).env("FURNACE_SALT", "x").output().unwrap();
    assert_eq!(salted.status.code(), Some(2), "{}", printed(&salted));
    let plain = room.furnace(&["run", "--resume", words[words.len() - 1]]);
    assert!(printed(&plain).contains(resume.lines().next().unwrap()), "{}", printed(&plain));
    let output = room.furnace(&words);
    assert!(printed(&output).contains("10 of 10"), "{}", printed(&output));
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

#[test]
fn shares_of_a_class_are_merged_into_the_same_table() {
    let room = Room::new();
    hand_in(&room);
    let share = |number: &str| {
        let words = [&CLASS[..], &["--shard", number]].concat();
        let output = room.furnace(&words);
        assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    };
    share("1/2");
    let early = room.furnace(&["merge", "classes/small"]);
    assert_eq!(early.status.code(), Some(2));
    assert!(printed(&early).contains("a share is missing: 2/2"), "{}", printed(&early));
    share("2/2");
    let rows = ["class-1-of-2.json", "class-2-of-2.json"].map(|name| {
        let share = room.read(&format!("classes/small/{name}"));
        let share: serde_json::Value = serde_json::from_str(&share).unwrap();
        share["rows"].as_array().unwrap().len()
    });
    assert_eq!(rows.iter().sum::<usize>(), 6);
    assert!(rows.iter().all(|rows| *rows > 1), "{rows:?}");
    let merged = room.furnace(&["merge", "classes/small", "--into", "all"]);
    assert_eq!(merged.status.code(), Some(0), "{}", printed(&merged));
    // All of it is known by now: nothing is graded again.
    room.furnace(&CLASS);
    assert_eq!(room.read("all/class.csv"), room.read("classes/small/class.csv"));
    assert!(
        room.read("all/class.html").contains("classes/small/runs/"),
        "links lead to the shares"
    );
    let wrong = room.furnace(&[&CLASS[..], &["--shard", "3/2"]].concat());
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn a_single_submission_is_built_and_graded() {
    let room = Room::new();
    hand_in(&room);
    let grade = |name: &str| {
        let path = format!("handed-in/{name}");
        let words =
            ["grade", "--suite", "small", "--submission", &path, "--gradescope", "results.json"];
        let output = room.furnace(&words);
        let results: serde_json::Value = serde_json::from_str(&room.read("results.json")).unwrap();
        (printed(&output), results)
    };
    // It has one function: camera rays.
    let (told, results) = grade("ada");
    assert_eq!(results["score"], 3.0, "{told}");
    let (told, results) = grade("eve");
    assert!(told.contains("does not compile"), "{told}");
    assert_eq!(results["score"], 0.0);
    let (_, results) = grade("fay");
    assert!(results["output"].as_str().unwrap().contains("the submission is empty"));
}

#[test]
fn what_the_compiler_warns_of_is_told_where_a_submission_is_built() {
    let room = Room::new();
    let ends_without_return = "double never(double x) { if (x > 0) return x; }\nstruct Mine";
    let warned = camera(" / 2", "").replace("struct Mine", ends_without_return);
    room.write("handed-in/ada/mine.cpp", &warned);
    room.write("handed-in/bea/mine.cpp", &camera(" / 2", ""));
    let one = ["grade", "--suite", "small", "--submission", "handed-in/ada"];
    let told = printed(&room.furnace(&[&one[..], &["--gradescope", "results.json"]].concat()));
    let warnings = told.split("what the compiler warned of").nth(1);
    assert!(warnings.is_some_and(|it| it.contains("mine.cpp:3: ")), "{told}");
    let results: serde_json::Value = serde_json::from_str(&room.read("results.json")).unwrap();
    assert!(results["output"].as_str().unwrap().contains("mine.cpp:3: "));
    // Of a class each has its own, and they are read again when it goes on.
    for _ in 0..2 {
        let class = room.furnace(&[&CLASS[..], &["--json"]].concat());
        let grades: serde_json::Value = serde_json::from_slice(&class.stdout).unwrap();
        assert_eq!(grades[0]["warnings"][0]["line"], 3, "{grades}");
        assert!(grades[1].get("warnings").is_none());
        fs::remove_dir_all(room.path().join("classes/small/runs")).unwrap();
    }
    room.furnace(&CLASS);
    assert!(room.read("classes/small/class.html").contains("1 warning of the compiler"));
}

/// A crate without dependencies, and called as all others; `kind` of its library.
fn hand_in_crate(room: &Room, name: &str, kind: &str, from: &str, to: &str) {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/rust/core.rs");
    let source = fs::read_to_string(example).unwrap();
    assert!(source.contains(from));
    let manifest = format!(
        "[package]\nname = \"mine\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
         [lib]\ncrate-type = [\"{kind}\"]\n"
    );
    room.write(&format!("handed-in/{name}/Cargo.toml"), &manifest);
    room.write(&format!("handed-in/{name}/src/lib.rs"), &source.replace(from, to));
}

#[test]
fn a_crate_is_built_by_cargo_and_graded() {
    let room = Room::new();
    let half = "horizontal_fov / 2.0";
    hand_in_crate(&room, "ada", "cdylib", half, half);
    hand_in_crate(&room, "bea", "cdylib", half, "horizontal_fov");
    hand_in_crate(&room, "cem", "rlib", half, half);
    hand_in_crate(&room, "dan", "cdylib", half, "horizontal_fov /");
    let told = printed(&room.furnace(&CLASS));
    let table = room.read("classes/small/class.csv");
    assert!(table.contains("\nada,7,10,0,3,4,"), "{table}{told}");
    let bea = table.lines().find(|line| line.starts_with("bea,")).unwrap();
    assert!(bea.starts_with("bea,4,10,0,0,4,"), "{table}");
    assert!(table.contains("crate-type = [\"\"cdylib\"\"]"), "{table}");
    let room_is_told = table.contains(&*room.path().to_string_lossy());
    assert!(table.contains("it does not compile: `cargo` says") && !room_is_told, "{table}");
    // Cargo writes beside a manifest, and that would be another submission.
    assert!(!room.path().join("handed-in/ada/Cargo.lock").exists());
    let again = room.furnace(&CLASS);
    assert_eq!(room.read("classes/small/class.csv"), table, "{}", printed(&again));
}

#[test]
fn a_build_that_takes_too_long_is_ended() {
    let room = Room::new();
    let suite = room.read("suites/small.toml");
    let (head, _) = suite.split_once("commands").unwrap();
    let slow = format!("{head}time = \"1 s\"\ncommands = [[\"sleep\", \"600\"]]\n");
    room.write("suites/small.toml", &slow);
    room.write("handed-in/gus/mine.cpp", "");
    let begun = std::time::Instant::now();
    let told = printed(&room.furnace(&CLASS));
    assert!(told.contains("it does not compile in time: `sleep` took over 1.0 s"), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(60));
}

/// What a student of the sample class has changed in `examples/cpp`: file, text, other text.
type Changes = &'static [[&'static str; 3]];

/// Two that are right, eight mistakes, a crash and an endless loop. Two more do not compile and are empty.
const FOURTEEN: [(&str, Changes); 12] = [
    ("ada-right", &[]),
    ("bea-in-single-precision", &[["types.hpp", "#define REAL double", "#define REAL float"]]),
    (
        "cem-whole-fov",
        &[["pathtracer.cpp", "camera.horizontal_fov) / 2", "camera.horizontal_fov)"]],
    ),
    ("dan-y-down", &[["pathtracer.cpp", "(2 * film.y - 1)", "(1 - 2 * film.y)"]]),
    (
        "eli-box-without-z",
        &[[
            "shapes.hpp",
            "axis < 3; ++axis) {\n         Real from",
            "axis < 2; ++axis) {\n         Real from",
        ]],
    ),
    (
        "fay-brdf-without-pi",
        &[["surfaces.hpp", "Rgb(m.reflectance) / PI, wi.z / PI", "Rgb(m.reflectance), wi.z / PI"]],
    ),
    ("gus-pdf-uniform", &[["surfaces.hpp", "/ PI, wi.z / PI}", "/ PI, 1 / (2 * PI)}"]]),
    (
        "hal-no-shadows",
        &[[
            "scene.hpp",
            "if (bvh.any(v.ray_along(s.wi, s.distance), unused)) return {0, 0, 0};",
            "(void)unused;",
        ]],
    ),
    (
        "ida-normal-not-unit",
        &[[
            "shapes.hpp",
            "normal() const { return unit(cross_edges); }",
            "normal() const { return cross_edges; }",
        ]],
    ),
    ("jon-no-t-max", &[["shapes.hpp", "ray.t_min < t && t < ray.t_max", "ray.t_min < t"]]),
    (
        "kim-crashes",
        &[[
            "pathtracer.cpp",
            "Real x = (2 * film.x - 1)",
            "__builtin_trap();\n   Real x = (2 * film.x - 1)",
        ]],
    ),
    (
        "lea-hangs",
        &[[
            "pathtracer.cpp",
            "Real x = (2 * film.x - 1)",
            "for (volatile int i = 0;;) i = i;\n   Real x = (2 * film.x - 1)",
        ]],
    ),
];

/// The suite of the sample class: some of parts 1 to 3.
const SAMPLE: &str = r#"
title   = "A sample class"
version = "1"
budget  = "quick"

[[part]]
name   = "Part 1: rays and intersections"
points = 40
cases  = ["rays-pass-through", "image-is-upright", "ray-sphere-hit", "ray-triangle"]

[[part]]
name   = "Part 2: BVH"
points = 30
cases  = ["bvh/flat-boxes", "bvh/triangle-soup-hits"]

[[part]]
name   = "Part 3: direct light"
points = 30
cases  = ["point-light-follows", "light/rectangle-light-slanted-matches", "bsdf/diffuse"]

[build]
time     = "5 min"
makes    = "libmine"
commands = [["c++", "-std=c++17", "-O1", "-shared", "-fPIC", "-I{bench}/include", "{submission}/pathtracer.cpp", "-o", "{build}/libmine.so"]]
"#;

fn hand_in_fourteen(room: &Room) {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cpp");
    room.write("suites/sample.toml", SAMPLE);
    for (name, changes) in FOURTEEN {
        for entry in fs::read_dir(&examples).unwrap().map(Result::unwrap) {
            let file = entry.file_name().into_string().unwrap();
            let mut text = fs::read_to_string(entry.path()).unwrap();
            for [_, from, to] in changes.iter().filter(|change| change[0] == file) {
                assert!(text.contains(from), "{file} does not say `{from}`");
                text = text.replacen(from, to, 1);
            }
            room.write(&format!("handed-in/{name}/{file}"), &text);
        }
    }
    room.write("handed-in/max-does-not-compile/pathtracer.cpp", "int main( {");
    fs::create_dir_all(room.path().join("handed-in/nia-empty")).unwrap();
}

/// Twenty kills, each a while after the start.
#[test]
#[ignore = "takes a quarter of an hour"]
fn a_class_of_fourteen_killed_twenty_times_has_the_table_of_one_that_was_not() {
    const WORDS: [&str; 9] = [
        "grade",
        "--suite",
        "sample",
        "--submissions",
        "handed-in",
        "--names",
        "--jobs",
        "2",
        "--time-limit=8",
    ];
    let room = Room::new();
    hand_in_fourteen(&room);
    let known = |room: &Room| {
        let runs = fs::read_dir(room.path().join("classes/sample/runs")).into_iter().flatten();
        runs.flatten().filter(|run| run.path().join("grade.json").is_file()).count()
    };
    // Times that look random, and are the same in every run of this test.
    let mut state = 1_u64;
    for kill in 1..=20 {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let after = Duration::from_millis(1_000 + (state >> 33) % 11_000);
        let command = &mut room.command(&WORDS);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(after);
        let ended = child.try_wait().unwrap().is_some();
        _ = child.kill();
        child.wait().unwrap();
        let how = if ended { "had ended before" } else { "killed" };
        println!(
            "{kill:2}: {how} after {:4.1} s, {} of 14 graded",
            after.as_secs_f64(),
            known(&room)
        );
    }
    let told = printed(&room.furnace(&WORDS));
    println!("{told}");
    let fresh = Room::new();
    hand_in_fourteen(&fresh);
    let begun = std::time::Instant::now();
    fresh.furnace(&WORDS);
    println!("never killed: {:.0} s", begun.elapsed().as_secs_f64());
    let table = room.read("classes/sample/class.csv");
    // What a compiler says goes on over lines.
    let names = FOURTEEN.map(|(name, _)| name);
    for name in names.into_iter().chain(["max-does-not-compile", "nia-empty"]) {
        assert!(table.lines().any(|line| line.starts_with(&format!("{name},"))), "{name}: {table}");
    }
    assert_eq!(fresh.read("classes/sample/class.csv"), table);
}
