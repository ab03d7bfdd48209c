//! TOML → [`Case`]. The head is read first, then the check reads its own `[expect]` out of the whole text, so that
//! every complaint knows its line.

use super::{Case, Foundation, PARTS, Role, SceneChoice, Tier};
use crate::checks::{self, PrepareError, RENAMED};
use crate::contract::Capabilities;
use crate::text::document::trace;
use crate::text::schema::{self, Instead};
use crate::text::{Diagnostic, Source, Spanned, Words, did_you_mean, fingerprint, listed};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::Path;

/// What every case says, whatever its check.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Head {
    /// The claim in words.
    title: Words,
    /// What a student learns from it.
    teaches: Words,
    /// Why the expected numbers are true.
    source: Words,
    /// Words to select by, without `@`.
    #[serde(default)]
    tags: Vec<Spanned<Words>>,
    #[serde(default)]
    tier: Tier,
    /// What is proven where it passes, for other cases to rest on.
    #[serde(default)]
    proves: Vec<Foundation>,
    /// What it rests on beside what follows from its scene.
    #[serde(default)]
    rests_on: Vec<Foundation>,
    role: Option<Role>,
    /// What a core has to promise to be graded by it: the contract leaves it free.
    promise: Option<Spanned<String>>,
    /// How answers are judged.
    check: Spanned<String>,
    scene: Option<Spanned<SceneEntry>>,
    /// The check's own; it reads it with its own words.
    #[expect(dead_code, reason = "named so that `deny_unknown_fields` lets it through")]
    expect: toml::Table,
}

/// `scene = "box"` or `scene = { name = "box", albedo = 0.5 }`.
#[derive(Deserialize)]
#[serde(untagged)]
enum SceneEntry {
    Name(String),
    Changed(toml::Table),
}

/// The JSON Schema of a case: its head, and for each check what `[expect]` holds.
pub(crate) fn schema() -> Value {
    let mut schema = schema::of(trace::<Head>, Instead::Nothing);
    let of_check = |check: &checks::CheckKind| {
        let is_it = json!({ "properties": { "check": { "const": check.name } } });
        let expect = schema::of(check.trace, Instead::Nothing);
        json!({ "if": is_it, "then": { "properties": { "expect": expect } } })
    };
    let names: Vec<_> = checks::all().map(|check| check.name).collect();
    let changed = json!({ "type": "object", "required": ["name"] });
    schema["properties"]["scene"] = json!({ "anyOf": [{ "type": "string" }, changed] });
    schema["properties"]["check"] = json!({ "enum": names });
    schema["properties"]["promise"] = json!({ "enum": Capabilities::PROMISES.names() });
    schema["properties"]["expect"] = json!({ "type": "object" });
    schema["required"] = json!(["title", "teaches", "source", "check", "expect"]);
    schema["allOf"] = checks::all().map(of_check).collect();
    schema
}

/// Makes the case `id` of the text of its file.
pub(crate) fn parse(id: &str, path: &Path, source: &Source) -> Result<Case, Diagnostic> {
    let head: Head = source.parse_toml()?;
    refuse_unknown_parts(source, &head.tags)?;
    let check = find_check(source, &head.check)?;
    let prepared = (check.prepare)(&source.text).map_err(|error| match error {
        PrepareError::Toml(error) => source.toml_diagnostic(error),
        PrepareError::Invalid(message) => source.diagnostic(expect_span(&source.text), message),
    })?;
    Ok(Case {
        id: id.to_owned(),
        title: head.title.0,
        teaches: head.teaches.0,
        source: head.source.0,
        tags: head.tags.into_iter().map(|tag| tag.into_inner().0).collect(),
        tier: head.tier,
        proves: head.proves,
        rests_on: head.rests_on,
        role: head.role,
        promise: promise(source, head.promise.as_ref())?,
        scene: head.scene.map(|scene| scene_choice(source, scene)).transpose()?,
        check,
        prepared,
        path: path.to_owned(),
        hash: fingerprint(source.text.as_bytes()),
    })
}

/// A tag `part-2` selects by a part that there is.
fn refuse_unknown_parts(source: &Source, tags: &[Spanned<Words>]) -> Result<(), Diagnostic> {
    let is_part = |number: &str| PARTS.iter().any(|part| part.number.to_string() == number);
    let is_unknown =
        |tag: &&Spanned<Words>| tag.get_ref().0.strip_prefix("part-").is_some_and(|n| !is_part(n));
    match tags.iter().find(is_unknown) {
        None => Ok(()),
        Some(tag) => {
            let problem = format!("there is no `{}`", tag.get_ref().0);
            let hint = format!("the parts are 1 to {}", PARTS.len());
            Err(source.diagnostic(tag.span(), problem).with_hint(hint))
        }
    }
}

/// What a core has to promise to be graded by the case; empty: nothing.
fn promise(source: &Source, word: Option<&Spanned<String>>) -> Result<Capabilities, Diagnostic> {
    let Some(word) = word else { return Ok(Capabilities::empty()) };
    let promises = Capabilities::PROMISES.names();
    if promises.contains(word.get_ref()) {
        return Ok(
            Capabilities::from_names(std::slice::from_ref(word.get_ref())).unwrap_or_default()
        );
    }
    let problem = format!("there is no promise `{}`", word.get_ref());
    let hint = format!("the promises are {}", listed(promises.iter().map(String::as_str)));
    Err(source.diagnostic(word.span(), problem).with_hint(hint))
}

fn find_check(
    source: &Source,
    name: &Spanned<String>,
) -> Result<&'static checks::CheckKind, Diagnostic> {
    checks::find(name.get_ref()).ok_or_else(|| {
        let word = name.get_ref();
        let names = || checks::all().map(|kind| kind.name);
        let renamed = RENAMED.iter().find(|(old, _)| old == word);
        let hint = renamed.map(|(_, new)| format!("it is called `{new}` now"));
        let hint = hint.or_else(|| did_you_mean(word, names()));
        source
            .diagnostic(name.span(), format!("unknown check `{word}`"))
            .with_hint(hint.unwrap_or_else(|| format!("the checks are {}", listed(names()))))
    })
}

fn scene_choice(source: &Source, entry: Spanned<SceneEntry>) -> Result<SceneChoice, Diagnostic> {
    let span = entry.span();
    match entry.into_inner() {
        SceneEntry::Name(name) => {
            Ok(SceneChoice { name, parameters: toml::Table::new(), source: source.clone() })
        }
        SceneEntry::Changed(mut parameters) => match parameters.remove("name") {
            Some(toml::Value::String(name)) => {
                Ok(SceneChoice { name, parameters, source: source.clone() })
            }
            _ => Err(source
                .diagnostic(span, "the scene has no name")
                .with_hint("write `scene = { name = \"…\", parameter = value }`")),
        },
    }
}

/// The line of `[expect]`, for complaints about all of it.
fn expect_span(text: &str) -> std::ops::Range<usize> {
    let start = text.find("[expect]").unwrap_or(0);
    start..start + "[expect]".len().min(text.len() - start)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"title = "x"
teaches = "x"
source = "x"
tags = ["part-4"]
check = "mean-radiance"
scene = "sphere-furnace"
[expect]
ray = { from = [0, 0, 0], toward = [0, 0, 1] }
samples-per-light = 1
detects = "1 %"
at-most = "1 k paths"
row = [{ bounces = [0, 5], radiance = [1, 1, 1] }]
"#;

    /// The line of the complaint about the case with `right` replaced.
    fn line_of_complaint(right: &str, wrong: &str) -> usize {
        assert!(CASE.contains(right));
        let source = Source::new("cases/integrator/x.toml", CASE.replace(right, wrong));
        match parse("integrator/x", Path::new("x"), &source) {
            Ok(_) => panic!("`{wrong}` is taken for right"),
            Err(diagnostic) => diagnostic.line(),
        }
    }

    #[test]
    fn a_promise_that_there_is_not_is_told_with_those_there_are() {
        let word = |word: &str| format!("source = \"x\"\npromise = \"{word}\"");
        assert_eq!(line_of_complaint("source = \"x\"", &word("deterministic")), 4);
    }

    #[test]
    fn what_a_core_has_not_promised_is_not_held_against_it() {
        let promising =
            CASE.replace("source = \"x\"", "source = \"x\"\npromise = \"plain-estimators\"");
        let source = Source::new("cases/integrator/x.toml", promising);
        let case = parse("integrator/x", Path::new("x"), &source).unwrap();
        assert_eq!(case.tier_on(Capabilities::all()), Tier::Graded);
        assert_eq!(case.tier_on(Capabilities::all() - Capabilities::PROMISES), Tier::Informational);
    }

    #[test]
    fn a_value_out_of_range_is_told_where_it_stands() {
        assert_eq!(line_of_complaint("source = \"x\"", "source = \" \""), 3);
        assert_eq!(line_of_complaint("part-4", "part-9"), 4);
        assert_eq!(line_of_complaint("toward = [0, 0, 1]", "toward = [0, 0, 0]"), 8);
        assert_eq!(line_of_complaint("from = [0, 0, 0]", "from = [nan, 0, 0]"), 8);
        assert_eq!(line_of_complaint("samples-per-light = 1", "samples-per-light = 0"), 9);
        assert_eq!(line_of_complaint("\"1 %\"", "\"0 %\""), 10);
        assert_eq!(line_of_complaint("\"1 %\"", "\"500 %\""), 10);
        assert_eq!(line_of_complaint("1 k paths", "0 paths"), 11);
        assert_eq!(line_of_complaint("[0, 5]", "[5, 0]"), 12);
        assert_eq!(line_of_complaint("[1, 1, 1]", "[nan, 1, 1]"), 12);
        assert_eq!(line_of_complaint("[1, 1, 1]", "-1"), 12);
        assert_eq!(line_of_complaint("[{ bounces = [0, 5], radiance = [1, 1, 1] }]", "[]"), 12);
    }
}
