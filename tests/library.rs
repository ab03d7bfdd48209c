//! `docs/book/src/library.md` lists what the library offers: every public item, with the first sentence of its docs.
//! `FURNACE_BLESS=1 cargo test --test library` writes it again.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use syn::{Attribute, Expr, ExprLit, Item, Lit, Meta, Visibility};
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
| `harness` | `Trials::test`, with libtest-mimic | no |

Cases, scenes and references are read where the crate was built; `FURNACE_HOME` names another checkout.

## Every public item

`cargo doc --open` has the rest of each; vectors are those of `furnace::glam`.
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

/// The public items of each module of the library: files below a folder count as its own.
fn listed() -> String {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut modules: BTreeMap<String, Vec<Entry>> = BTreeMap::new();
    for file in WalkDir::new(&source).sort_by_file_name() {
        let path = file.unwrap().into_path();
        let label = path.strip_prefix(&source).unwrap().to_string_lossy().replace('\\', "/");
        let Some(label) = label.strip_suffix(".rs") else { continue };
        let module = label.split('/').next().unwrap().to_owned();
        // What is written for the command line alone is no library.
        if ["main", "lib", "cli"].contains(&module.as_str()) {
            continue;
        }
        let items = syn::parse_file(&fs::read_to_string(&path).unwrap()).unwrap().items;
        modules.entry(module).or_default().extend(items.iter().filter_map(entry));
    }
    let mut text = HEAD.to_owned();
    for (module, mut entries) in modules.into_iter().filter(|(_, entries)| !entries.is_empty()) {
        entries
            .sort_by(|a, b| (a.name.to_lowercase(), a.kind).cmp(&(b.name.to_lowercase(), b.kind)));
        write!(text, "\n### {module}\n\n| item | what it is |\n|---|---|\n").unwrap();
        for Entry { kind, name, line } in entries {
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
    assert_eq!(test.lines().filter(|line| !line.is_empty()).count(), 5, "{test}");
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    assert!(readme.contains("furnace::trials(\"mine\", mine::Core::new).test()"));
}
