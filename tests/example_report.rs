//! The report in `reports/example` is what furnace writes today: its pages follow byte for byte from the records beside
//! them, and those records from the core, but for what a clock says. `FURNACE_BLESS=1 cargo test --test example_report`
//! makes it again; on a busy machine the search for the proof may be cut short, and the pages then say so.
//!
//! Compared with a fresh run are outcomes, measures and images, numbers to nine digits: another machine's sine may
//! differ in the last. Left out is what is measured in seconds, and what follows from it: how much of `run.json`'s
//! search there was time for.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::image::exr;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A mistake of part 1 that an image shows, and cases that pass beside those that fail for it.
const RUN: &[&str] = &[
    "run",
    "camera/",
    "bvh/flat-boxes",
    "light/point-light-follows",
    "!constant-radiance",
    "image/two-lights-three-spheres",
    "--core",
    "textbook:half-pixel-added",
    "--budget",
    "quick",
];
/// All that stands in the folder.
const MOST_BYTES: u64 = 1_200_000;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn furnace(words: &[&str]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
    command.args(words).current_dir(root()).env_remove("FURNACE_SALT").env_remove("FURNACE_HOME");
    let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status().unwrap();
    assert!(matches!(status.code(), Some(0 | 1)), "furnace {}: {status}", words.join(" "));
}

/// A run of today, in a folder below this one.
fn run_in(folder: &Path) -> PathBuf {
    furnace(&[RUN, &["--report", &folder.to_string_lossy()]].concat());
    let mut runs = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    runs.find(|run| run.join("run.json").is_file()).unwrap()
}

/// Every file below a folder, by its path in it.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let entries = walkdir::WalkDir::new(folder).into_iter().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.file_type().is_file());
    files.map(|entry| entry.path().strip_prefix(folder).unwrap().to_owned()).collect()
}

fn ends_with(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|ending| endings.iter().any(|one| ending == *one))
}

fn copy(from: &Path, to: &Path, wanted: impl Fn(&Path) -> bool) {
    for file in files(from).iter().filter(|file| wanted(file)) {
        std::fs::create_dir_all(to.join(file).parent().unwrap()).unwrap();
        std::fs::copy(from.join(file), to.join(file)).unwrap();
    }
}

/// Without what a clock says, and with numbers to nine digits.
fn lasting(value: &Value) -> Value {
    match value {
        Value::Number(number) => match number.as_f64() {
            Some(number) => Value::String(format!("{number:.8e}")),
            None => value.clone(),
        },
        Value::Array(values) => values.iter().map(lasting).collect(),
        Value::Object(fields) => {
            let kept = fields.iter().filter(|(name, _)| *name != "timing");
            Value::Object(kept.map(|(name, value)| (name.clone(), lasting(value))).collect())
        }
        _ => value.clone(),
    }
}

fn record(path: &Path) -> Value {
    lasting(&serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap())
}

fn is_sidecar(path: &Path) -> bool {
    ends_with(path, &["json"]) && path != Path::new("run.json")
}

#[test]
fn the_example_is_what_furnace_writes_today() {
    let example = root().join("reports/example");
    let scratch = tempfile::tempdir().unwrap();
    let fresh = run_in(scratch.path());
    if std::env::var_os("FURNACE_BLESS").is_some() {
        let _ = std::fs::remove_dir_all(&example);
        copy(&fresh, &example, |_| true);
    }
    the_pages_follow_from_the_records(&example);
    the_records_follow_from_the_core(&example, &fresh);
    let bytes = |file: &PathBuf| example.join(file).metadata().unwrap().len();
    let all: u64 = files(&example).iter().map(bytes).sum();
    assert!(all < MOST_BYTES, "the example has {all} bytes");
}

fn the_pages_follow_from_the_records(example: &Path) {
    let temporary = tempfile::tempdir().unwrap();
    let again = temporary.path().join("run");
    copy(example, &again, |file| ends_with(file, &["json", "exr"]));
    furnace(&["report", &again.to_string_lossy()]);
    assert_eq!(files(example), files(&again));
    for file in files(example) {
        let [old, new] = [example, &again].map(|folder| std::fs::read(folder.join(&file)));
        assert!(old.unwrap() == new.unwrap(), "{} is out of date; see above", file.display());
    }
}

fn the_records_follow_from_the_core(example: &Path, fresh: &Path) {
    let sidecars = |folder| files(folder).into_iter().filter(|file| is_sidecar(file));
    let all: BTreeSet<_> = sidecars(example).collect();
    assert_eq!(all, sidecars(fresh).collect());
    assert!(all.len() > 8, "{all:?}");
    for file in &all {
        assert_eq!(record(&example.join(file)), record(&fresh.join(file)), "{}", file.display());
    }
    let images = files(example).into_iter().filter(|file| ends_with(file, &["exr"]));
    for image in images {
        let [old, new] =
            [example, fresh].map(|folder| exr::read_image(&folder.join(&image)).unwrap());
        let pairs = old.pixels.as_flattened().iter().zip(new.pixels.as_flattened());
        let is_close = |(old, new): (&f32, &f32)| (old - new).abs() <= 1e-5 * old.abs().max(1e-3);
        assert!(pairs.into_iter().all(is_close), "{}", image.display());
    }
}
