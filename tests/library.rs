//! `docs/book/src/library.md` lists what the library offers: every public item, with the first sentence of its docs.
//! `FURNACE_BLESS=1 cargo test --test library` writes it again.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use regex_lite::Regex;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use syn::{Attribute, Expr, ExprLit, Item, Lit, Meta, UseTree, Visibility};
use walkdir::WalkDir;

const HEAD: &str = "\
# The library

`furnace` is a crate too. Five lines make every case a test of a renderer in Rust:

```toml
[dev-dependencies]
furnace = { git = \"...\", default-features = false, features = [\"harness\"] }

[[test]]
name = \"furnace\"
harness = false
```

As `tests/furnace.rs` of `examples/downstream` has it:

```rust file=furnace.rs
{{#include ../../../examples/downstream/tests/furnace.rs}}
```

`cargo test` then tries the cases in one run: what rests on something broken is tried with the bench's own component in its
place, where the core can take one, and at the end stand the causes and the address of the report, in `target/furnace`.
`cargo test bvh` and `-- --exact NAME` select as ever; so does `.cases([\"3\", \"!image\"])`, in the words of `furnace run`.
What the core has not implemented is *ignored*, with the reason; so is what is not decided. A panic of the core is that
trial's outcome; an endless loop, or a crash, ends the test, for the core lives in its process.

`cargo nextest run` starts a process for each case. There is no report of all then; a case that fails is tried again with
what it rests on, so that it says the same as under `cargo test`.

`furnace::trials(..).run(DIR)` answers the run as data, and `furnace::grade(\"cs184-hw3\", mine::Core::new)` the points.
`examples/downstream` is a whole crate, and CI runs it. `furnace::export_core!` makes a library of a core, for
[`furnace run --core` and for grading](rust.md#a-crate).

| feature | has | by default |
|---|---|---|
| `cli` | the program, and what only it needs: clap, ctrlc, indicatif, rust-embed, terminal_size | yes |
| `harness` | `Trials::test`, with libtest-mimic | yes |

Cases, scenes and references are read where the crate was built; `FURNACE_HOME` names another checkout.

## Every public item

`cargo doc --open` has the rest of each; vectors are those of `furnace::glam`. What `furnace_core.h` has is in `contract::abi` once
more, and not repeated here.
";

/// A public item, as it is listed.
struct Entry {
    kind: &'static str,
    name: String,
    line: String,
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// The first sentence of the docs.
fn sentence(attributes: &[Attribute]) -> String {
    let text = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    };
    let lines: Vec<_> = attributes.iter().filter_map(text).collect();
    first_sentence(&lines.iter().map(String::as_str).collect::<Vec<_>>())
}

fn first_sentence(lines: &[&str]) -> String {
    let paragraph: Vec<_> =
        lines.iter().map(|line| line.trim()).take_while(|l| !l.is_empty()).collect();
    let paragraph = paragraph.join(" ");
    let end = paragraph.find(". ").map_or(paragraph.len(), |end| end + 1);
    // Links into the code lead nowhere in the book.
    paragraph[..end].replace("[`", "`").replace("`]", "`").replace('|', "\\|")
}

fn entry(item: &Item) -> Option<Entry> {
    if let Item::Macro(it) = item
        && let Some(name) = &it.ident
        && it.attrs.iter().any(|attribute| attribute.path().is_ident("macro_export"))
    {
        return Some(Entry { kind: "macro", name: name.to_string(), line: sentence(&it.attrs) });
    }
    let (visibility, kind, name, attributes) = match item {
        Item::Fn(it) => (&it.vis, "fn", it.sig.ident.to_string(), &it.attrs),
        Item::Struct(it) => (&it.vis, "struct", it.ident.to_string(), &it.attrs),
        Item::Enum(it) => (&it.vis, "enum", it.ident.to_string(), &it.attrs),
        Item::Trait(it) => (&it.vis, "trait", it.ident.to_string(), &it.attrs),
        Item::Type(it) => (&it.vis, "type", it.ident.to_string(), &it.attrs),
        Item::Const(it) => (&it.vis, "const", it.ident.to_string(), &it.attrs),
        Item::Static(it) => (&it.vis, "static", it.ident.to_string(), &it.attrs),
        _ => return None,
    };
    is_public(visibility).then(|| Entry { kind, name, line: sentence(attributes) })
}

/// What stands in the braces of a macro, with its docs: no item for who reads the file.
fn in_macros(source: &str) -> Vec<Entry> {
    let docs = r"((?:[ \t]+///[^\n]*\n)+)";
    let attributes = r"(?:[ \t]+(?:#\[|\$\(#)[^\n]*\n)*";
    let item = r"[ \t]+pub (struct|enum|static) ([A-Za-z_]+)";
    let entry = Regex::new(&format!("{docs}{attributes}{item}")).unwrap();
    let told = |docs: &str| {
        let lines: Vec<_> = docs.lines().map(|line| line.trim().trim_start_matches('/')).collect();
        first_sentence(&lines)
    };
    let kind = |word: &str| match word {
        "struct" => "struct",
        "enum" => "enum",
        _ => "static",
    };
    let found = entry.captures_iter(source);
    found
        .map(|it| Entry { kind: kind(&it[2]), name: it[3].to_owned(), line: told(&it[1]) })
        .collect()
}

/// One file of the library.
#[derive(Default)]
struct Module {
    entries: Vec<Entry>,
    /// Modules below it that anybody may name.
    open: Vec<String>,
    /// What it names of other modules, from the root of the crate on; `true` where that is for everybody.
    uses: Vec<(Vec<String>, bool)>,
}

type Modules = BTreeMap<Vec<String>, Module>;

impl Module {
    fn of(path: &[String], items: &[Item]) -> Self {
        let mut module =
            Self { entries: items.iter().filter_map(entry).collect(), ..Self::default() };
        for item in items {
            match item {
                Item::Mod(it) if is_public(&it.vis) => module.open.push(it.ident.to_string()),
                Item::Use(it) => {
                    let mut named = Vec::new();
                    name_all(&it.tree, &mut Vec::new(), &mut named);
                    let resolved = named.into_iter().map(|name| from_root(path, name));
                    module.uses.extend(resolved.map(|name| (name, is_public(&it.vis))));
                }
                _ => {}
            }
        }
        module
    }
}

fn name_all(tree: &UseTree, before: &mut Vec<String>, named: &mut Vec<Vec<String>>) {
    let with = |last: String| before.iter().cloned().chain([last]).collect();
    match tree {
        UseTree::Path(it) => {
            before.push(it.ident.to_string());
            name_all(&it.tree, before, named);
            before.pop();
        }
        UseTree::Group(it) => it.items.iter().for_each(|tree| name_all(tree, before, named)),
        UseTree::Name(it) => named.push(with(it.ident.to_string())),
        UseTree::Rename(it) => named.push(with(it.ident.to_string())),
        UseTree::Glob(_) => named.push(with("*".to_owned())),
    }
}

fn from_root(path: &[String], name: Vec<String>) -> Vec<String> {
    match name[0].as_str() {
        "crate" => name[1..].to_vec(),
        "self" => [path, &name[1..]].concat(),
        "super" => from_root(&path[..path.len() - 1], [&["self".to_owned()], &name[1..]].concat()),
        _ => [path, &name].concat(),
    }
}

/// The items that a user of the crate can name, each by the module that it stands in.
fn reachable(modules: &Modules) -> BTreeSet<(Vec<String>, String)> {
    let (mut found, mut seen, mut open) = (BTreeSet::new(), BTreeSet::new(), vec![Vec::new()]);
    while let Some(path) = open.pop() {
        let Some(module) = modules.get(&path).filter(|_| seen.insert(path.clone())) else {
            continue;
        };
        found.extend(module.entries.iter().map(|entry| (path.clone(), entry.name.clone())));
        open.extend(
            module.open.iter().map(|name| [&path[..], std::slice::from_ref(name)].concat()),
        );
        let mut named: Vec<_> = module
            .uses
            .iter()
            .filter(|(_, public)| *public)
            .map(|(name, _)| name.clone())
            .collect();
        while let Some(name) = named.pop() {
            let (last, parent) = name.split_last().unwrap();
            if modules.contains_key(&name) {
                open.push(name.clone());
            } else if last == "*" {
                open.push(parent.to_vec());
            } else if found.insert((parent.to_vec(), last.clone()))
                && let Some(parent) = modules.get(parent)
            {
                // Handed on from a third module.
                let handed = parent.uses.iter().filter(|(name, _)| name.last() == Some(last));
                named.extend(handed.map(|(name, _)| name.clone()));
            }
        }
    }
    found
}

/// The public items of each module of the library: files below a folder count as its own.
fn listed() -> String {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut modules = Modules::new();
    for file in WalkDir::new(&source).sort_by_file_name() {
        let path = file.unwrap().into_path();
        let label = path.strip_prefix(&source).unwrap().to_string_lossy().replace('\\', "/");
        let Some(label) = label.strip_suffix(".rs") else { continue };
        let mut name: Vec<_> = label.split('/').map(str::to_owned).collect();
        if ["mod", "lib"].contains(&name.last().unwrap().as_str()) {
            name.pop();
        }
        let source = fs::read_to_string(&path).unwrap().replace("\r\n", "\n");
        let mut module = Module::of(&name, &syn::parse_file(&source).unwrap().items);
        module.entries.extend(in_macros(&source));
        modules.insert(name, module);
    }
    let reachable = reachable(&modules);
    let mut rooms: BTreeMap<String, Vec<Entry>> = BTreeMap::new();
    for (path, module) in modules {
        let room = path.first().cloned().unwrap_or_default();
        // What is written for the command line alone is no library.
        if ["main", "cli"].contains(&room.as_str()) {
            continue;
        }
        let is_reachable = |entry: &Entry| {
            entry.kind == "macro" || reachable.contains(&(path.clone(), entry.name.clone()))
        };
        rooms.entry(room).or_default().extend(module.entries.into_iter().filter(is_reachable));
    }
    let mut text = HEAD.to_owned();
    for (room, mut entries) in rooms.into_iter().filter(|(_, entries)| !entries.is_empty()) {
        entries
            .sort_by(|a, b| (a.name.to_lowercase(), a.kind).cmp(&(b.name.to_lowercase(), b.kind)));
        write!(text, "\n### {room}\n\n| item | what it is |\n|---|---|\n").unwrap();
        for Entry { kind, name, line } in entries {
            assert!(!line.is_empty(), "{kind} {name} of {room} has no line of its own");
            writeln!(text, "| {kind} `{name}` | {line} |").unwrap();
        }
    }
    text
}

#[test]
fn every_public_item_is_listed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/book/src/library.md");
    let listed = listed();
    if std::env::var_os("FURNACE_BLESS").is_some() {
        fs::write(&path, &listed).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    let first = listed.lines().zip(written.lines()).find(|(now, then)| now != then);
    assert!(
        listed == written,
        "docs/book/src/library.md is out of date, first in {first:?}; FURNACE_BLESS=1 writes it"
    );
}

#[test]
fn the_five_lines_of_the_readme_are_those_of_the_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let test = fs::read_to_string(root.join("examples/downstream/tests/furnace.rs")).unwrap();
    let is_counted = |line: &&str| !line.is_empty() && !line.starts_with("//!");
    assert_eq!(test.lines().filter(is_counted).count(), 5, "{test}");
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    assert!(readme.contains("furnace::trials(\"mine\", mine::Core::new).test()"));
}
