//! Whoever writes a core reads a header, a Python class or a page; each says what the table of questions says.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::contract::abi;
use furnace::contract::crossing::{Layout, Part};
use furnace::contract::question::{QUESTIONS, Question};
use furnace::contract::{Capabilities, Components};
use regex_lite::Regex;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(path).unwrap()
}

/// The groups of each place in a text where a pattern matches.
fn found<const N: usize>(pattern: &str, text: &str) -> Vec<[String; N]> {
    let pattern = Regex::new(pattern).unwrap();
    pattern.captures_iter(text).map(|groups| groups.extract().1.map(str::to_owned)).collect()
}

/// Parts under the names by which they cross.
fn parts<'a>(
    name: &'a str,
    parts: &'a [Part],
) -> impl Iterator<Item = (String, Option<Layout>)> + 'a {
    let called = move |part: &Part| if part.name.is_empty() { name } else { part.name };
    parts.iter().map(move |part| (called(part).replace('_', "-"), part.element))
}

fn arguments(question: &Question) -> Vec<(String, Option<Layout>)> {
    question.arguments.iter().flat_map(|(name, of_it)| parts(name, of_it)).collect()
}

fn answer(question: &Question) -> Vec<(String, Layout)> {
    let (name, arrays) = question.answer;
    parts(name, arrays).map(|(name, element)| (name, element.unwrap())).collect()
}

/// What libraries that are compiled already know by its place: what is new comes after it.
const IN_PLACE: &[&str] = &[
    "last_error",
    "generate_rays",
    "intersect_triangle",
    "intersect_sphere",
    "intersect_box",
    "sample_direction",
    "direction_pdf",
    "eval_bsdf",
    "sample_bsdf",
    "adaptive_mean",
    "build",
    "release",
    "intersect",
    "occluded",
    "sample_light",
    "radiance",
    "render",
    "take_components",
];

#[test]
fn the_header_has_the_functions_of_the_table_in_its_order() {
    let header = read("include/furnace_core.h");
    let (_, core) = header.split_once("typedef struct furnace_core {").unwrap();
    let functions: Vec<_> =
        found::<1>(r"\(\*(\w+)\)\(void \*self", core).into_iter().flatten().collect();
    let fields = abi::CORE.fields.iter().map(|(name, _)| *name);
    let names: Vec<_> = fields.skip_while(|name| *name != "last_error").collect();
    assert_eq!(functions, names);
    assert_eq!(names[..IN_PLACE.len()], *IN_PLACE);
    let wrapper = read("include/furnace_core.hpp");
    for name in names.iter().filter(|name| !["last_error", "release"].contains(name)) {
        assert!(wrapper.contains(&format!("FURNACE_FILL({name}, ")), "furnace_core.hpp: {name}");
    }
}

#[test]
fn python_has_the_methods_of_the_table() {
    let core = read("adapters/python/furnace_core/core.py");
    let pattern = r#"@question\("([\w-]+)",( "[\w-]+",|)( tells_stats=True,|) (\w+)="([\w-]+)"\)\s+def (\w+)"#;
    let declared: Vec<[String; 6]> = found(pattern, &core);
    let components = declared.iter().map(|[_, component, ..]| component.trim_matches([' ', ',']));
    let components: BTreeSet<_> = components.filter(|component| !component.is_empty()).collect();
    let listed = format!("[{}]", Vec::from_iter(components.iter().copied()).join(","));
    assert!(
        serde_json::from_str::<Components>(&listed).unwrap().iter().count() == components.len()
    );
    for name in (Components::all() - Components::RANDOM_NUMBERS).names() {
        assert!(core.contains(&format!("    \"{name}\": ")), "core.py has no component `{name}`");
    }
    let words = |[capability, _, stats, name, element, method]: [String; 6]| {
        (method, capability, name, element, !stats.is_empty())
    };
    let declared: BTreeSet<_> = declared.into_iter().map(words).collect();
    let mut expected = BTreeSet::new();
    for question in QUESTIONS {
        let (name, element) = answer(question).remove(0);
        let [capability] = question.capability.names().try_into().unwrap();
        for method in question.in_c {
            let (name, element) = (name.replace('-', "_"), element.name.to_owned());
            let traced = question.told == "TraversalStats";
            expected.insert(((*method).to_owned(), capability.clone(), name, element, traced));
        }
    }
    assert_eq!(declared, expected);
    let questions: Capabilities = QUESTIONS.iter().map(|question| question.capability).collect();
    for name in (Capabilities::all() - questions - Capabilities::BUILD_SCENE).names() {
        assert!(core.contains(&format!("\"{name}\"")), "core.py does not name the trait `{name}`");
    }
}

/// Every element that crosses, but for those that only programs without Python send.
fn elements() -> BTreeMap<&'static str, Layout> {
    let of_c = QUESTIONS.iter().filter(|question| !question.in_c.is_empty());
    let given = of_c.clone().flat_map(arguments).filter_map(|(_, element)| element);
    let answered = of_c.flat_map(answer).map(|(_, element)| element);
    given.chain(answered).map(|element| (element.name, element)).collect()
}

#[test]
fn python_has_the_fields_of_elements_in_their_order() {
    let text = read("adapters/python/furnace_core/elements.py");
    for (name, layout) in elements() {
        assert!(text.contains(&format!("    \"{name}\": (")), "elements.py has no `{name}`");
        if layout.fields.is_empty() || name.starts_with("vec") {
            continue;
        }
        let dtype = name.to_uppercase().replace('-', "_");
        let (_, fields) = text.split_once(&format!("\n{dtype} = np.dtype([")).unwrap();
        let (fields, _) = fields.split_once("])\n").unwrap();
        let mut offset = 0;
        let mut offsets = Vec::new();
        for [field, size, count] in found(r#"\("(\w+)", "<[fu](\d)"(?:, )?(\d?)\)"#, fields) {
            offsets.push((field, offset));
            let number = |digits: &str| digits.parse::<usize>().unwrap_or(1);
            offset += number(&size) * number(&count);
        }
        let expected: Vec<_> =
            layout.fields.iter().map(|(field, offset)| ((*field).to_owned(), *offset)).collect();
        assert_eq!((offsets, offset), (expected, layout.size), "elements.py: {dtype}");
    }
}

/// The rows of the tables of the protocol's page: their cells, by the first.
fn rows(page: &str) -> BTreeMap<String, Vec<String>> {
    let cells = |line: &str| -> Vec<_> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let rows = page.lines().filter(|line| line.starts_with("| `")).map(cells);
    rows.map(|cells| (cells[0].trim_matches('`').to_owned(), cells)).collect()
}

#[test]
fn the_page_of_the_protocol_has_the_requests_of_the_table() {
    let page = read("docs/book/src/protocol.md");
    let rows = rows(&page);
    for question in QUESTIONS {
        let of_it: Vec<_> = question.requests().iter().map(|name| rows[name].clone()).collect();
        let said = |column: usize, words: &str| of_it.iter().any(|row| row[column].contains(words));
        for (name, element) in arguments(question) {
            let (column, words) = match element {
                None => (1, format!("`{name}`")),
                Some(element) => (2, format!("`{name}` {}", element.name)),
            };
            assert!(said(column, &words), "protocol.md: {} and {words}", question.method);
        }
        let told = match question.told {
            "()" => "`done`",
            "TraversalStats" => "`traced`",
            _ => "`coded`",
        };
        assert!(said(3, told), "protocol.md: {} is answered {told}", question.method);
        for (name, element) in answer(question) {
            let words = format!("`{name}` {}", element.name);
            assert!(said(4, &words), "protocol.md: {} answers {words}", question.method);
        }
    }
}

#[test]
fn the_page_of_the_protocol_has_the_elements_and_the_capabilities() {
    let page = read("docs/book/src/protocol.md");
    let (_, table) = page.split_once("## Elements").unwrap();
    let (table, _) = table.split_once("## Requests").unwrap();
    for (name, layout) in elements() {
        let row = table.lines().find(|line| line.contains(&format!("`{name}`"))).unwrap();
        let size = format!("{}", layout.size);
        assert!(row.split([' ', ',']).any(|word| word == size), "{name} has {size} bytes: {row}");
    }
    let (_, list) = page.split_once("`capabilities` are words of this list").unwrap();
    let (list, _) = list.split_once("\n\n").unwrap();
    let said: BTreeSet<_> = found::<1>(r"`([\w-]+)`", list).into_iter().flatten().collect();
    assert_eq!(said, Capabilities::all().names().into_iter().collect());
}
