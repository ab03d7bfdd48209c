//! Which references there are, and whether they are good.

use super::{MakeError, References, recipe};
use crate::scene::reference::{Reference, ReferenceError, load};
use crate::scene::{SceneDescription, SceneError};
use std::sync::Arc;

/// A reference that there is a recipe for.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    /// Its name.
    pub name: String,
    /// How to make it.
    pub recipe: super::Recipe,
    /// Whether it can be compared with.
    pub state: State,
}

/// Whether a reference can be compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// It can.
    Good(Box<Reference>),
    /// It has to be made.
    Bad(ReferenceError),
    /// Its scene cannot be had.
    NoScene(SceneError),
}

impl References {
    /// Every reference that there is a recipe for, in the order of the alphabet.
    pub fn list(&self) -> Result<Vec<Listed>, MakeError> {
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
