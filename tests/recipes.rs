//! CONTRIBUTING.md is true: what its recipes name is there, and a thing of each kind is known to the files that its
//! recipe names and to no others.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use regex_lite::{Captures, Regex};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use walkdir::WalkDir;

/// A kind of thing.
struct Kind {
    /// The heading of its recipe.
    heading: &'static str,
    /// The file that has a row for each, as the recipe writes it.
    table: &'static str,
    /// In it `file` is the thing's own file, if it has one, and `word` is what others would know the thing by.
    row: &'static str,
    /// Where that word may stand too, for it means something else there, or one thing is made of another.
    beside: &'static [&'static str],
}

const KINDS: &[Kind] = &[
    Kind {
        heading: "Add a check",
        table: "src/checks/<subject>/mod.rs",
        row: r"\n    (?<word>(?<file>\w+)::\w+),",
        beside: &["src/checks/image/matches_as_png.rs"],
    },
    Kind {
        heading: "Add a cause",
        table: "src/cause/<subject>.rs",
        row: r#"\n    [A-Z0-9_]+ = (?<word>"[a-z0-9-]+"):"#,
        beside: &["src/cores/textbook/fault/", "src/checks/integrator/foretold.rs"],
    },
    Kind {
        heading: "Add a cause",
        table: "src/diagnosis/mod.rs",
        row: r"run: (?<word>(?<file>\w+)::suspect)",
        beside: &[],
    },
    Kind {
        heading: "Plant a fault",
        table: "src/cores/textbook/fault/<subject>.rs",
        row: r#"\n    (?<word>"[a-z0-9-]+"): ""#,
        beside: &["src/cause/"],
    },
    Kind {
        heading: "Add a core",
        table: "src/cores/mod.rs",
        row: r"Box::new\((?<file>\w+)::(?<word>\w+)::new",
        // The textbook's components are lent to libraries.
        beside: &["src/cores/dylib/lent.rs"],
    },
    Kind {
        heading: "Add a metric",
        table: "src/image/metric.rs",
        row: r#"", (?<file>[a-z_]+)::(?<word>\w+)\)"#,
        beside: &[],
    },
    Kind {
        heading: "Add a section to the report",
        table: "src/report/html/mod.rs",
        row: r"&(?<word>(?<file>\w+)::SECTION)",
        beside: &[],
    },
    Kind {
        heading: "Add a verb",
        table: "src/cli/mod.rs",
        row: r"\((?<file>\w+)::(?<word>\w+Arguments)\)",
        beside: &["src/cli/watch/mod.rs"],
    },
];

/// The texts of the files of some folders, by their paths; sources without their tests.
fn texts(folders: &[&str]) -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = folders.iter().flat_map(|folder| WalkDir::new(root.join(folder)));
    let text = |entry: walkdir::DirEntry| {
        let path = entry.path().strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(entry.path()).unwrap_or_default();
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        (path, code.to_owned())
    };
    let texts = files.map(Result::unwrap).filter(|entry| entry.file_type().is_file());
    texts.map(text).filter(|(path, _)| !path.ends_with("tests.rs")).collect()
}

/// The recipes by their headings.
fn recipes() -> BTreeMap<String, String> {
    let text = texts(&["CONTRIBUTING.md"]).remove("CONTRIBUTING.md").unwrap();
    let recipes = text.split("\n## ").skip(1).map(|recipe| recipe.split_once('\n').unwrap());
    recipes.map(|(heading, steps)| (heading.to_owned(), steps.to_owned())).collect()
}

/// Paths that end as this one does, with anything in place of what stands in angle brackets.
fn like(path: &str) -> Regex {
    let any = Regex::new("<[^>]*>").unwrap().replace_all(path, "[a-z0-9_-]+").replace('.', r"\.");
    Regex::new(&format!("(^|/){any}(/.+|$)")).unwrap()
}

/// Whether a path is the thing's own: `src/cli/run.rs`, or what is below `src/cli/run/`.
fn is_own(path: &str, table: &str, row: &Captures<'_>) -> bool {
    let folder = table.rsplit_once('/').unwrap().0;
    let own = row.name("file").map(|file| format!("{folder}/{}", file.as_str()));
    own.and_then(|own| path.strip_prefix(&own)).is_some_and(|rest| rest.starts_with(['.', '/']))
}

/// The files that know the thing of a row, though no recipe says so; its own one is there.
fn strays(table: &str, row: &Captures<'_>, sources: &BTreeMap<String, String>) -> Vec<String> {
    let has_own = sources.keys().any(|path| is_own(path, table, row));
    assert_eq!(has_own, row.name("file").is_some(), "{}: a file of its own", &row["word"]);
    let word = Regex::new(&format!(r"(^|[^\w-]){}([^\w-]|$)", &row["word"])).unwrap();
    let others = sources.iter().filter(|(path, _)| *path != table && !is_own(path, table, row));
    let others = others.filter(|(_, text)| text.contains(&row["word"]) && word.is_match(text));
    others.map(|(path, _)| format!("{path} names {} of {table}", &row["word"])).collect()
}

#[test]
fn a_thing_of_each_kind_is_known_to_the_files_of_its_recipe_alone() {
    let (recipes, sources) = (recipes(), texts(&["src"]));
    let mut unnamed = Vec::new();
    for Kind { heading, table, row, beside } in KINDS {
        let folder = table.trim_end_matches("<subject>.rs");
        assert!(recipes[*heading].contains(folder), "`{heading}` does not name {folder}");
        let (row, table) = (Regex::new(row).unwrap(), like(table));
        let tables = sources.iter().filter(|(path, _)| table.is_match(path));
        let rows: Vec<_> = tables
            .flat_map(|(path, text)| row.captures_iter(text).map(move |row| (path, row)))
            .collect();
        assert!(rows.len() > 1, "{heading}: no rows are found");
        let strays = rows.iter().flat_map(|(path, row)| strays(path, row, &sources));
        unnamed.extend(strays.filter(|stray| !beside.iter().any(|path| stray.starts_with(path))));
    }
    assert!(unnamed.is_empty(), "no recipe names these places:\n{}", unnamed.join("\n"));
}

/// Whether what stands between backticks is there, as far as it is a path, a verb, an option or a name of the code.
fn is_true(word: &str, paths: &BTreeMap<String, String>, code: &str) -> bool {
    let is = |pattern: &str| Regex::new(pattern).unwrap().is_match(word);
    let has = |text: String| code.contains(&text);
    if is(r"^[\w<>]+(/[\w<>]+)+(\.\w+)?/?$|^\w+\.(rs|hpp|txt)$") {
        let path = like(word.trim_end_matches('/'));
        paths.keys().any(|known| path.is_match(known))
    } else if let Some(verb) = word.strip_prefix("cargo furnace ") {
        let verb = verb.split(' ').next().unwrap();
        has(format!("{}{}({verb}::", verb[..1].to_uppercase(), &verb[1..]))
    } else if let Some(option) = word.strip_prefix("--") {
        let option = option.split(' ').next().unwrap().replace('-', "_");
        has(format!(" {option}: ")) || has(format!(" {option}s: "))
    } else if is(r"^(impl )?[A-Z]\w+(::\w+)?$|^\w+!$") {
        let name = word.trim_start_matches("impl ").trim_end_matches('!');
        let name = name.split("::").next().unwrap();
        let kinds = ["trait", "struct", "enum", "static", "const", "type", "macro_rules!"];
        kinds.iter().any(|kind| has(format!("{kind} {name}")))
    } else {
        true
    }
}

#[test]
fn what_the_recipes_name_is_there() {
    let folders = [
        "src",
        "include",
        "adapters",
        "docs",
        "cases",
        "scenes",
        "tests/contract.rs",
        "tests/abi.rs",
    ];
    let paths = texts(&folders);
    let sources = paths.iter().filter(|(path, _)| path.ends_with(".rs"));
    let code: String = sources.map(|(_, text)| text.as_str()).collect();
    let recipes = recipes().into_values().collect::<String>();
    let words = recipes.split('`').skip(1).step_by(2);
    let wrong: Vec<_> = words.filter(|word| !is_true(word, &paths, &code)).collect();
    assert!(wrong.is_empty(), "CONTRIBUTING.md names what is not there: {wrong:?}");
}

#[test]
fn the_test_finds_what_it_looks_for() {
    let paths = texts(&["src/cli"]);
    let code = paths["src/cli/mod.rs"].clone() + &paths["src/cli/reference.rs"];
    for word in ["src/cli/<verb>.rs", "cargo furnace lint", "--replace", "Verb", "cargo test"] {
        assert!(is_true(word, &paths, &code), "{word}");
    }
    for word in ["src/cli/<verb>.py", "cargo furnace dance", "--dance", "Dance", "dance!"] {
        assert!(!is_true(word, &paths, &code), "{word}");
    }
    let row = Regex::new(r"(?<file>\w+)::(?<word>\w+)").unwrap();
    let row = row.captures("lint::LintArguments").unwrap();
    let mut sources = paths;
    assert_eq!(strays("src/cli/mod.rs", &row, &sources), [""; 0]);
    sources.insert("src/run/mod.rs".to_owned(), "use crate::cli::lint::LintArguments;".to_owned());
    let found = strays("src/cli/mod.rs", &row, &sources);
    assert_eq!(found, ["src/run/mod.rs names LintArguments of src/cli/mod.rs"]);
}
