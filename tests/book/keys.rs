//! What may stand in the project's files, read from the types that read them.

use regex_lite::Regex;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use syn::parse::{ParseStream, Parser};
use syn::{Attribute, Fields, Item, Type};
use walkdir::WalkDir;

/// A type of the code, as its file spells it.
pub struct Known {
    /// Below `src`, with forward slashes.
    file: String,
    doc: String,
    kind: Kind,
    /// What stands behind it in a macro.
    rest: String,
}

enum Kind {
    Table(Vec<Key>),
    Words(Vec<(String, String)>),
    Value,
}

struct Key {
    name: String,
    is: String,
    /// Types that are named in it.
    of: Vec<String>,
    is_needed: bool,
    doc: String,
}

/// A check: the name that cases call it by, what it does, and its struct.
pub struct Check {
    pub name: String,
    pub summary: String,
    /// The folder of what it is about.
    pub subject: String,
    file: String,
    of: String,
}

/// Values that are written in a way of their own, and how.
const VALUES: [(&str, &str); 18] = [
    ("Vector", "3 numbers"),
    ("Direction", "direction, 3 numbers"),
    ("Arrow", "direction that keeps its length, 3 numbers"),
    ("Colour", "colour: a number, or 3"),
    ("Reflectance", "colour, each channel from 0 to 1"),
    ("Lit", "colour, each channel above 0"),
    ("Angle", "angle, such as `\"30 deg\"`"),
    ("Polar", "angle, `\"0 deg\"` to `\"180 deg\"`"),
    ("Percent", "percentage, such as `\"2 %\"`"),
    ("Count", "count, such as `4096` or `\"2 M paths\"`"),
    ("Chance", "number, from 0 to below 1"),
    ("Factor", "number above 1"),
    ("Positive", "number above 0"),
    ("Bending", "number above 0, not 1"),
    ("Roughness", "number above 0, at most 1"),
    ("Bounces", "first and last bounce"),
    ("Size", "columns and rows"),
    ("LeafSizes", "list of whole numbers"),
];

/// Every type of the code by its name, and the names that each file has from elsewhere.
pub struct Types {
    known: BTreeMap<String, Vec<Known>>,
    /// By file and name: where it is from, as the beginning of a path below `src`.
    from: BTreeMap<(String, String), String>,
}

impl Types {
    pub fn read() -> Self {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut types = Self { known: BTreeMap::new(), from: BTreeMap::new() };
        for entry in WalkDir::new(&source).sort_by_file_name().into_iter().map(Result::unwrap) {
            if entry.path().extension().is_some_and(|ending| ending == "rs") {
                let text = fs::read_to_string(entry.path()).unwrap();
                let file = crate::text::below(entry.path(), &source);
                types.add(&file, syn::parse_file(&text).unwrap().items, "");
            }
        }
        types
    }

    fn add(&mut self, file: &str, items: Vec<Item>, rest: &str) {
        for item in items {
            let (name, attributes, kind) = match item {
                Item::Struct(item) => {
                    let kind = match &item.fields {
                        Fields::Named(_) => Kind::Table(keys(&item.attrs, &item.fields)),
                        _ => Kind::Value,
                    };
                    (item.ident.to_string(), item.attrs, kind)
                }
                // What it may be is said in words, its variants have no names in a file.
                Item::Enum(item) if serde(&item.attrs).iter().any(|word| word == "untagged") => {
                    (item.ident.to_string(), item.attrs, Kind::Value)
                }
                Item::Enum(item) => {
                    let word = |variant: &syn::Variant| {
                        (kebab(&variant.ident.to_string()), doc(&variant.attrs))
                    };
                    let words = item.variants.iter().map(word).collect();
                    (item.ident.to_string(), item.attrs, Kind::Words(words))
                }
                Item::Macro(item) => {
                    let (items, rest) = inner.parse2(item.mac.tokens).unwrap();
                    self.add(file, items, &rest);
                    continue;
                }
                Item::Use(item) => {
                    self.import(file, &item.tree, "");
                    continue;
                }
                _ => continue,
            };
            let known =
                Known { file: file.to_owned(), doc: doc(&attributes), kind, rest: rest.to_owned() };
            self.known.entry(name).or_default().push(known);
        }
    }

    /// Keeps where the names of a `use` are from.
    fn import(&mut self, file: &str, tree: &syn::UseTree, above: &str) {
        match tree {
            syn::UseTree::Path(path) => {
                let above = match path.ident.to_string().as_str() {
                    "crate" => String::new(),
                    "self" => module(file).to_owned(),
                    "super" if above.is_empty() => folder(module(file)).to_owned(),
                    "super" => folder(above).to_owned(),
                    name if above.is_empty() => name.to_owned(),
                    name => format!("{above}/{name}"),
                };
                self.import(file, &path.tree, &above);
            }
            syn::UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.import(file, tree, above));
            }
            syn::UseTree::Rename(name) => {
                let key = (file.to_owned(), name.rename.to_string());
                self.from.insert(key, above.to_owned());
            }
            syn::UseTree::Name(name) => {
                let key = (file.to_owned(), name.ident.to_string());
                self.from.insert(key, above.to_owned());
            }
            _ => {}
        }
    }

    /// The type of this name that a file means: its own, or the one that it has from elsewhere.
    fn find(&self, name: &str, file: &str) -> Option<&Known> {
        let known = self.known.get(name)?;
        let own = known.iter().find(|known| known.file == file);
        let from = self.from.get(&(file.to_owned(), name.to_owned()));
        let is_there = |known: &&Known| {
            from.is_some_and(|from| module(&known.file).starts_with(from.as_str()))
        };
        own.or_else(|| known.iter().find(is_there))
    }

    /// Every check, subject by subject.
    pub fn checks(&self) -> Vec<Check> {
        let said = Regex::new(r#"^name : "([^"]+)" , summary : "([^"]+)""#).unwrap();
        let mut checks = Vec::new();
        for (of, known) in &self.known {
            for known in known {
                let Some(found) = said.captures(&known.rest) else { continue };
                checks.push(Check {
                    name: found[1].to_owned(),
                    summary: found[2].to_owned(),
                    subject: known.file.split('/').nth(1).unwrap().to_owned(),
                    file: known.file.clone(),
                    of: of.clone(),
                });
            }
        }
        checks.sort_by(|a, b| a.name.cmp(&b.name));
        checks
    }

    pub fn of_check(&self, check: &Check) -> String {
        self.table(&check.of, &check.file)
    }

    /// The keys of a type and of the types that they name, as Markdown.
    pub fn table(&self, name: &str, file: &str) -> String {
        let mut page = String::new();
        self.write(&mut page, name, file, "", &mut Vec::new());
        page
    }

    fn write(&self, page: &mut String, name: &str, file: &str, head: &str, told: &mut Vec<String>) {
        let Some(known) = self.find(name, file) else { return };
        let place = format!("{} {name}", known.file);
        if told.contains(&place) {
            return;
        }
        told.push(place);
        match &known.kind {
            Kind::Value => {}
            Kind::Words(words) => {
                let _ = writeln!(page, "{head}\n\n| word | |\n|---|---|");
                for (word, doc) in words {
                    let _ = writeln!(page, "| `{word}` | {} |", cell(doc));
                }
                page.push('\n');
            }
            Kind::Table(keys) if keys.is_empty() => {}
            Kind::Table(keys) => {
                let _ = writeln!(page, "{head}\n\n| key | is | |\n|---|---|---|");
                for key in keys {
                    let need = if key.is_needed { "" } else { " *" };
                    let doc = if key.doc.is_empty() {
                        self.told_by_type(key, file)
                    } else {
                        key.doc.clone()
                    };
                    let _ = writeln!(
                        page,
                        "| `{}`{need} | {} | {} |",
                        key.name,
                        cell(&key.is),
                        cell(&doc)
                    );
                }
                page.push('\n');
                for key in keys {
                    for of in &key.of {
                        self.write(page, of, &known.file, &format!("`{}`:", key.name), told);
                    }
                }
            }
        }
    }

    /// What a value's type says of itself, where its key says nothing.
    fn told_by_type(&self, key: &Key, file: &str) -> String {
        let docs = key.of.iter().filter_map(|of| self.find(of, file));
        docs.map(|known| known.doc.clone()).next().unwrap_or_default()
    }
}

/// The module of a file, as a path.
fn module(file: &str) -> &str {
    let module = file.trim_end_matches(".rs");
    module.strip_suffix("/mod").unwrap_or(module)
}

fn folder(module: &str) -> &str {
    module.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The items that a macro is given, as far as they are items, and what follows them.
fn inner(input: ParseStream<'_>) -> syn::Result<(Vec<Item>, String)> {
    let mut items = Vec::new();
    loop {
        let ahead = input.fork();
        match ahead.parse::<Item>() {
            Ok(item) if !input.is_empty() => {
                input.parse::<Item>()?;
                items.push(item);
            }
            _ => break,
        }
    }
    let rest: proc_macro2::TokenStream = input.parse()?;
    Ok((items, rest.to_string()))
}

fn keys(of_struct: &[Attribute], fields: &Fields) -> Vec<Key> {
    let all_default = serde(of_struct).iter().any(|word| word == "default");
    let mut keys = Vec::new();
    for field in fields {
        let words = serde(&field.attrs);
        if words.iter().any(|word| word == "skip") {
            continue;
        }
        let has_default = all_default || words.iter().any(|word| word.starts_with("default"));
        let renamed = words.iter().find_map(|word| word.strip_prefix("rename = "));
        let name = renamed.map_or_else(
            || kebab(field.ident.as_ref().unwrap().to_string().trim_start_matches("r#")),
            |name| name.trim_matches('"').to_owned(),
        );
        let is_needed = !has_default && !is_option(&field.ty);
        let mut of = Vec::new();
        let is = said(&field.ty, &mut of);
        keys.push(Key { name, is, of, is_needed, doc: doc(&field.attrs) });
    }
    keys
}

/// The numbers in angle brackets.
fn numbers(arguments: &syn::PathArguments) -> Vec<String> {
    let syn::PathArguments::AngleBracketed(list) = arguments else { return Vec::new() };
    let numbers = list.args.iter().filter_map(|argument| match argument {
        syn::GenericArgument::Const(number) => Some(length(number)),
        _ => None,
    });
    numbers.collect()
}

fn is_option(ty: &Type) -> bool {
    let Type::Path(path) = ty else { return false };
    path.path.segments.last().is_some_and(|last| last.ident == "Option")
}

fn length(of_array: &syn::Expr) -> String {
    match of_array {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. }) => number.to_string(),
        _ => "list".to_owned(),
    }
}

/// A type in words; names of types of ours are kept in `of`.
fn said(ty: &Type, of: &mut Vec<String>) -> String {
    let path = match ty {
        Type::Array(array) => {
            return format!("{} of {}", length(&array.len), said(&array.elem, of));
        }
        Type::Tuple(tuple) => {
            let parts: Vec<_> = tuple.elems.iter().map(|part| said(part, of)).collect();
            return parts.join(", ");
        }
        Type::Path(path) => path,
        _ => return String::new(),
    };
    let last = path.path.segments.last().unwrap();
    let inner: Vec<_> = match &last.arguments {
        syn::PathArguments::AngleBracketed(list) => list
            .args
            .iter()
            .filter_map(|argument| match argument {
                syn::GenericArgument::Type(ty) => Some(said(ty, of)),
                _ => None,
            })
            .collect(),
        _ => Vec::new(),
    };
    let first = || inner.first().cloned().unwrap_or_default();
    match last.ident.to_string().as_str() {
        "Option" | "Spanned" | "Box" | "Arc" => first(),
        "Between" => format!("whole number, {}", numbers(&last.arguments).join(" to ")),
        "Vec" | "Several" => format!("list, each {}", first()),
        "BTreeMap" => format!("table of {}", inner.last().cloned().unwrap_or_default()),
        "Table" | "Overrides" => "table".to_owned(),
        "String" | "Words" => "text".to_owned(),
        "PathBuf" => "path".to_owned(),
        "f64" | "f32" => "number".to_owned(),
        "u8" | "u32" | "u64" | "usize" => "whole number".to_owned(),
        "bool" => "`true` or `false`".to_owned(),
        "Duration" => "duration, such as `\"20 min\"`".to_owned(),
        name if VALUES.iter().any(|(known, _)| *known == name) => {
            VALUES.iter().find(|(known, _)| *known == name).unwrap().1.to_owned()
        }
        name => {
            of.push(name.to_owned());
            kebab(name).replace('-', " ").trim_end_matches(" entry").to_owned()
        }
    }
}

/// The words of `#[serde(…)]`.
fn serde(attributes: &[Attribute]) -> Vec<String> {
    let lists = attributes.iter().filter(|attribute| attribute.path().is_ident("serde"));
    let lists = lists.filter_map(|attribute| attribute.meta.require_list().ok());
    let words = lists.flat_map(|list| {
        list.tokens.to_string().split(" , ").map(str::to_owned).collect::<Vec<_>>()
    });
    words.collect()
}

fn doc(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| {
        let syn::Meta::NameValue(line) = &attribute.meta else { return None };
        let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) = &line.value else {
            return None;
        };
        line.path.is_ident("doc").then(|| text.value().trim().to_owned())
    });
    let text = lines.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    // Links into the code lead nowhere in a book.
    Regex::new(r"\[(`[^`]+`)\](\([^)]*\))?").unwrap().replace_all(&text, "$1").into_owned()
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

fn kebab(name: &str) -> String {
    let mut kebab = String::new();
    for (place, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && place > 0 {
            kebab.push('-');
        }
        kebab.extend(letter.to_lowercase());
    }
    kebab.replace('_', "-")
}
