//! The tree is the architecture: a module names only lower layers, and two modules of one layer do not name each
//! other. This test is that rule.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The layer of each module of the library. A new module belongs here before anything can name it.
const LAYERS: &[(&str, u32)] = &[
    ("math", 0),
    ("disk", 0),
    ("text", 0),
    ("cause", 1),
    ("image", 1),
    ("project", 1),
    ("stats", 2),
    ("scene", 3),
    ("contract", 4),
    ("worker", 5),
    ("cores", 6),
    ("checks", 6),
    ("case", 7),
    ("diagnosis", 8),
    ("run", 9),
    ("agreement", 10),
    ("faults", 10),
    ("report", 10),
    ("reference", 10),
    ("cli", 11),
];

/// `unsafe` stands in these files alone.
const UNSAFE_FILES: &[&str] =
    &["src/cores/builtin/trace/simd.rs", "src/cores/dylib.rs", "src/worker/confine_linux.rs"];

fn source_files() -> Vec<PathBuf> {
    fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let mut files = Vec::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
    files.sort();
    files
}

/// Path below the project, with forward slashes.
fn label(path: &Path) -> String {
    let inside = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
    inside.to_string_lossy().replace('\\', "/")
}

/// The module of the library that a file belongs to; none for `lib.rs` and `main.rs`.
fn module_of(path: &Path) -> Option<String> {
    let label = label(path);
    let inside = label.strip_prefix("src/").unwrap();
    let first = inside.split('/').next().unwrap().trim_end_matches(".rs");
    (!["lib", "main"].contains(&first)).then(|| first.to_owned())
}

/// Every module that `crate::…` names in a text, comments aside.
fn named_modules(text: &str) -> Vec<String> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
        .filter(|name: &String| !name.is_empty())
        .collect()
}

#[test]
fn modules_name_only_lower_layers() {
    let layers: BTreeMap<_, _> = LAYERS.iter().copied().collect();
    let mut breaches = Vec::new();
    for path in source_files() {
        let Some(module) = module_of(&path) else { continue };
        let layer = *layers.get(module.as_str()).unwrap_or_else(|| {
            panic!("module `{module}` has no layer; add it to LAYERS in tests/architecture.rs")
        });
        for named in named_modules(&fs::read_to_string(&path).unwrap()) {
            let Some(other) = layers.get(named.as_str()) else {
                breaches.push(format!("{}: `crate::{named}` has no layer", label(&path)));
                continue;
            };
            if named != module && *other >= layer {
                breaches.push(format!(
                    "{}: {module} (layer {layer}) names {named} (layer {other})",
                    label(&path)
                ));
            }
        }
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn the_two_cores_do_not_know_each_other() {
    for path in source_files() {
        let label = label(&path);
        let text = fs::read_to_string(&path).unwrap();
        for (core, other) in [("builtin", "textbook"), ("textbook", "builtin")] {
            if label.starts_with(&format!("src/cores/{core}/")) {
                assert!(!text.contains(&format!("{other}::")), "{label} names {other}");
            }
        }
    }
}

/// Whether a text has `unsafe` code. The type of a C function, `unsafe extern "C" fn(…)`, is none: only calling one is.
fn has_unsafe(text: &str) -> bool {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let words: Vec<_> = code
        .flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_'))
        .filter(|word| !word.is_empty())
        .collect();
    words.windows(2).any(|pair| pair[0] == "unsafe" && pair[1] != "extern")
}

#[test]
fn unsafe_stands_where_it_is_allowed() {
    for path in source_files() {
        let text = fs::read_to_string(&path).unwrap();
        let label = label(&path);
        assert!(
            !has_unsafe(&text) || UNSAFE_FILES.contains(&label.as_str()),
            "{label} has `unsafe`"
        );
    }
}

#[test]
fn lints_are_expected_with_a_reason_and_never_allowed() {
    for path in source_files() {
        let text = fs::read_to_string(&path).unwrap();
        assert!(!text.contains("#[allow("), "{} allows a lint", label(&path));
    }
}

#[test]
fn the_test_finds_what_it_looks_for() {
    let text = "use crate::run::Plan;\n// crate::cli is only mentioned\nlet x = crate::math::rng::Seed(1);";
    assert_eq!(named_modules(text), ["run", "math"]);
    assert!(has_unsafe("let x = unsafe { *pointer };"));
    assert!(has_unsafe("unsafe impl Send for Core {}"));
    assert!(!has_unsafe("type Entry = unsafe extern \"C\" fn(u32);"));
}
