//! The verbs of every day, typed as at a terminal: what failed again, often, since when; completions, manual pages, colours.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A folder of its own.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
        command.args(words.split(' '));
        command.current_dir(self.path()).env("COLUMNS", "100").stdin(Stdio::null());
        for variable in ["FURNACE_HOME", "FURNACE_SALT", "NO_COLOR", "CLICOLOR_FORCE"] {
            command.env_remove(variable);
        }
        command
    }

    fn furnace(&self, words: &str) -> Output {
        self.command(words).output().unwrap()
    }

    /// What is printed as a result, and the exit code.
    fn told(&self, words: &str) -> (String, i32) {
        let output = self.furnace(words);
        let complaint = String::from_utf8(output.stderr).unwrap();
        assert!(!complaint.contains("panicked"), "{complaint}");
        (String::from_utf8(output.stdout).unwrap(), output.status.code().unwrap())
    }

    /// The folders of runs, the earliest first.
    fn runs(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path().join("runs")).unwrap();
        let mut runs: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
        runs.sort();
        runs
    }
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// One case that passes and one that fails, in a second.
const WRONG: &str =
    "run bvh/flat-boxes camera/rays-pass --core textbook:flat-box-missed --report runs";

#[test]
fn what_failed_is_tried_again_alone() {
    let place = Place::new();
    assert_eq!(place.told(WRONG).1, 1);
    let (told, code) = place.told("run --failed --report runs");
    assert_eq!(code, 1, "{told}");
    assert!(told.contains("\n  1 trial in ") && told.contains(": 1 fail\n"), "{told}");
    let run = json(&place.runs()[1].join("run.json"));
    assert_eq!(run["filters"], serde_json::json!(["bvh/flat-boxes-are-hit"]));
    assert_eq!(run["cores"][0]["spec"], "textbook:flat-box-missed");
    // Mended: the same on another core.
    let (told, code) = place.told("run --failed --core textbook --report runs");
    assert_eq!(code, 4, "{told}");
    assert_eq!(place.told("run bvh/flat-boxes --core textbook --report runs").1, 0);
    let output = place.furnace("run --failed --report runs");
    assert_eq!(output.status.code(), Some(4));
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains("nothing failed in the last run"), "{complaint}");
}

#[test]
fn a_run_is_repeated_with_other_numbers_each_time() {
    let place = Place::new();
    let (told, code) = place.told(&format!("{WRONG} --seed 7 --repeat 3"));
    assert_eq!(code, 1, "{told}");
    assert!(told.contains("0 of 3 pass  bvh/flat-boxes-are-hit"), "{told}");
    assert!(told.contains("fails with --seed 7, --seed 8, --seed 9"), "{told}");
    assert!(told.ends_with("\n  1 of 2 cases pass 3 times of 3\n"), "{told}");
    let runs = place.runs();
    let seeds: Vec<_> =
        runs.iter().map(|run| json(&run.join("run.json"))["seed"].clone()).collect();
    assert_eq!(seeds, [7, 8, 9]);
}

/// A smooth mesh.
const SMOOTH_SPHERE: &str = r#"
title  = "A smooth mesh"
source = "none"

[camera]
position       = [0, 0, 5]
look-at        = [0, 0, 0]
horizontal-fov = "40 deg"
film           = [32, 32]

[material.white]
diffuse = 0.5

[[shape]]
name      = "sphere"
material  = "white"
icosphere = { radius = 1, subdivisions = 1 }
shading   = "smooth"

[[light]]
point = { position = [0, 3, 0], intensity = 1 }
"#;

/// A normal that is not unit moves no hit: it is told, and what is timed is timed.
#[test]
fn a_core_whose_normals_are_not_unit_is_timed_all_the_same() {
    let place = Place::new();
    fs::write(place.path().join("sphere.toml"), SMOOTH_SPHERE).unwrap();
    place.told("export sphere.toml --format collada -o scenes");
    let scenes = place.path().join("scenes");
    fs::rename(scenes.join("scene.dae"), scenes.join("cow.dae")).unwrap();
    let core = "textbook:interpolated-normal-not-unit";
    let (told, code) = place.told(&format!("bench cow --scenes scenes --rounds 1 --core {core}"));
    assert_eq!(code, 0, "{told}");
    assert!(told.contains("All hits that were compared are equal."), "{told}");
    let breaches: Vec<_> = told.lines().filter(|line| line.contains("made unit")).collect();
    assert!(breaches.len() == 1 && breaches[0].starts_with(core), "{told}");
}

#[test]
fn history_tells_what_earlier_runs_have_reached() {
    let place = Place::new();
    let (_, code) = place.told("history --report runs");
    assert_eq!(code, 4, "there is none yet");
    place.told(WRONG);
    place.told("run bvh/flat-boxes --core textbook --report runs");
    let (told, code) = place.told("history --report runs");
    let rows: Vec<_> = told.lines().collect();
    assert_eq!((code, rows.len()), (0, 3), "{told}");
    assert!(rows[1].contains("textbook:flat-box-missed") && rows[1].contains("1 of 2"), "{told}");
    assert!(rows[2].contains("1 of 1") && rows[2].ends_with("bvh/flat-boxes"), "{told}");
    let (told, _) = place.told("history --report runs --core textbook --json");
    let one: serde_json::Value = serde_json::from_str(told.trim_end()).unwrap();
    assert_eq!((&one["passes"], &one["graded"]), (&1.into(), &1.into()));
    let (told, _) = place.told("history --report runs --number 1");
    assert!(told.ends_with("1 result before these: `--number N` shows more\n"), "{told}");
}

/// What bash completes after these words.
fn completed(script: &str, words: &[&str]) -> Option<String> {
    let typed: Vec<_> = words.iter().map(|word| shell_words::quote(word)).collect();
    let last = words.len() - 1;
    let (word, before) = (&typed[last], &typed[last - 1]);
    let ask = format!(
        "{script}\nCOMP_WORDS=({}); COMP_CWORD={last}; _furnace furnace {word} {before}; echo \"${{COMPREPLY[*]}}\"",
        typed.join(" ")
    );
    let output = Command::new("bash").args(["-c", &ask]).output().ok()?;
    assert!(output.status.success(), "{output:?}");
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn a_shell_completes_verbs_and_flags() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let (script, code) = place.told(&format!("completions {shell}"));
        assert_eq!(code, 0);
        assert!(script.contains("grade") && script.contains("submissions"), "{shell}");
        assert!(!script.contains("The worker process"), "{shell}: what is hidden is not completed");
    }
    let (script, _) = place.told("completions bash");
    let Some(verbs) = completed(&script, &["furnace", "gr"]) else {
        println!("nothing is completed here: there is no bash");
        return;
    };
    assert_eq!(verbs.trim(), "grade");
    assert_eq!(completed(&script, &["furnace", "work"]).unwrap().trim(), "");
    let flags = completed(&script, &["furnace", "grade", "--sub"]).unwrap();
    assert_eq!(flags.trim(), "--submission --submissions");
}

#[test]
fn every_verb_has_a_manual_page() {
    let place = Place::new();
    let (told, code) = place.told("man --out pages");
    assert_eq!((code, told.as_str()), (0, "pages/furnace.1\n"));
    let (help, _) = place.told("--help");
    let (_, verbs) = help.split_once("Commands:\n").unwrap();
    let verbs = verbs.lines().take_while(|line| !line.trim().is_empty());
    let rows = verbs.filter_map(|line| line.strip_prefix("  ").filter(|row| !row.starts_with(' ')));
    let names = rows.filter_map(|row| row.split_whitespace().next());
    let names: Vec<_> = names.filter(|name| *name != "help").collect();
    assert!(names.len() > 15, "{names:?}");
    for name in names {
        let page =
            fs::read_to_string(place.path().join(format!("pages/furnace-{name}.1"))).unwrap();
        assert!(page.contains(".SH NAME\n") && page.contains(".SH SYNOPSIS\n"), "{name}");
    }
}

#[test]
fn colour_is_there_where_it_is_wanted() {
    let place = Place::new();
    let run = "run bvh/flat-boxes --core textbook --report runs";
    let is_coloured = |flags: &str, variable: Option<[&str; 2]>| {
        let mut command = place.command(&format!("{run}{flags}"));
        command.envs(variable.map(|[name, value]| (name, value)));
        String::from_utf8(command.output().unwrap().stdout).unwrap().contains('\x1b')
    };
    assert!(!is_coloured("", None), "a pipe is no terminal");
    assert!(is_coloured(" --color always", None));
    assert!(is_coloured(" --color always", Some(["NO_COLOR", "1"])), "who asks for it has it");
    assert!(!is_coloured(" --color never", Some(["CLICOLOR_FORCE", "1"])));
    assert!(is_coloured("", Some(["CLICOLOR_FORCE", "1"])));
    assert!(!is_coloured("", Some(["NO_COLOR", "1"])));
    assert_eq!(place.told(&format!("{run} --color sometimes")).1, 2);
}

/// What a command writes to a terminal with these variables, if one can be had here.
#[cfg(target_os = "linux")]
fn on_a_terminal(place: &Place, words: &str, variables: &[(&str, &str)]) -> Option<String> {
    let program = shell_words::quote(env!("CARGO_BIN_EXE_furnace"));
    let typed = format!("{program} {words}");
    let mut command = Command::new("script");
    command.args(["-qec", &typed, "/dev/null"]).current_dir(place.path()).stdin(Stdio::null());
    for variable in ["TERM_PROGRAM", "LC_TERMINAL", "NO_COLOR", "CLICOLOR_FORCE"] {
        command.env_remove(variable);
    }
    let output = command.envs(variables.iter().copied()).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_can_is_shown_images() {
    let place = Place::new();
    let render = "render cornell-diffuse-spheres --size 32x24 --spp 1 -o a.png";
    let kitty = [("TERM", "xterm-kitty")];
    let Some(told) = on_a_terminal(&place, render, &kitty) else {
        println!("nothing is shown here: there is no `script`");
        return;
    };
    assert!(told.contains("\x1b_Ga=T,f=100,q=2,c="), "{told:?}");
    let shows = |words: &str, variables: &[(&str, &str)]| {
        let told = on_a_terminal(&place, words, variables).unwrap();
        told.contains("\x1b_G") || told.contains("\x1b]1337;")
    };
    let compare = "compare a.png a.png --no-flip";
    assert!(shows(compare, &kitty));
    assert!(shows(compare, &[("TERM", "xterm-256color"), ("TERM_PROGRAM", "WezTerm")]));
    assert!(!shows(compare, &[("TERM", "xterm-256color")]), "it does not say that it can");
    assert!(!shows(&format!("{compare} --color never"), &kitty));
    assert!(!shows(&format!("{compare} --json"), &kitty), "JSON stays JSON");
    let piped = place.command(compare).envs(kitty).output().unwrap();
    assert!(!piped.stdout.contains(&0x1b), "a pipe is no terminal");
}

#[test]
fn a_single_answer_is_asked_for_and_what_is_not_there_is_said() {
    let place = Place::new();
    let case = "shape/ray-sphere-hit-is-the-nearest-root-ahead";
    let words = format!("debug {case} --core textbook:sphere-near-root-only");
    let (told, code) = place.told(&words);
    assert_eq!(code, 1, "{told}");
    assert!(told.contains("yours     a miss\n    textbook  t = 2,"), "{told}");
    assert!(told.contains("origin: (1.0, 2.0, 3.0)"), "{told}");
    let (told, code) = place.told(&format!("{words} --ask 1:2"));
    assert_eq!(code, 0, "{told}");
    assert!(told.contains("1 answer: 1 not as textbook's"), "{told}");
    let complaint = |ask: &str| {
        let output = place.furnace(&format!("{words} --ask {ask}"));
        assert_eq!(output.status.code(), Some(4));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(complaint("1:99").contains("has 14 elements, counted from 0"), "{}", complaint("1:99"));
    assert!(complaint("9:0").contains("asks 1 question"), "{}", complaint("9:0"));
    let output = place.furnace("debug bsdf/ --core textbook");
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains(" more") && complaint.len() < 400, "{complaint}");
}
