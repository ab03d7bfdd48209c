//! The scene that a case names, and what it changes in it.

use crate::scene::{Library, SceneDescription, SceneError};
use crate::text::Source;
use std::ops::Range;
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// A scene and the parameters that a case changes in it.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneChoice {
    /// File name without `.toml`.
    pub(crate) name: String,
    /// Values instead of those in the scene's `[parameters]`.
    pub(crate) parameters: toml::Table,
    pub(super) source: Source,
}

impl SceneChoice {
    /// The scene itself.
    ///
    /// # Errors
    /// What is wrong with the choice points into the case, what is wrong with the scene into its own file.
    pub(crate) fn load(&self, scenes: &Library) -> Result<Arc<SceneDescription>, SceneError> {
        scenes.load(&self.name, &self.parameters).map_err(|error| self.blame(error))
    }

    fn blame(&self, error: SceneError) -> SceneError {
        match error {
            SceneError::NoSuchScene { name, hint, .. } => {
                self.complaint("name", format!("there is no scene `{name}`"), Some(hint))
            }
            SceneError::NoSuchParameter { parameter, problem, hint } => {
                self.complaint(&parameter, problem, hint)
            }
            SceneError::WrongParameter { parameter, diagnostic } => {
                let used = format!("used in {}:{}", diagnostic.source.name, diagnostic.line());
                self.complaint(&parameter, diagnostic.message, Some(used))
            }
            other => other,
        }
    }

    fn complaint(&self, key: &str, problem: String, hint: Option<String>) -> SceneError {
        self.source.diagnostic(self.place_of(key), problem).with_hint_if_any(hint).into()
    }

    /// Where the case writes the value of `key`: in its `scene`, or at it where that is a name alone.
    fn place_of(&self, key: &str) -> Range<usize> {
        let Ok(document) = DeTable::parse(&self.source.text) else { return 0..0 };
        let Some(scene) = document.get_ref().get("scene") else { return 0..0 };
        match scene.get_ref() {
            DeValue::Table(table) => table.get(key).map_or_else(|| scene.span(), |at| at.span()),
            _ => scene.span(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of `scene = ...` in the second line of a case.
    fn complaint(scene: &str) -> String {
        let text = format!("title = \"x\"\nscene = {scene}\n");
        let mut table: toml::Table = toml::from_str(&text).unwrap();
        let (name, parameters) = match table.remove("scene").unwrap() {
            toml::Value::Table(mut parameters) => {
                (parameters.remove("name").unwrap().as_str().unwrap().to_owned(), parameters)
            }
            name => (name.as_str().unwrap().to_owned(), toml::Table::new()),
        };
        let source = Source::new("cases/x.toml", text);
        let library = Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
        let choice = SceneChoice { name, parameters, source };
        choice.load(&library).unwrap_err().to_string()
    }

    #[test]
    fn what_a_case_writes_is_underlined_in_the_case() {
        let parts = [
            ("\"sphere-furnice\"", "2:9", "did you mean `sphere-furnace`?"),
            ("{ name = \"sphere-furnice\" }", "2:18", "there is no scene `sphere-furnice`"),
            ("{ name = \"sphere-furnace\", albdo = 0.5 }", "2:44", "did you mean `albedo`?"),
            ("{ name = \"sphere-furnace\", albedo = 1.5 }", "2:45", "used in "),
        ];
        for (scene, place, words) in parts {
            let message = complaint(scene);
            assert!(message.contains(&format!("cases/x.toml:{place}")), "{message}");
            assert!(message.contains(words), "{message}");
        }
    }
}
