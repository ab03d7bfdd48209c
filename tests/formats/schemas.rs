//! Every file of the bench is as `furnace schema` says, by which editors underline; and what is not is found.

use crate::json::complaint;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use walkdir::WalkDir;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn schema(of: &str) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
    let output = command.args(["schema", of]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The files below a folder that end so, at least as many as are known to be there.
fn files(folder: &str, ending: &str, at_least: usize) -> Vec<PathBuf> {
    let entries = WalkDir::new(root().join(folder)).into_iter().map(Result::unwrap);
    let files = entries.map(walkdir::DirEntry::into_path);
    let files: Vec<_> = files.filter(|path| path.to_string_lossy().ends_with(ending)).collect();
    assert!(files.len() >= at_least, "{folder} holds {} files", files.len());
    files
}

/// Numbers, texts, lists and tables are the same in both.
fn toml(path: &Path) -> Value {
    let table: toml::Table = fs::read_to_string(path).unwrap().parse().unwrap();
    serde_json::to_value(table).unwrap()
}

fn assert_all(schema: &Value, files: &[PathBuf], read: fn(&Path) -> Value) {
    for file in files {
        assert_eq!(complaint(&read(file), schema, schema), None, "{}", file.display());
    }
}

#[test]
fn every_case_scene_suite_and_adapter_is_of_its_schema() {
    assert_all(&schema("case"), &files("cases", ".toml", 200), toml);
    assert_all(&schema("scene"), &files("scenes", ".toml", 70), toml);
    assert_all(&schema("suite"), &files("suites", ".toml", 1), toml);
    assert_all(&schema("adapter"), &files("adapters/command", ".toml", 4), toml);
}

#[test]
fn every_sidecar_of_the_example_is_of_its_schema() {
    let json = |path: &Path| serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let mut files = files("reports/example", ".json", 9);
    files.retain(|path| !path.ends_with("run.json"));
    assert_all(&schema("sidecar"), &files, json);
}

#[test]
fn what_an_editor_would_underline_is_found() {
    let (schema, path) = (schema("case"), root().join("cases/shape"));
    let right = toml(&path.join("ray-triangle-hits-are-right.toml"));
    assert_eq!(complaint(&right, &schema, &schema), None);
    let wrong = |change: fn(&mut Value)| {
        let mut case = right.clone();
        change(&mut case);
        complaint(&case, &schema, &schema).is_some()
    };
    assert!(wrong(|case| case["titel"] = json!("a key that is none")));
    assert!(wrong(|case| case["check"] = json!("no-such-check")));
    assert!(wrong(|case| case["title"] = json!(3)));
    assert!(wrong(|case| case["expect"]["no-such-key"] = json!(1)));
    assert!(wrong(|case| drop(case.as_object_mut().unwrap().remove("source"))));
}
