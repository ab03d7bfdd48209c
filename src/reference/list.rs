//! Which references there are, and whether they are good.

use super::{MakeError, References, recipe};
use crate::scene::reference::{Reference, ReferenceError, load};
use crate::scene::{SceneDescription, SceneError};
use std::sync::Arc;

/// A reference that there is a recipe for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Listed {
    pub(crate) name: String,
    pub(crate) recipe: super::Recipe,
    pub(crate) state: State,
}

/// Whether a reference can be compared with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum State {
    Good(Box<Reference>),
    Bad(ReferenceError),
    NoScene(SceneError),
}

impl References {
    /// Every reference that there is a recipe for, in the order of the alphabet.
    pub(crate) fn list(&self) -> Result<Vec<Listed>, MakeError> {
        let recipes = recipe::read_all(&self.folder)?;
        let listed = |(name, recipe): (String, super::Recipe)| {
            let scene = self.scenes.load(&recipe.scene, &recipe.parameters);
            let state = self.state(&name, scene);
            Listed { name, recipe, state }
        };
        Ok(recipes.into_iter().map(listed).collect())
    }

    fn state(&self, name: &str, scene: Result<Arc<SceneDescription>, SceneError>) -> State {
        match scene.map(|scene| load(&self.folder, name, &scene)) {
            Ok(Ok(reference)) => State::Good(Box::new(reference)),
            Ok(Err(error)) => State::Bad(error),
            Err(error) => State::NoScene(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Library;
    use std::collections::BTreeSet;
    use std::path::Path;

    const ROOT: &str = env!("CARGO_MANIFEST_DIR");

    fn listed() -> Vec<Listed> {
        let root = Path::new(ROOT);
        References::new(root.join("references"), Library::new(root.join("scenes"))).list().unwrap()
    }

    #[test]
    fn every_reference_of_the_suite_is_good() {
        for Listed { name, recipe, state } in listed() {
            let State::Good(reference) = state else { panic!("{name}: {state:?}") };
            assert_eq!(reference.provenance.bounces, [0, recipe.bounces], "{name}");
            assert_eq!(reference.provenance.passes, recipe.passes, "{name}");
            assert!(reference.provenance.median_relative_error < 0.01, "{name}");
        }
    }

    #[test]
    fn no_reference_is_without_a_recipe_and_all_of_them_are_small() {
        let recipes: BTreeSet<String> = listed().into_iter().map(|listed| listed.name).collect();
        let mut bytes = 0;
        for entry in std::fs::read_dir(Path::new(ROOT).join("references")).unwrap() {
            let folder = entry.unwrap();
            let name = folder.file_name().into_string().unwrap();
            if folder.path().is_dir() && !name.starts_with('.') {
                assert!(recipes.contains(&name), "{name}");
                bytes += folder.path().join("reference.exr").metadata().unwrap().len();
            }
        }
        assert!(bytes < 12_000_000, "{bytes}");
    }
}
