//! The tree is the architecture: a module names only lower layers, and two modules of one layer do not name each
//! other. This test is that rule.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};

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
    ("render", 7),
    ("diagnosis", 8),
    ("run", 9),
    ("agreement", 10),
    ("bench", 10),
    ("faults", 10),
    ("report", 10),
    ("reference", 10),
    ("writeup", 10),
    ("grade", 11),
    ("cli", 12),
    ("harness", 12),
];

/// `unsafe` stands in these files alone.
const UNSAFE_FILES: &[&str] = &[
    "src/cores/builtin/trace/simd.rs",
    "src/cores/dylib.rs",
    "src/cores/dylib/answering.rs",
    "src/cores/dylib/export.rs",
    "src/cores/dylib/lent.rs",
    "src/worker/confine_linux.rs",
    "src/worker/overflow.rs",
];

/// A module by its path below the crate: `["checks", "bvh", "trial"]`.
type Module = Vec<String>;

fn source_files() -> Vec<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let entries = walkdir::WalkDir::new(source).sort_by_file_name();
    let paths = entries.into_iter().map(|entry| entry.unwrap().into_path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// Path below the project, with forward slashes.
fn label(path: &Path) -> String {
    let inside = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
    inside.to_string_lossy().replace('\\', "/")
}

/// The module that a file is; empty for `lib.rs` and `main.rs`.
fn module_of(label: &str) -> Module {
    let inside = label.trim_start_matches("src/").trim_end_matches(".rs");
    let parts = inside.split('/').filter(|part| !["mod", "lib", "main"].contains(part));
    parts.map(str::to_owned).collect()
}

/// Collects the modules that a file names by `crate::…` and `super::…`, in groups and in macros too.
struct Names {
    /// Where the reader stands.
    here: Module,
    found: BTreeSet<Module>,
}

impl Names {
    fn of(label: &str, text: &str) -> BTreeSet<Module> {
        let mut names = Self { here: module_of(label), found: BTreeSet::new() };
        names.visit_file(&syn::parse_file(text).unwrap());
        names.found
    }

    /// Keeps a path if it leads anywhere in this crate.
    fn keep(&mut self, path: &[String]) {
        let Some(first) = path.first() else { return };
        if !["crate", "self", "super"].contains(&first.as_str()) {
            return;
        }
        let mut full = self.here.clone();
        for part in path {
            match part.as_str() {
                "crate" => full.clear(),
                "self" => {}
                "super" => drop(full.pop()),
                name => full.push(name.to_owned()),
            }
        }
        self.found.insert(full);
    }

    fn keep_tree(&mut self, before: &mut Vec<String>, tree: &syn::UseTree) {
        let depth = before.len();
        match tree {
            syn::UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.keep_tree(before, &path.tree);
            }
            syn::UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.keep_tree(before, tree));
            }
            syn::UseTree::Name(syn::UseName { ident })
            | syn::UseTree::Rename(syn::UseRename { ident, .. }) => {
                before.push(ident.to_string());
                self.keep(before);
            }
            syn::UseTree::Glob(_) => self.keep(before),
        }
        before.truncate(depth);
    }
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.keep_tree(&mut Vec::new(), &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: Vec<_> = path.segments.iter().map(|part| part.ident.to_string()).collect();
        self.keep(&parts);
        visit::visit_path(self, path);
    }

    /// `mod tests { … }` is one step further in: its `super` is the file.
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        self.here.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.here.pop();
    }

    fn visit_macro(&mut self, called: &'ast syn::Macro) {
        for path in paths_in(called.tokens.clone()) {
            self.keep(&path);
        }
        visit::visit_macro(self, called);
    }
}

/// Every `a::b::c` among tokens that nobody has parsed.
fn paths_in(tokens: TokenStream) -> Vec<Vec<String>> {
    let mut paths = vec![Vec::new()];
    let mut colons = 0;
    for token in tokens {
        match token {
            TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
            TokenTree::Ident(name) => {
                if colons != 2 {
                    paths.push(Vec::new());
                }
                paths.last_mut().unwrap().push(name.to_string());
                colons = 0;
            }
            TokenTree::Group(group) => {
                paths.extend(paths_in(group.stream()));
                paths.push(Vec::new());
                colons = 0;
            }
            _ => colons = 3,
        }
    }
    paths
}

#[test]
fn modules_name_only_lower_layers() {
    let layers: BTreeMap<_, _> = LAYERS.iter().copied().collect();
    let mut breaches = Vec::new();
    for path in source_files() {
        let label = label(&path);
        let Some(module) = module_of(&label).into_iter().next() else { continue };
        let layer = *layers.get(module.as_str()).unwrap_or_else(|| {
            panic!("module `{module}` has no layer; add it to LAYERS in tests/architecture.rs")
        });
        for named in Names::of(&label, &fs::read_to_string(&path).unwrap()) {
            let Some(named) = named.first().filter(|named| **named != module) else { continue };
            match layers.get(named.as_str()) {
                Some(other) if *other < layer => {}
                Some(other) => breaches.push(format!(
                    "{label}: {module} (layer {layer}) names {named} (layer {other})"
                )),
                None => breaches.push(format!("{label}: `crate::{named}` has no layer")),
            }
        }
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn the_two_cores_do_not_know_each_other() {
    for path in source_files() {
        let label = label(&path);
        let names = Names::of(&label, &fs::read_to_string(&path).unwrap());
        for (core, other) in [("builtin", "textbook"), ("textbook", "builtin")] {
            if label.starts_with(&format!("src/cores/{core}/")) {
                let knows = names.iter().any(|name| name.get(1).is_some_and(|n| n == other));
                assert!(!knows, "{label} names {other}");
            }
        }
    }
}

/// Where `textbook` speaks of what is done otherwise; all its other files are the lesson.
const BESIDE_THE_LESSON: [&str; 4] = ["fault/", "different.rs", "variant.rs", "steps.rs"];

#[test]
fn the_lesson_knows_of_no_fault() {
    for path in source_files() {
        let label = label(&path);
        let Some(file) = label.strip_prefix("src/cores/textbook/") else { continue };
        if BESIDE_THE_LESSON.iter().any(|beside| file.starts_with(beside)) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let is_code = |line: &&str| {
            !line.trim_start().starts_with("//") && !line.starts_with("pub(crate) mod ")
        };
        for line in text.lines().filter(is_code) {
            let mut words = line.split(|c: char| !c.is_alphanumeric() && c != '_');
            let is_beside = |word: &str| ["fault", "different", "variant"].contains(&word);
            assert!(!words.any(is_beside) && !line.contains("..LESSON"), "{label}: {line}");
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

/// Whether an attribute, inner or outer, silences a lint: `allow` itself, or within `cfg_attr`.
struct Allowing(bool);

impl<'ast> Visit<'ast> for Allowing {
    fn visit_attribute(&mut self, attribute: &'ast syn::Attribute) {
        let is_allow =
            |token: TokenTree| matches!(token, TokenTree::Ident(name) if name == "allow");
        self.0 |= attribute.path().is_ident("allow");
        if let (true, syn::Meta::List(list)) =
            (attribute.path().is_ident("cfg_attr"), &attribute.meta)
        {
            self.0 |= list.tokens.clone().into_iter().any(is_allow);
        }
    }
}

fn allows_a_lint(text: &str) -> bool {
    let mut allowing = Allowing(false);
    allowing.visit_file(&syn::parse_file(text).unwrap());
    allowing.0
}

#[test]
fn lints_are_expected_with_a_reason_and_never_allowed() {
    for path in source_files() {
        let text = fs::read_to_string(&path).unwrap();
        assert!(!allows_a_lint(&text), "{} allows a lint", label(&path));
    }
}

#[test]
fn the_test_finds_what_it_looks_for() {
    let text = "
        use crate::{run::{Plan, record as r}, math};
        use super::finding::Finding;
        // crate::cli is only mentioned
        fn f() { let x = crate::image::Image::new(); println!(\"{}\", crate::report::NAME); }
        mod tests { use super::*; use super::super::context; }
    ";
    let names = Names::of("src/checks/bvh/trial.rs", text);
    let names: Vec<_> = names.iter().map(|name| name.join("::")).collect();
    let expected = [
        "checks::bvh::finding::Finding",
        "checks::bvh::trial",
        "checks::bvh::context",
        "image::Image::new",
        "math",
        "report::NAME",
        "run::Plan",
        "run::record",
    ];
    for name in expected {
        assert!(names.contains(&name.to_owned()), "{name} is missing of {names:?}");
    }
    assert!(!names.iter().any(|name| name.starts_with("cli")));
    for attribute in ["allow(dead_code)", "cfg_attr(test, allow(dead_code))"] {
        assert!(allows_a_lint(&format!("#![{attribute}]")), "{attribute}");
        assert!(allows_a_lint(&format!("#[{attribute}] fn f() {{}}")), "{attribute}");
    }
    assert!(!allows_a_lint("#[expect(dead_code, reason = \"allow\")] fn f() {}"));
    assert!(has_unsafe("let x = unsafe { *pointer };"));
    assert!(has_unsafe("unsafe impl Send for Core {}"));
    assert!(!has_unsafe("type Entry = unsafe extern \"C\" fn(u32);"));
}
