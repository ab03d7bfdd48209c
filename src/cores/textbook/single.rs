//! The answers of a core, rounded to f32.

use crate::contract::answer::Answer;
use crate::contract::question::*;
use crate::contract::{Acceleration, BuildStats, Built, BuiltScene, Components, Core, CoreInfo};

/// A core whose answers are those of another, rounded.
pub(crate) struct Single<C>(pub(crate) C);

struct SingleScene<'a>(Built<'a>);

/// Lets the other answer, and rounds that.
macro_rules! rounded {
    (() {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            let told = self.0.$method($($arg,)* $out)?;
            $out.round();
            Ok(told)
        }
    };
}

impl<C: Core> Core for Single<C> {
    fn info(&self) -> CoreInfo {
        self.0.info()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        self.0.take_components(components)
    }

    each_question! { Core rounded () }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        Ok(Box::new(SingleScene(self.0.build_scene(scene, how)?)))
    }
}

impl BuiltScene for SingleScene<'_> {
    fn stats(&self) -> BuildStats {
        self.0.stats()
    }

    each_question! { Scene rounded () }
}
