//! TOML → [`Case`]. The head is read first, then the check reads its own `[expect]` out of the whole text, so that
//! every complaint knows its line.

use super::{Case, Foundation, SceneChoice, Tier};
use crate::checks::{self, CHECKS, PrepareError};
use crate::text::{Diagnostic, Source, Spanned, did_you_mean, listed};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::path::Path;

/// What every case says, whatever its check.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Head {
    title: Spanned<String>,
    teaches: String,
    source: String,
    #[serde(default)]
    tags: Vec<String>,
    #[serde(default)]
    tier: Tier,
    #[serde(default)]
    proves: Vec<Foundation>,
    #[serde(default)]
    rests_on: Vec<Foundation>,
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

/// Makes the case `id` of the text of its file.
///
/// # Errors
/// A diagnostic that points at the line at fault.
pub fn parse(id: &str, path: &Path, source: &Source) -> Result<Case, Diagnostic> {
    let head: Head = source.parse_toml()?;
    if head.title.get_ref().trim().is_empty() {
        return Err(source.diagnostic(head.title.span(), "the title is empty"));
    }
    let check = find_check(source, &head.check)?;
    let prepared = (check.prepare)(&source.text).map_err(|error| match error {
        PrepareError::Toml(error) => source.toml_diagnostic(error),
        PrepareError::Invalid(message) => source.diagnostic(expect_span(&source.text), message),
    })?;
    Ok(Case {
        id: id.to_owned(),
        title: head.title.into_inner(),
        teaches: head.teaches,
        source: head.source,
        tags: head.tags,
        tier: head.tier,
        proves: head.proves,
        rests_on: head.rests_on,
        scene: head.scene.map(|scene| scene_choice(source, scene)).transpose()?,
        check,
        prepared,
        path: path.to_owned(),
        hash: hash(&source.text),
    })
}

fn find_check(
    source: &Source,
    name: &Spanned<String>,
) -> Result<&'static checks::CheckKind, Diagnostic> {
    checks::find(name.get_ref()).ok_or_else(|| {
        let word = name.get_ref();
        let names = || CHECKS.iter().map(|kind| kind.name);
        let hint = did_you_mean(word, names());
        source
            .diagnostic(name.span(), format!("there is no check `{word}`"))
            .with_hint(hint.unwrap_or_else(|| format!("the checks are {}", listed(names()))))
    })
}

fn scene_choice(source: &Source, entry: Spanned<SceneEntry>) -> Result<SceneChoice, Diagnostic> {
    let span = entry.span();
    match entry.into_inner() {
        SceneEntry::Name(name) => Ok(SceneChoice { name, parameters: toml::Table::new() }),
        SceneEntry::Changed(mut parameters) => match parameters.remove("name") {
            Some(toml::Value::String(name)) => Ok(SceneChoice { name, parameters }),
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

fn hash(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}
