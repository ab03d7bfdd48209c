//! `scenes/<name>.toml` → [`SceneDescription`].
//!
//! One file a part of the vocabulary: `camera`, `material`, `shape`, `light`. `parameter` puts values in for `"$name"`.
//!
//! ```toml
//! title  = "A sphere that emits inside"
//! source = "Closed form"
//!
//! [parameters]
//! albedo = 0.5                 # a case may say otherwise
//!
//! [camera]
//! position       = [0, 0, 0]
//! look-at        = [0, 0, -1]
//! horizontal-fov = "60 deg"
//! film           = [128, 96]
//!
//! [material.wall]
//! diffuse  = "$albedo"
//! emission = 1
//!
//! [[shape]]
//! name     = "room"
//! material = "wall"
//! sphere   = { centre = [0, 0, 0], radius = 1, inward = true }
//! ```

/// Tables of a scene file: unknown keys are mistakes, words are joined by hyphens.
macro_rules! tables {
    ($($(#[$meta:meta])* $vis:vis struct $name:ident { $($fields:tt)* })*) => {$(
        $(#[$meta])*
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields, rename_all = "kebab-case")]
        $vis struct $name { $($fields)* }
    )*};
}

mod camera;
mod geometry;
mod light;
mod material;
mod parameter;
mod shape;

use super::{SceneDescription, SceneError};
use crate::text::document::trace;
use crate::text::schema::{self, Instead};
use crate::text::{Diagnostic, Source, Spanned, listed, read_table};
use parameter::Parameters;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use toml::de::DeTable;

/// Values that a case gives to parameters of a scene, by name.
pub type Overrides = toml::Table;

tables! {
    struct SceneFile {
        #[serde(rename = "title")] _title: String,
        /// Where the scene, or the number it is known by, comes from.
        #[serde(rename = "source")] _source: String,
        /// What images are rendered with.
        camera: Option<camera::Entry>,
        /// Each with a name of its own.
        #[serde(default)] material: BTreeMap<String, Spanned<material::Entry>>,
        #[serde(default)] shape: Vec<Spanned<shape::Entry>>,
        /// The lights that are not shapes.
        #[serde(default)] light: Vec<Spanned<light::Entry>>,
    }
}

/// The JSON Schema of a scene.
pub(crate) fn schema() -> Value {
    let mut schema = schema::of(trace::<SceneFile>, Instead::Parameter);
    schema["properties"]["parameters"] = json!({ "type": "object" });
    schema["required"] = json!(["title", "source"]);
    schema
}

/// What every part of the vocabulary needs in order to resolve itself or to complain.
struct Context<'a> {
    source: &'a Source,
    /// Mesh files are named relative to this folder.
    folder: &'a Path,
}

impl Context<'_> {
    fn wrong(&self, span: Range<usize>, message: impl Into<String>) -> Diagnostic {
        self.source.diagnostic(span, message)
    }
}

/// The scene that `source` describes. `name` is what it will be called.
pub(super) fn parse(
    name: &str,
    source: &Source,
    folder: &Path,
    overrides: &Overrides,
) -> Result<SceneDescription, SceneError> {
    let (file, parameters) = read(name, source, overrides)?;
    let context = Context { source, folder };
    resolve(name, file, &context).map_err(|diagnostic| parameters.explain(diagnostic))
}

fn read(
    name: &str,
    source: &Source,
    overrides: &Overrides,
) -> Result<(SceneFile, Parameters), SceneError> {
    let parameters = Parameters::read(name, source, overrides)?;
    let mut document =
        DeTable::parse(&source.text).map_err(|error| source.toml_diagnostic(error))?;
    parameters.substitute(source, document.get_mut())?;
    let file =
        read_table(&document).map_err(|error| parameters.explain(source.toml_diagnostic(error)))?;
    Ok((file, parameters))
}

fn resolve(
    name: &str,
    file: SceneFile,
    context: &Context<'_>,
) -> Result<SceneDescription, Diagnostic> {
    let mut scene = SceneDescription { name: name.to_owned(), ..SceneDescription::default() };
    scene.camera = file.camera.map(|camera| camera.resolve(context)).transpose()?;
    let materials = material::resolve_all(file.material, context)?;
    shape::resolve_all(file.shape, &materials, context, &mut scene)?;
    scene.materials = materials.into_scene(context)?;
    scene.lights = light::resolve_all(file.light, context)?;
    Ok(scene.with_area_lights())
}

/// The one entry that is there: the file says `diffuse = …` or `mirror = …`, never both and never neither.
fn exactly_one<T>(
    what: &str,
    entries: impl IntoIterator<Item = (&'static str, Option<T>)>,
) -> Result<T, String> {
    let (mut words, mut given) = (Vec::new(), Vec::new());
    for (word, entry) in entries {
        words.push(word);
        given.extend(entry.map(|entry| (word, entry)));
    }
    if given.len() > 1 {
        let both = given.iter().map(|(word, _)| format!("`{word}`")).collect::<Vec<_>>();
        return Err(format!("{what} must be one thing, not {}", both.join(" and ")));
    }
    match given.pop() {
        Some((_, entry)) => Ok(entry),
        None => Err(format!("{what} needs one of {}", listed(words))),
    }
}

#[cfg(test)]
mod tests;
