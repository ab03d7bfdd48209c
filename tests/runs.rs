//! A run is data that does not depend on when, how often, or in how many goes it was made.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::run::{TrialRecord, record};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use walkdir::WalkDir;

/// A few cases of each kind: deterministic, statistical, with pictures.
const FILTERS: &[&str] = &["shape/", "light/point-light-", "adaptive/"];

fn furnace(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
    command.stdout(Stdio::null()).stderr(Stdio::null()).stdin(Stdio::null());
    command
}

/// How a command ends whose words nobody reads, and what it complains of.
fn complaint(arguments: &[&str]) -> (Option<i32>, String) {
    let mut child =
        furnace(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_word_that_is_nearly_a_verb_tries_nothing() {
    let lines: [&[&str]; 4] = [
        &["-q", "lint"],
        &["--project", ".", "lint"],
        &["--budget", "quick", "list", "causes"],
        &["expalin", "roulette"],
    ];
    for line in lines {
        let (code, complaint) = complaint(line);
        assert_eq!(code, Some(2), "{line:?}: {complaint}");
        assert!(complaint.contains("verb"), "{line:?}: {complaint}");
    }
}

#[test]
fn a_filter_that_selects_nothing_is_an_error_wherever_filters_are_taken() {
    let lines: [&[&str]; 8] = [
        &["run", "bvh/", "nohwere"],
        &["run", "!nohwere"],
        &["list", "cases", "nohwere"],
        &["list", "causes", "nohwere"],
        &["explain", "nohwere"],
        &["faults", "nohwere"],
        &["faults", "brdf-without-pi", "nohwere"],
        &["agreement", "--core", "builtin", "nohwere"],
    ];
    for line in lines {
        let (code, complaint) = complaint(line);
        assert_eq!(code, Some(4), "{line:?}: {complaint}");
        assert!(complaint.contains("`nohwere`\nhint: "), "{line:?}: {complaint}");
    }
}

/// What lint says of a project with one case, whose file ends so.
fn lint(end: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new("scenes").join("sphere-furnace.toml");
    let case = Path::new("cases/integrator").join("asked.toml");
    for file in [&scene, &case] {
        std::fs::create_dir_all(folder.path().join(file).parent().unwrap()).unwrap();
    }
    let original = Path::new(env!("CARGO_MANIFEST_DIR")).join(&scene);
    std::fs::copy(original, folder.path().join(&scene)).unwrap();
    let head = "title = \"x\"\nteaches = \"x\"\nsource = \"x\"\n";
    std::fs::write(folder.path().join(&case), format!("{head}{end}")).unwrap();
    let (code, complaint) = complaint(&["lint", "--project", &folder.path().to_string_lossy()]);
    assert_eq!(code, Some(2), "{complaint}");
    complaint
}

#[test]
fn what_a_case_says_of_scenes_is_underlined_in_the_case() {
    let expect = "[expect]\nrow = [{ bounces = [0, 1], radiance = 1 }]\n\
                  ray = { from = [0, 0, 0], toward = [0, 0, 1] }\n\
                  detects = \"1 %\"\nat-most = \"1 k paths\"\n";
    let choices = [
        ("\"sphere-furnice\"", "did you mean `sphere-furnace`?"),
        ("{ name = \"sphere-furnace\", albdo = 1 }", "did you mean `albedo`?"),
        ("{ name = \"sphere-furnace\", albedo = 7 }", "invalid reflectance or transmittance 7"),
    ];
    for (choice, words) in choices {
        let said = lint(&format!("check = \"mean-radiance\"\nscene = {choice}\n{expect}"));
        assert!(said.contains("asked.toml:5:") && said.contains(words), "{said}");
    }
    let said = lint(
        "check = \"radiance-is-finite\"\n[expect]\nscenes = [\"sphere-furnice\"]\n\
         size = [4, 4]\nsamples-per-pixel = 1\nbounces = [0, 1]\n",
    );
    assert!(said.contains("asked.toml:6:") && said.contains("`sphere-furnace`"), "{said}");
}

#[test]
fn a_reader_who_has_read_enough_ends_nothing() {
    let runs = tempfile::tempdir().unwrap();
    let run = ["run", "bvh/", "--core", "builtin", "--budget", "quick", "--report"];
    let folder = runs.path().to_string_lossy();
    let run = [&run[..], &[&*folder]].concat();
    for line in [&["list"][..], &["list", "checks"], &["explain", "shape/"], &run] {
        assert_eq!(complaint(line).0, Some(0), "{line:?}: {}", complaint(line).1);
    }
    assert!(only_run(runs.path()).unwrap().join("index.html").is_file());
}

fn run_arguments<'a>(runs: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let fixed = ["run", "--budget", "quick", "--report", runs];
    fixed.iter().chain(FILTERS).chain(more).copied().collect()
}

/// The one run below `runs`.
fn only_run(runs: &Path) -> Option<PathBuf> {
    let mut folders = std::fs::read_dir(runs).ok()?.map(|entry| entry.unwrap().path());
    let folder = folders.next();
    assert!(folders.next().is_none(), "more than one run");
    folder
}

fn sidecar_paths(folder: &Path) -> Vec<PathBuf> {
    let files = WalkDir::new(folder).into_iter().map(|entry| entry.unwrap().into_path());
    files
        .filter(|path| path.extension().is_some_and(|e| e == "json") && !path.ends_with("run.json"))
        .collect()
}

/// Every sidecar without its times, and every picture's bytes.
fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut results = BTreeMap::new();
    for path in sidecar_paths(folder) {
        let mut trial: TrialRecord = record::read_json(&path).unwrap();
        trial.timing.seconds = 0.0;
        for picture in &trial.pictures {
            let bytes = std::fs::read(path.with_file_name(&picture.file)).unwrap();
            results.insert(format!("{}/{}/{}", trial.core, trial.case, picture.file), bytes);
        }
        let name = format!("{}/{}", trial.core, trial.case);
        results.insert(name, serde_json::to_vec(&trial).unwrap());
    }
    results
}

#[test]
fn the_same_run_twice_in_one_go_or_killed_half_way_gives_the_same_sidecars() {
    let whole = tempfile::tempdir().unwrap();
    let runs = whole.path().to_string_lossy().into_owned();
    let status = furnace(&run_arguments(&runs, &["-j", "2"])).status().unwrap();
    assert!(status.success(), "the whole run ended with {status}");
    let expected = results(&only_run(whole.path()).unwrap());
    assert!(expected.len() >= 8, "{} sidecars", expected.len());

    let killed = tempfile::tempdir().unwrap();
    let runs = killed.path().to_string_lossy().into_owned();
    let mut child = furnace(&run_arguments(&runs, &["-j", "1"])).spawn().unwrap();
    wait_for_sidecars(killed.path(), 3);
    child.kill().unwrap();
    child.wait().unwrap();
    let folder = only_run(killed.path()).unwrap();
    let kept = sidecar_paths(&folder).len();
    assert!(kept < expected.len(), "it was killed too late to show anything");

    let resume = ["run", "--resume", &folder.to_string_lossy()].map(ToOwned::to_owned);
    let status = furnace(&resume.iter().map(String::as_str).collect::<Vec<_>>()).status().unwrap();
    assert!(status.success(), "the resumed run ended with {status}");
    let resumed = results(&folder);
    let run = std::fs::read_to_string(folder.join("run.json")).unwrap();
    assert!(run.contains("\"diagnosis\""), "a run that has ended says what is wrong: {run}");
    let run: serde_json::Value = serde_json::from_str(&run).unwrap();
    let counts = &run["counts"];
    let graded = counts["graded"].as_object().unwrap().values().map(|n| n.as_u64().unwrap());
    let counted = graded.sum::<u64>() + counts["ungraded"].as_u64().unwrap();
    let all = sidecar_paths(&folder).len() as u64;
    assert_eq!([&counts["planned"], &run["trials"]], [all, all], "{counts}");
    assert_eq!(counted, all, "{counts}");
    assert_eq!(resumed.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    for (name, bytes) in &expected {
        assert!(resumed[name] == *bytes, "{name} differs after the run was resumed");
    }
}

fn wait_for_sidecars(runs: &Path, count: usize) {
    let limit = Instant::now() + Duration::from_secs(60);
    while only_run(runs).map_or(0, |folder| sidecar_paths(&folder).len()) < count {
        assert!(Instant::now() < limit, "no sidecars after a minute");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn nothing_selected_has_its_own_exit_code() {
    let status = furnace(&["run", "no-case-is-called-this"]).status().unwrap();
    assert_eq!(status.code(), Some(4));
}

#[test]
fn an_unknown_core_is_a_wrong_request() {
    let status = furnace(&["run", "--core", "embree"]).status().unwrap();
    assert_eq!(status.code(), Some(2));
}
