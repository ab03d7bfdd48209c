//! What `furnace grade` writes for other programs is what they document: Gradescope's results by a JSON Schema, JUnit's XML
//! by an XML Schema, GitHub's annotations by the grammar of workflow commands. The schemas are in `tests/fixtures/grade`.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod json;
mod schemas;
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
    command.env("GITHUB_STEP_SUMMARY", room.path().join("summary.md"));
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
        let summary = read("summary.md");
        assert!(summary.len() < MOST_OF_A_SUMMARY);
        assert_eq!(ragged_row(&summary), None, "{core}: {summary}");
        let told = String::from_utf8(output.stdout).unwrap();
        let commands: Vec<_> = told.lines().filter(|line| line.starts_with("::")).collect();
        assert_eq!(commands.is_empty(), core == "builtin", "{told}");
        assert!(commands.iter().all(|line| is_annotation(line)), "{commands:#?}");
    }
}

/// Bytes of a summary that GitHub shows: 1 MiB a step.
const MOST_OF_A_SUMMARY: usize = 1 << 20;

/// A row of a table that has not as many cells as the line that makes it one: GitHub's Markdown drops what is too much.
fn ragged_row(markdown: &str) -> Option<&str> {
    let cells = |line: &str| line.replace("\\\\", "").replace("\\|", "").matches('|').count();
    let mut width = None;
    markdown.lines().find(|line| {
        let is_row = line.starts_with('|');
        let is_ragged = is_row && width.is_some_and(|width| width != cells(line));
        width = is_row.then(|| width.unwrap_or(cells(line)));
        is_ragged
    })
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
    assert_eq!(ragged_row("| a | b |\n|---|---|\n| 1 \\| 2 | 3 |\n\n| one |\n"), None);
    assert_eq!(ragged_row("| a | b |\n|---|---|\n| 1 | 2 | 3 |\n"), Some("| 1 | 2 | 3 |"));
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
