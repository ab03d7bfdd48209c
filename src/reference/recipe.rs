//! `references/recipes.toml`: what each reference is a picture of.

use super::MakeError;
use crate::scene::Overrides;
use crate::text::{Diagnostic, Source, Spanned, all_of, hint};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Recipe {
    pub(crate) scene: String,
    pub(crate) parameters: Overrides,
    /// The last bounce that is added up.
    pub(crate) bounces: u32,
    pub(crate) passes: u32,
    pub(crate) samples_per_pass: u32,
}

impl Recipe {
    /// Fewer passes leave the standard error itself uncertain by more than 18 %.
    pub(crate) const FEWEST_PASSES: u32 = 16;

    /// Mitsuba adds a pass up in single precision: 2.4e-6 is lost at 2⁸ samples, 4e-5 at 2¹².
    pub(crate) const MOST_SAMPLES_PER_PASS: u32 = 256;

    /// Whether passes of this kind give a mean and a standard error worth keeping.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.passes < Self::FEWEST_PASSES {
            return Err(format!("a reference needs at least {} passes", Self::FEWEST_PASSES));
        }
        if (1..=Self::MOST_SAMPLES_PER_PASS).contains(&self.samples_per_pass) {
            Ok(())
        } else {
            Err(format!("a pass has 1 to {} samples per pixel", Self::MOST_SAMPLES_PER_PASS))
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Entry {
    /// The reference's own name unless said otherwise.
    scene: Option<String>,
    /// What is changed in the scene.
    #[serde(default)]
    parameters: Overrides,
    /// The last bounce that is added up.
    bounces: u32,
    /// Independent images, whose differences are the noise.
    passes: u32,
    /// Of a pixel.
    samples_per_pass: u32,
}

/// Reads all recipes of a folder of references, by name.
pub(super) fn read_all(folder: &Path) -> Result<BTreeMap<String, Recipe>, MakeError> {
    let path = folder.join("recipes.toml");
    let source = Source::read(&path).map_err(MakeError::at(&path))?;
    parse(&source).map_err(|diagnostic| MakeError::Recipes(Box::new(diagnostic)))
}

pub(super) fn read(folder: &Path, name: &str) -> Result<Recipe, MakeError> {
    let mut recipes = read_all(folder)?;
    recipes.remove(name).ok_or_else(|| {
        let names = || recipes.keys().map(String::as_str);
        MakeError::NoRecipe { name: name.to_owned(), hint: hint(name, names(), || all_of(names())) }
    })
}

fn parse(source: &Source) -> Result<BTreeMap<String, Recipe>, Diagnostic> {
    let entries: BTreeMap<String, Spanned<Entry>> = source.parse_toml()?;
    let resolve = |(name, entry): (String, Spanned<Entry>)| {
        let span = entry.span();
        let entry = entry.into_inner();
        let recipe = Recipe {
            scene: entry.scene.unwrap_or_else(|| name.clone()),
            parameters: entry.parameters,
            bounces: entry.bounces,
            passes: entry.passes,
            samples_per_pass: entry.samples_per_pass,
        };
        recipe.check().map_err(|problem| source.diagnostic(span, problem))?;
        Ok((name, recipe))
    };
    entries.into_iter().map(resolve).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: &str = "[room]\nbounces = 5\npasses = 64\nsamples-per-pass = 64\n";

    fn parsed(text: &str) -> Result<BTreeMap<String, Recipe>, String> {
        parse(&Source::new("recipes.toml", text)).map_err(|diagnostic| diagnostic.to_string())
    }

    #[test]
    fn a_reference_is_of_the_scene_it_is_called_after_unless_said_otherwise() {
        assert_eq!(parsed(ROOM).unwrap()["room"].scene, "room");
        let other = format!("{ROOM}scene = \"hall\"\nparameters = {{ albedo = 0.5 }}\n");
        let recipe = &parsed(&other).unwrap()["room"];
        assert_eq!(recipe.scene, "hall");
        assert_eq!(recipe.parameters["albedo"].as_float(), Some(0.5));
    }

    #[test]
    fn too_few_passes_and_too_long_ones_are_refused_where_they_stand() {
        let message = parsed(&ROOM.replace("passes = 64", "passes = 4")).unwrap_err();
        assert!(message.contains("at least 16 passes"), "{message}");
        assert!(message.contains("recipes.toml:1:1"), "{message}");
        let message = parsed(&ROOM.replace("pass = 64", "pass = 1024")).unwrap_err();
        assert!(message.contains("1 to 256 samples"), "{message}");
    }

    #[test]
    fn an_unknown_word_is_answered_with_the_valid_ones() {
        let message = parsed(&ROOM.replace("bounces", "bounce")).unwrap_err();
        assert!(message.contains("did you mean `bounces`?"), "{message}");
    }

    #[test]
    fn an_unknown_reference_is_answered_with_the_one_that_was_meant() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("recipes.toml"), ROOM).unwrap();
        let message = read(folder.path(), "rooms").unwrap_err().to_string();
        assert!(message.contains("did you mean `room`?"), "{message}");
    }

    #[test]
    fn the_recipes_of_the_suite_are_good() {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/references"));
        assert!(read_all(folder).unwrap().len() >= 6);
    }
}
