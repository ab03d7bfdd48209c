//! The pages that nobody writes: verbs, keys, checks, cases, mistakes and decisions.

use crate::keys::Types;
use crate::text::{below, pages_below};
use regex_lite::Regex;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Said below the title of each.
const NOTE: &str = "<!-- Written by `FURNACE_BLESS=1 cargo test --test book`. -->\n";
/// What a star beside a key means.
const STAR: &str = "A star marks what may be left out.\n";

/// Every generated page: where it goes below the book's sources, and its text.
pub fn pages() -> Vec<(String, String)> {
    let types = Types::read();
    let mut pages = vec![
        ("reference/verbs.md".to_owned(), verbs()),
        ("reference/cases.md".to_owned(), keys_of_cases(&types)),
        ("reference/checks.md".to_owned(), checks(&types)),
        ("reference/scenes.md".to_owned(), keys_of_scenes(&types)),
        ("reference/suites.md".to_owned(), keys_of_suites(&types)),
        ("reference/adapters.md".to_owned(), keys_of_adapters(&types)),
        ("reference/references.md".to_owned(), keys_of_recipes(&types)),
        ("reference/mistakes.md".to_owned(), mistakes()),
    ];
    pages.extend(parts());
    pages.extend(decisions());
    pages
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap().replace("\r\n", "\n")
}

/// What furnace prints, and whether it was content.
fn furnace(words: &[&str]) -> (bool, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
    command.args(words).current_dir(root()).env_remove("FURNACE_HOME").env("COLUMNS", "100");
    let output = command.output().unwrap();
    (output.status.success(), String::from_utf8(output.stdout).unwrap().replace("\r\n", "\n"))
}

fn verbs() -> String {
    let mut page = format!("# Verbs and options\n\n{NOTE}\n");
    page.push_str("Without a verb furnace does what `furnace run` does. In a checkout, `cargo furnace` stands for `cargo run --release --`.\n");
    of_verb(&mut page, &[]);
    page
}

fn of_verb(page: &mut String, verb: &[String]) {
    let words: Vec<_> = verb.iter().map(String::as_str).chain(["--help"]).collect();
    let help = furnace(&words).1;
    let title = [&["furnace".to_owned()], verb].concat().join(" ");
    let _ = write!(page, "\n## {title}\n\n```text\n{}\n```\n", help.trim_end());
    let inner = help.split("Commands:\n").nth(1).unwrap_or_default();
    let inner = inner.lines().take_while(|line| !line.is_empty());
    for line in inner.filter(|line| line.starts_with("  ") && !line.starts_with("   ")) {
        let word = line.split_whitespace().next().unwrap();
        if word != "help" {
            of_verb(page, &[verb, &[word.to_owned()]].concat());
        }
    }
}

fn keys_of_cases(types: &Types) -> String {
    let keys = types.table("Head", "case/file.rs");
    format!(
        "# Keys of a case\n\n{NOTE}\nA case is `cases/<subject>/<claim>.toml`. What stands in `[expect]` depends on its check: [every check](checks.md). {STAR}{keys}"
    )
}

fn checks(types: &Types) -> String {
    let mut page = format!(
        "# Checks and their keys\n\n{NOTE}\nA case says `check = \"…\"`, and in `[expect]` what that check takes. {STAR}"
    );
    let checks = types.checks();
    for (_, title, subjects) in parts_of_the_course() {
        for subject in subjects {
            let _ = write!(page, "\n## {subject}: {title}\n");
            for check in checks.iter().filter(|check| check.subject == subject) {
                let _ = write!(page, "\n### {}\n\n{}.\n", check.name, capitalised(&check.summary));
                page.push_str(&types.of_check(check));
            }
        }
    }
    page
}

fn keys_of_scenes(types: &Types) -> String {
    let mut page = format!(
        "# Keys of a scene\n\n{NOTE}\nA scene is `scenes/<name>.toml`. {STAR}\n## The file\n"
    );
    page.push_str(&types.table("SceneFile", "scene/file/mod.rs"));
    for (heading, file) in [
        ("[camera]", "scene/file/camera.rs"),
        ("[material.name]", "scene/file/material.rs"),
        ("[[shape]]", "scene/file/shape.rs"),
        ("[[light]]", "scene/file/light.rs"),
    ] {
        let _ = write!(page, "\n## {heading}\n{}", types.table("Entry", file));
    }
    page
}

fn keys_of_suites(types: &Types) -> String {
    let keys = types.table("Suite", "grade/suite.rs");
    format!(
        "# Keys of a suite\n\n{NOTE}\nA suite is `suites/<name>.toml`; [Grade a core, or a class](../grading.md) says what it is for. {STAR}{keys}"
    )
}

fn keys_of_adapters(types: &Types) -> String {
    let keys = types.table("Adapter", "cores/command/adapter.rs");
    format!(
        "# Keys of an adapter\n\n{NOTE}\nAn adapter describes a program that renders images: [Other renderers](../adapters.md). {STAR}{keys}"
    )
}

fn keys_of_recipes(types: &Types) -> String {
    let keys = types.table("Entry", "reference/recipe.rs");
    format!(
        "# Keys of a reference's recipe\n\n{NOTE}\n`references/recipes.toml` has a table `[name]` for each; [Make a reference](../references.md) says how it becomes an image. {STAR}{keys}"
    )
}

/// Number, title and subjects of each part.
fn parts_of_the_course() -> Vec<(u32, String, Vec<String>)> {
    let text = read(&root().join("src/case/part.rs"));
    let part =
        Regex::new(r#"number: (\d+),\s+title: "([^"]+)",\s+subjects: &\[([^\]]+)\]"#).unwrap();
    let subjects = |list: &str| {
        let names = list.split(',').filter_map(|name| name.trim().strip_prefix("Subject::"));
        names.map(str::to_lowercase).collect()
    };
    let parts = part.captures_iter(&text);
    parts
        .map(|found| (found[1].parse().unwrap(), found[2].to_owned(), subjects(&found[3])))
        .collect()
}

/// A row of a table of causes.
struct Cause {
    name: String,
    headline: String,
    place: String,
    fix: String,
}

fn causes(subject: &str) -> Vec<Cause> {
    let path = root().join(format!("src/cause/{subject}.rs"));
    let text = fs::read_to_string(path).unwrap_or_default().replace("\\\n", "");
    let row =
        Regex::new(r#"= "([a-z0-9-]+)":\s+"([^"]+)",\s+at "([^"]+)",\s+fix "([^"]+)""#).unwrap();
    let rows = row.captures_iter(&text).map(|found| Cause {
        name: found[1].to_owned(),
        headline: found[2].to_owned(),
        place: found[3].to_owned(),
        fix: found[4].to_owned(),
    });
    rows.collect()
}

fn mistakes() -> String {
    let mut page = format!(
        "# Mistakes that furnace names\n\n{NOTE}\n`furnace list causes` prints their names. Most can be planted in the textbook renderer, to see what furnace says of them: the chapter of each part has the command.\n"
    );
    let files = fs::read_dir(root().join("src/cause")).unwrap().map(|entry| entry.unwrap().path());
    let mut subjects: Vec<_> =
        files.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
    subjects.retain(|subject| subject != "mod");
    subjects.sort();
    for subject in subjects {
        let causes = causes(&subject);
        if causes.is_empty() {
            continue;
        }
        let _ =
            write!(page, "\n## {subject}\n\n| name | mistake | where | fix |\n|---|---|---|---|\n");
        for Cause { name, headline, place, fix } in causes {
            let _ = writeln!(
                page,
                "| `{name}` | {headline} | {place} | {fix} |",
                headline = cell(&headline),
                place = cell(&place),
                fix = cell(&fix)
            );
        }
    }
    page
}

/// The pieces that the chapter of each part includes: its cases, and the mistakes that can be planted.
fn parts() -> Vec<(String, String)> {
    let mut pages = Vec::new();
    for (number, _, subjects) in parts_of_the_course() {
        let cases: Vec<_> = subjects.iter().flat_map(|subject| cases(subject)).collect();
        let mut page = String::from("| case | claim |\n|---|---|\n");
        for (id, case) in &cases {
            let title = case["title"].as_str().unwrap();
            let _ = writeln!(page, "| `{id}` | {} |", cell(title));
        }
        pages.push((format!("pieces/cases-{number}.md"), page));
        let faults: Vec<_> = subjects.iter().flat_map(|subject| faults(subject)).collect();
        if !faults.is_empty() {
            let mut page = String::from("| planted as | what the student wrote |\n|---|---|\n");
            for (name, summary) in &faults {
                let _ = writeln!(page, "| `textbook:{name}` | {} |", cell(summary));
            }
            pages.push((format!("pieces/faults-{number}.md"), page));
        }
    }
    pages
}

fn cases(subject: &str) -> BTreeMap<String, toml::Table> {
    let files = fs::read_dir(root().join("cases").join(subject)).unwrap();
    let case = |path: PathBuf| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        (format!("{subject}/{name}"), read(&path).parse().unwrap())
    };
    files.map(|entry| case(entry.unwrap().path())).collect()
}

fn faults(subject: &str) -> Vec<(String, String)> {
    let path = root().join(format!("src/cores/textbook/fault/{subject}.rs"));
    let text = fs::read_to_string(path).unwrap_or_default();
    let row = Regex::new(r#"\n    "([a-z0-9-]+)":\s+"([^"]+)",\s+fails"#).unwrap();
    // A text that goes on in the next line.
    let broken = Regex::new(r"\\\n\s*").unwrap();
    let told = |text: &str| broken.replace_all(text, "").into_owned();
    row.captures_iter(&text).map(|found| (found[1].to_owned(), told(&found[2]))).collect()
}

const DECISIONS: &str = "\
# Decisions

What is dear to undo has a page: what was chosen, what was not, and the measurement behind it. The newest is the last. A page is not rewritten when the world moves on; a later one says
what has replaced it.
";

/// A page that includes each decision, so that the book has them where links look for them, and their list.
fn decisions() -> Vec<(String, String)> {
    let folder = root().join("docs/decisions");
    let files = pages_below(&folder);
    let row = |path: &PathBuf| {
        let (text, name) = (read(path), below(path, &folder));
        let title = text.lines().next().unwrap_or_default().trim_start_matches("# ");
        format!("- [{title}](decisions/{name})\n")
    };
    let rows: String = files.iter().map(row).collect();
    let list = ("decisions.md".to_owned(), format!("{DECISIONS}\n{rows}"));
    let page = |path: PathBuf| {
        let name = below(&path, &folder);
        (format!("decisions/{name}"), format!("{{{{#include ../../../decisions/{name}}}}}\n"))
    };
    files.into_iter().map(page).chain([list]).collect()
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}
