//! What `furnace grade` writes for other programs is what they document: Gradescope's results by a JSON Schema, JUnit's XML
//! by an XML Schema, GitHub's annotations by the grammar of workflow commands. The schemas are in `tests/fixtures/grade`.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod json;
mod xml;

use regex_lite::Regex;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const SUITE: &str = r#"
title   = "A small suite"
version = "1"
budget  = "quick"

[[part]]
name   = "Camera"
points = 6
cases  = ["rays-pass-through", "image-is-upright"]
hidden = 1

[[part]]
name   = "Spheres & <others>"
points = 4
cases  = ["ray-sphere-hit-is", "ray-sphere-hits-are-right"]
"#;

fn fixture(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/grade");
    fs::read_to_string(folder.join(name)).unwrap()
}

/// Grades a core, and answers the folder with what was written.
fn graded(core: &str) -> (tempfile::TempDir, Output) {
    let room = tempfile::tempdir().unwrap();
    fs::create_dir(room.path().join("suites")).unwrap();
    fs::write(room.path().join("suites/small.toml"), SUITE).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
    command.args(["grade", "--suite", "small", "--core", core, "--github"]);
    command.args(["--gradescope", "results.json", "--junit", "grade.xml"]);
    command.current_dir(room.path()).env("FURNACE_CACHE", room.path().join("cache"));
    command.env_remove("FURNACE_HOME").env_remove("FURNACE_SALT");
    let output = command.output().unwrap();
    (room, output)
}

/// Right, wrong, and not there at all.
const CORES: [&str; 3] = ["builtin", "textbook:sphere-near-root-only", "./not-there.so"];

#[test]
fn every_format_is_as_it_is_documented() {
    let schema: serde_json::Value =
        serde_json::from_str(&fixture("gradescope.schema.json")).unwrap();
    let xsd = fixture("junit.xsd");
    for core in CORES {
        let (room, output) = graded(core);
        let read = |name: &str| fs::read_to_string(room.path().join(name)).unwrap();
        let results = serde_json::from_str(&read("results.json")).unwrap();
        assert_eq!(json::complaint(&results, &schema, &schema), None, "{core}");
        assert_eq!(xml::complaint(&read("grade.xml"), &xsd), None, "{core}");
        let told = String::from_utf8(output.stdout).unwrap();
        let commands: Vec<_> = told.lines().filter(|line| line.starts_with("::")).collect();
        assert_eq!(commands.is_empty(), core == "builtin", "{told}");
        assert!(commands.iter().all(|line| is_annotation(line)), "{commands:#?}");
    }
}

/// `::error title=…::message`: in properties `%`, line ends, `:` and `,` are escaped, in messages the first two.
fn is_annotation(line: &str) -> bool {
    let value = "(?:[^%:,\r\n]|%25|%0A|%0D|%3A|%2C)+";
    let name = "(?:title|file|line|endLine|col|endColumn)";
    let message = "(?:[^%\r\n]|%25|%0A|%0D)+";
    let grammar =
        format!("^::(?:error|warning|notice)(?: {name}={value}(?:,{name}={value})*)?::{message}$");
    Regex::new(&grammar).unwrap().is_match(line)
}

#[test]
fn what_breaks_a_grammar_is_found() {
    assert!(is_annotation("::error title=a%3A b::half: 50%25%0Aof it"));
    for wrong in [
        "::error title=a: b::c",
        "::error title=a::50 %",
        "::fatal title=a::c",
        "::error name=a::c",
        ":error::c",
    ] {
        assert!(!is_annotation(wrong), "{wrong}");
    }
}
