//! What people read at a terminal, word for word: every message and every ending stands in `tests/terminal/*.txt`, to
//! be reviewed. `FURNACE_BLESS=1 cargo test --test terminal` writes them again; `git diff` shows what has changed.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A project of its own, whose folder is called `HERE` in the texts.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    /// What is printed by `furnace` with these words, and the code it ends with.
    fn told(&self, words: &str) -> String {
        let output = self.command(words).output().unwrap();
        let mut text = format!("$ furnace {words}\n");
        for printed in [output.stderr, output.stdout] {
            text += &self.without_what_changes(&String::from_utf8(printed).unwrap());
        }
        write!(text, "[{}]\n\n", output.status.code().unwrap()).unwrap();
        text
    }

    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
        command.args(words.replace("CASES", &root().to_string_lossy()).split(' '));
        command.current_dir(self.0.path()).env("COLUMNS", "80").stdin(Stdio::null());
        command.env_remove("FURNACE_HOME").env_remove("FURNACE_SALT");
        command.env("FURNACE_CACHE", self.0.path().join("cache"));
        command
    }

    /// Folders, times and the numbers of this machine.
    fn without_what_changes(&self, text: &str) -> String {
        let here = self.0.path().canonicalize().unwrap();
        let text = text.replace(&*here.to_string_lossy(), "HERE");
        let text = text.replace(&*self.0.path().to_string_lossy(), "HERE");
        let text = text.replace(&*root().to_string_lossy(), "CASES");
        [
            (r"\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d(_\d+)?", "TIME"),
            (r" +(\d+ m \d\d s|\d+(\.\d)? m?s)\b", " SECONDS"),
        ]
        .iter()
        .fold(text, |text, (pattern, word)| {
            let pattern = regex_lite::Regex::new(pattern).unwrap();
            pattern.replace_all(&text, *word).into_owned()
        })
    }
}

/// Compares with the text that was reviewed, or writes it.
fn review(name: &str, told: &str) {
    let path = root().join("tests/terminal").join(name).with_extension("txt");
    if std::env::var_os("FURNACE_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, told).unwrap();
    }
    let reviewed = std::fs::read_to_string(&path).unwrap_or_default();
    let mut lines = told.lines().zip(reviewed.lines());
    let differing = lines.find(|(told, reviewed)| told != reviewed);
    assert!(
        told == reviewed,
        "{} is out of date, first in {differing:?}; FURNACE_BLESS=1 writes it again",
        path.display()
    );
}

fn all(place: &Place, commands: &[&str]) -> String {
    commands.iter().map(|words| place.told(words)).collect()
}

#[test]
fn what_is_mistyped_is_answered_with_what_was_meant() {
    let place = Place::new();
    place.write("adapter.toml", "programm = [\"render\"]\n");
    let commands = [
        "lsit --project CASES",
        "run roulete --project CASES",
        "run bvh !trangle --project CASES",
        "run integrater/furnace --project CASES",
        "run @prat-1 --project CASES",
        "run 9 --project CASES",
        "explain roulete --project CASES",
        "faults roulete --project CASES",
        "faults 17 --project CASES",
        "list lsit --project CASES",
        "list causes albdo --project CASES",
        "list checks mean-radience --project CASES",
        "list cores txtbook --project CASES",
        "run --core txtbook --project CASES",
        "run --core textbok:brdf-without-pi --project CASES",
        "run --core textbook:brdf-without-py --project CASES",
        "run --core brdf-without-pi --project CASES",
        "run --core ./libnope.so --project CASES",
        "run --core nope.toml --project CASES",
        "run --core adapter.toml --project CASES",
        "run --core exec:nope --project CASES",
        "run --core what --project CASES",
        "run --with bdsf --project CASES",
        "run --budget quik --project CASES",
        "run --budgt quick --project CASES",
        "run --seed -4 --project CASES",
        "run -j 0 --project CASES",
        "run -q -v --project CASES",
        "run --time-limit 0 --project CASES",
        "run --memory-limit 4 --project CASES",
        "run --resume nowhere --project CASES",
        "report nowhere --project CASES",
        "report --project nowhere",
        "report --writeup --project CASES",
        "list --project nowhere",
        "run --core builtin --project nowhere",
        "export sphere-furnac --format pbrt -o out --project CASES",
        "export sphere-furnace --format pbrtt -o out --project CASES",
        "reference verify cornel --project CASES",
        "reference verify nothing-like-it --project CASES",
        "reference lst --project CASES",
        "agreement --core builtin cornel-box --project CASES",
        "bench teapt-1k --core builtin --project CASES",
        "bench cow --core builtin --project CASES",
        "render sphere-furnac -o image.exr --project CASES",
        "render sphere-furnace --set albdo=0.5 -o image.exr --project CASES",
        "render cornell-diffuse-spheres --set albedo=0.5 -o image.exr --project CASES",
        "run camera/rays-pass --core builtin -q --report runs --project CASES",
        "history --core bultin --report runs --project CASES",
        "report runs --project CASES",
        "report runs/latest --project CASES",
    ];
    review("mistyped", &all(&place, &commands));
}

/// A case that is right.
const CASE: &str = r#"title   = "The furnace matches its geometric series, bounce by bounce"
teaches = "Each bounce adds albedo times the one before"
source  = "Closed form: bounce m is emission * albedo^m"
tags    = ["part-4"]
check   = "mean-radiance"
scene   = { name = "sphere-furnace", albedo = [0.37, 0.53, 0.71], emission = [0.7, 0.5, 0.9] }

[expect]
ray     = { from = [0.1, -0.2, 0.05], toward = [0.3, 0.2, 0.9] }
detects = "0.5 %"
at-most = "6 M paths"

[[expect.row]]
bounces  = [0, 0]
radiance = [0.7, 0.5, 0.9]
"#;

#[test]
fn what_is_wrong_in_a_file_is_shown_in_the_file() {
    let place = Place::new();
    let scene = std::fs::read_to_string(root().join("scenes/sphere-furnace.toml")).unwrap();
    let mistakes = [
        (CASE, scene.clone()),
        (&CASE.replace("check ", "chekc "), scene.clone()),
        (&CASE.replace("mean-radiance", "mean-radience"), scene.clone()),
        (&CASE.replace("sphere-furnace", "sphere-furnac"), scene.clone()),
        (
            &CASE.replace(
                "{ name = \"sphere-furnace\", albedo",
                "{ name = \"sphere-furnace\", albdo",
            ),
            scene.clone(),
        ),
        (&CASE.replace("[0.37,", "[1.37,"), scene.clone()),
        (&CASE.replace("detects = \"0.5 %\"", "detects = \"0.5 m\""), scene.clone()),
        (&CASE.replace("radiance = [0.7,", "radiance = [nan,"), scene.clone()),
        (&CASE.replace("[0, 0]", "[3, 0]"), scene.clone()),
        (CASE, scene.replace("look-at", "lok-at")),
        (CASE, scene.replace("\"$albedo\"", "\"$albdo\"")),
        (CASE, scene.replace("material = \"wall\"", "material = \"wal\"")),
        (CASE, scene.replace("\"60 deg\"", "\"60 dog\"")),
    ];
    let mut told = String::new();
    for (case, scene) in mistakes {
        place.write("cases/integrator/furnace.toml", case);
        place.write("scenes/sphere-furnace.toml", &scene);
        told += &place.told("lint");
    }
    place.write("cases/integrator/of-mine.toml", &CASE.replace("[0.37,", "[1.37,"));
    place.write("scenes/sphere-furnace.toml", &scene);
    told += &place.told("run of-mine --core textbook");
    review("files", &told);
}

#[test]
fn a_run_ends_with_what_to_do() {
    let place = Place::new();
    let commands = [
        "run camera/rays-pass bvh/flat-boxes --core textbook --report runs --project CASES",
        "run camera/rays-pass bvh/flat-boxes --core textbook --report runs -q --project CASES",
        "run bsdf/diffuse --core textbook:brdf-without-pi --budget quick --report runs --project CASES",
        "run bvh/flat-boxes --core textbook:flat-box-missed --report runs --project CASES",
        "run shape/distant-spheres shape/ray-sphere-hit-is --core textbook:sphere-near-root-only -j 1 --report runs --project CASES",
        "run shape/ --core textbook:sphere-far-root --report runs -q --project CASES",
        "run shape/ --core textbook:sphere-far-root --report runs --fail-fast -j 1 --project CASES",
        "run camera/rays-pass --core textbook --core textbook:camera-transposed --report runs --project CASES",
    ];
    review("endings", &all(&place, &commands));
}

#[test]
fn the_end_is_a_dozen_lines() {
    let place = Place::new();
    for core in
        ["textbook", "textbook:brdf-without-pi", "textbook:sphere-far-root+half-pixel-added"]
    {
        let words = format!(
            "run shape/ camera/ bsdf/d --core {core} --budget quick --report runs --project CASES"
        );
        let told = place.told(&words);
        let lines: Vec<_> = told.lines().collect();
        let verdicts = ["  FAIL  ", "  PASS  "];
        let verdict = |line: &&str| verdicts.iter().any(|word| line.starts_with(word));
        let last = lines.iter().rposition(verdict).unwrap();
        // The code that it ends with stands below.
        assert!(lines.len() - last - 2 <= 12, "{told}");
    }
}

/// Ends without a word about it, as `cat` does.
#[test]
fn a_closed_pipe_is_no_panic() {
    let place = Place::new();
    for words in [
        "list --project CASES",
        "run bvh/flat-boxes --core textbook --report runs --project CASES",
        "--help",
    ] {
        let mut child =
            place.command(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert!(!complaint.contains("panicked"), "{words}: {complaint}");
        assert_eq!(output.status.code(), Some(0), "{words}: {complaint}");
    }
}

#[test]
fn a_closed_standard_error_is_no_panic() {
    let place = Place::new();
    let words = "run bvh/flat-boxes --core textbook:flat-box-missed --report runs --project CASES";
    let mut child =
        place.command(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(place.0.path().join("runs").is_dir());
}

/// What is known by then is told, and how to go on.
#[cfg(unix)]
#[test]
fn an_interrupted_run_says_how_to_go_on() {
    let place = Place::new();
    let words = "run integrator/ --core textbook -j 1 --report runs --project CASES";
    let mut command = place.command(words);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let is_under_way = || {
        let runs = std::fs::read_dir(place.0.path().join("runs")).ok();
        runs.is_some_and(|mut runs| runs.any(|run| run.unwrap().path().join("textbook").is_dir()))
    };
    while !is_under_way() {
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains("\n  UNFINISHED: "), "{told}");
    assert!(told.contains("\n  resume  cargo furnace run --resume runs/"), "{told}");
    assert!(told.contains("\n  report  file://"), "{told}");
}
