//! As much of XML Schema as the fixture uses: elements at the top, references below them, attributes and a few types.

use roxmltree::{Document, Node};

const XS: &str = "http://www.w3.org/2001/XMLSchema";

/// What is wrong with a document by a schema.
pub fn complaint(text: &str, schema: &str) -> Option<String> {
    let document = match Document::parse(text) {
        Ok(document) => document,
        Err(error) => return Some(error.to_string()),
    };
    let schema = Document::parse(schema).unwrap();
    let mut elements = document.descendants().filter(Node::is_element);
    elements.find_map(|element| wrong_element(element, schema.root_element()))
}

fn named<'a>(schema: Node<'a, 'a>, kind: &str, name: &str) -> Option<Node<'a, 'a>> {
    let mut tops = schema.children().filter(|top| top.has_tag_name((XS, kind)));
    tops.find(|top| top.attribute("name") == Some(name))
}

fn wrong_element(element: Node<'_, '_>, schema: Node<'_, '_>) -> Option<String> {
    let name = element.tag_name().name();
    let Some(rule) = named(schema, "element", name) else {
        return Some(format!("<{name}> is not known"));
    };
    let inner = rule.children().find(|node| node.has_tag_name((XS, "complexType")));
    let shared = || named(schema, "complexType", rule.attribute("type")?);
    let Some(kind) = inner.or_else(shared) else {
        let is_plain =
            element.attributes().len() == 0 && !element.children().any(|n| n.is_element());
        return (!is_plain).then(|| format!("<{name}> holds nothing but text"));
    };
    wrong_attribute(element, kind).or_else(|| wrong_child(element, kind))
}

fn wrong_attribute(element: Node<'_, '_>, kind: Node<'_, '_>) -> Option<String> {
    let name = element.tag_name().name();
    let rules: Vec<_> =
        kind.children().filter(|node| node.has_tag_name((XS, "attribute"))).collect();
    for rule in &rules {
        let key = rule.attribute("name").unwrap();
        match element.attribute(key) {
            None if rule.attribute("use") == Some("required") => {
                return Some(format!("<{name}> lacks {key}"));
            }
            Some(value) if !is_of_type(value, rule.attribute("type").unwrap()) => {
                return Some(format!("<{name} {key}=\"{value}\">"));
            }
            _ => {}
        }
    }
    let is_known = |key: &str| rules.iter().any(|rule| rule.attribute("name") == Some(key));
    let mut unknown = element.attributes().filter(|attribute| !is_known(attribute.name()));
    unknown.next().map(|attribute| format!("<{name}> has no {}", attribute.name()))
}

fn wrong_child(element: Node<'_, '_>, kind: Node<'_, '_>) -> Option<String> {
    let name = element.tag_name().name();
    let known: Vec<_> = kind.descendants().filter_map(|node| node.attribute("ref")).collect();
    let mut below =
        element.children().filter(Node::is_element).map(|child| child.tag_name().name());
    if let Some(child) = below.find(|child| !known.contains(child)) {
        return Some(format!("<{child}> in <{name}>"));
    }
    let is_mixed = kind.attribute("mixed") == Some("true");
    let mut text = element.children().filter(Node::is_text).filter_map(|node| node.text());
    let has_text = text.any(|text| !text.trim().is_empty());
    (has_text && !is_mixed).then(|| format!("text in <{name}>"))
}

fn is_of_type(value: &str, kind: &str) -> bool {
    match kind {
        "xs:string" => true,
        "xs:nonNegativeInteger" => value.parse::<u64>().is_ok(),
        // Without an exponent, which `parse` would take.
        "xs:decimal" => {
            value.parse::<f64>().is_ok() && value.chars().all(|c| "+-.0123456789".contains(c))
        }
        other => panic!("the schema says type `{other}`, which is not understood"),
    }
}

#[test]
fn wrong_documents_are_found() {
    let schema = super::fixture("junit.xsd");
    let is_right = |text: &str| complaint(text, &schema).is_none();
    let suite = |inner: &str| {
        format!("<testsuites><testsuite name='a' tests='1'>{inner}</testsuite></testsuites>")
    };
    assert!(is_right(&suite(
        "<testcase name='b' time='0.5'><failure message='c'>d</failure></testcase>"
    )));
    for wrong in [
        "<testcase time='1'/>",
        "<testcase name='b' time='soon'/>",
        "<testcase name='b' time='1e3'/>",
        "<testcase name='b' colour='red'/>",
        "<testcase name='b'><testcase name='c'/></testcase>",
        "<failure/>",
        "words",
        "<testcase name='b'>",
    ] {
        assert!(!is_right(&suite(wrong)), "{wrong}");
    }
}
