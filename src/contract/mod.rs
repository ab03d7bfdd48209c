//! What a renderer core promises, and the plain data that crosses the boundary.
//!
//! A core implements [`Core`], and the scenes it has taken in implement [`BuiltScene`]. Their methods are the
//! questions of one table ([`mod@questions`]). Every method has a default that answers [`CoreError::Unsupported`]:
//! implement what you have, declare it in [`Core::info`], and the harness asks for nothing else.
//!
//! # Rules, once for all
//!
#![doc = include_str!("rules.md")]
//!
//! **Invariant:** one caller at a time. A core may use threads inside a call.

pub mod abi;
pub mod answer;
pub mod argument;
mod batch;
#[cfg(feature = "cli")]
pub(crate) mod beside;
mod breach;
mod capability;
mod circumstances;
mod components;
pub mod crossing;
mod error;
mod film;
mod names;
pub mod question;
pub mod questions;
mod settings;
pub(crate) mod turned;
pub mod validate;
mod work;

pub use batch::{
    AdaptiveMean, BoxHit, BsdfQuery, BsdfSample, BsdfValue, DirectionSample, Hit, LightSample,
    Primitive, Randomness, Ray, Sampler, TraversalStats,
};
pub use breach::{Breach, BreachKind, Place};
pub use capability::{
    Capabilities, Conventions, CoreInfo, EmissionSides, Falloff, GlassFresnel, GlassRadiance,
    SmithTerm,
};
pub use components::Components;
pub(crate) use error::numbers_of;
pub use error::{CoreError, Culprit, Result};
pub use film::Film;
pub use settings::{
    Acceleration, AdaptiveSettings, BuildStats, DirectSampling, IntegratorSettings, RenderSettings,
    Roulette, Split,
};

pub use crate::math::Precision;
pub use circumstances::Circumstances;
pub(crate) use work::Work;

use question::*;

/// What is the same for every core: lengths, angles, frames, directions. A list in Markdown.
pub(crate) const RULES: &str = include_str!("rules.md");

/// The method of a question, for cores that do not answer it.
macro_rules! unsupported {
    (() {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        $(#[$doc])*
        ///
        /// # Errors
        /// [`CoreError::Unsupported`], unless the core answers it.
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            let _ = ($($arg,)* $out);
            Err(CoreError::Unsupported(Capabilities::$can))
        }
    };
}

/// A renderer under test. Its questions are those of [`mod@questions`] that need no scene.
pub trait Core: Send {
    /// Who the core is, what it can do, and which conventions it follows.
    fn info(&self) -> CoreInfo;

    /// From now on, work with these components of the bench in place of its own, and with its own for all others.
    /// Asked before anything else, of cores whose [`CoreInfo::components`] has them.
    ///
    /// # Errors
    /// [`CoreError::Unsupported`], unless the core can.
    fn take_components(&mut self, components: Components) -> Result<()> {
        let _ = components;
        Err(CoreError::Unsupported(Capabilities::empty()))
    }

    each_question! { Core unsupported () }

    /// Take the scene in, and build whatever structure speeds it up.
    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        let _ = (scene, how);
        Err(CoreError::Unsupported(Capabilities::BUILD_SCENE))
    }
}

/// A scene as a core hands it over. It borrows the core.
pub type Built<'a> = Box<dyn BuiltScene + 'a>;

/// A scene the core has taken in: the only way to reach a traversal or a render, so that "intersect before
/// build" cannot be written. Its questions are those of [`mod@questions`] that need one.
pub trait BuiltScene {
    /// What the build made. Zero for what the core does not know.
    fn stats(&self) -> BuildStats;

    each_question! { Scene unsupported () }
}
