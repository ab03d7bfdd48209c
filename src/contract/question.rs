//! A question as data; and the words of the table of questions, for whoever expands it.

pub(crate) use super::questions::{each_question, questions};
pub(crate) use super::{
    AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue, Capabilities,
    CoreError, Culprit, DirectionSample, Film, Hit, IntegratorSettings, LightSample, Primitive,
    Randomness, Ray, RenderSettings, Result, Sampler, TraversalStats,
};
pub(crate) use crate::image::encoding::Encoding;
pub(crate) use crate::image::png::Picture;
pub use crate::scene::{Aabb, Camera, Material, SceneDescription};
pub(crate) use glam::{DVec2, DVec3};

use super::answer::Answer;
use super::argument::Argument;
use super::crossing::Part;

/// A question as others have to know it: what `tests/contract.rs` holds the header, Python and the protocol to.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    /// The method of [`super::Core`] or [`super::BuiltScene`].
    pub method: &'static str,
    /// Whether it is asked of a scene that has been built.
    pub within_scene: bool,
    /// The functions of `furnace_core.h` that answer it, which are the words of its requests too.
    pub in_c: &'static [&'static str],
    /// What a core declares that answers it.
    pub capability: Capabilities,
    /// Each argument with what of it crosses.
    pub arguments: &'static [(&'static str, &'static [Part])],
    /// What is filled, and of which arrays it is made.
    pub answer: (&'static str, &'static [Part]),
    /// The type of what is told besides.
    pub told: &'static str,
}

/// Whether requests of this name come while there is a scene.
pub(crate) fn is_within_a_scene(request: &str) -> bool {
    QUESTIONS.iter().any(|it| it.within_scene && it.requests().iter().any(|name| name == request))
}

impl Question {
    /// What its requests are called.
    pub fn requests(&self) -> Vec<String> {
        let own = [self.method];
        let names = if self.in_c.is_empty() { &own } else { self.in_c };
        names.iter().map(|name| name.replace('_', "-")).collect()
    }
}

macro_rules! list {
    (() $($kind:ident $c:tt {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        $(fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;)?
    })*) => {
        /// Every question, in the order of `furnace_core.h`.
        pub static QUESTIONS: &[Question] = &[$($(Question {
            method: stringify!($method),
            within_scene: within_scene!($kind),
            in_c: names!($c),
            capability: Capabilities::$can,
            arguments: &[$((stringify!($arg), <$ty as Argument<'_>>::PARTS)),*],
            answer: (stringify!($out), <$answer as Answer>::PARTS),
            told: stringify!($told),
        },)?)*];
    };
}

macro_rules! within_scene {
    (Scene) => {
        true
    };
    ($other:ident) => {
        false
    };
}
macro_rules! names {
    (($($c:ident: $type:ident),*)) => { &[$(stringify!($c)),*] };
}
questions! { list, () }
