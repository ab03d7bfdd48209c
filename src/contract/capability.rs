//! What a core can be asked, and what it may freely choose.

use super::Components;
use super::names::by_names;
use super::questions::questions;
use crate::math::Precision;
use bitflags::bitflags;
use serde::{Deserialize, Serialize};

/// The bits that the table of questions names, and those of what is not asked but honoured. Only their names cross.
macro_rules! capabilities {
    (() $($kind:ident $c:tt { $(#[$doc:meta])* $can:ident $(= $bit:literal)? $(fn $($rest:tt)*)? })*) => {
        bitflags! {
            /// What a core can be asked to do. A check declares what it needs; a missing capability skips the trial
            /// (and a suite may turn that skip into a failure).
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
            pub struct Capabilities: u64 {
                $($(
                    #[doc = concat!("Bit ", stringify!($bit), ": the question of this name, in [`super::questions`].")]
                    const $can = 1 << $bit;
                )?)*
                /// [`super::Acceleration::BruteForce`] is honoured.
                const BRUTE_FORCE = 1 << 5;
                /// Traversal counts are real.
                const TRAVERSAL_STATS = 1 << 6;
                /// Adaptive sampling in `render`, with true sample counts.
                const ADAPTIVE_SAMPLING = 1 << 12;
                /// The split rules of [`super::Split`] can be chosen.
                const SPLIT_RULES = 1 << 16;
                /// [`super::DirectSampling::Hemisphere`] is honoured.
                const HEMISPHERE_SAMPLING = 1 << 17;
                /// Bounce ranges that do not start at 0 (isolated bounces).
                const ISOLATED_BOUNCES = 1 << 18;
                /// Russian roulette with a given probability.
                const ROULETTE = 1 << 19;
                /// [`crate::scene::Surface::RoughGlass`] among the materials.
                const ROUGH_GLASS = 1 << 21;
                /// [`super::Film::variances`] of `render`.
                const REPORTED_VARIANCE = 1 << 22;
                /// [`super::RenderSettings::stratified`] is honoured.
                const STRATIFIED_PIXELS = 1 << 23;
                /// [`super::IntegratorSettings::by_depth`] is honoured.
                const DEPTH_LIMIT = 1 << 24;
                /// Sampling calls use the caller's random numbers, so they can be replayed.
                const CALLERS_RANDOMNESS = 1 << 32;
                /// The same settings and seed give the same bits.
                const DETERMINISTIC = 1 << 33;
                /// A promise: the noise of one pixel says nothing of the noise of another.
                const INDEPENDENT_PIXELS = 1 << 34;
                /// A promise: the core's own directions and points are drawn independently of each other.
                const INDEPENDENT_SAMPLES = 1 << 35;
                /// A promise: estimators as courses teach them (uniform hemisphere, uniform points on lights, roulette
                /// as told and no other), so that their variance is known.
                const PLAIN_ESTIMATORS = 1 << 36;
            }
        }
    };
}
questions! { capabilities, () }

impl Capabilities {
    /// What the contract leaves free unless a core promises it: whoever promises nothing is told, and not graded.
    pub(crate) const PROMISES: Self = Self::INDEPENDENT_PIXELS
        .union(Self::INDEPENDENT_SAMPLES)
        .union(Self::PLAIN_ESTIMATORS)
        .union(Self::SPLIT_RULES);
}

by_names! { Capabilities, "capability" }

/// Who the core is. Shown on every report page.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CoreInfo {
    /// `builtin`, `textbook`, or what the core calls itself.
    pub name: String,
    /// Its own version.
    pub version: String,
    /// What it can be asked.
    pub capabilities: Capabilities,
    /// What it can take from the bench.
    #[serde(default, skip_serializing_if = "Components::is_empty")]
    pub components: Components,
    /// The arithmetic it computes in.
    pub precision: Precision,
    /// What it has freely chosen.
    #[serde(default)]
    pub conventions: Conventions,
}

/// What is legitimately free, declared so that no core is blamed for a choice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Conventions {
    /// How a point light weakens with distance.
    pub point_light_falloff: Falloff,
    /// Which side of an emitting surface emits when it is seen.
    pub emission: EmissionSides,
    /// The masking term of the microfacet model.
    pub smith_term: SmithTerm,
    /// Reflectance of glass.
    pub glass_fresnel: GlassFresnel,
    /// Whether radiance is scaled by the index squared when it crosses an interface.
    pub glass_radiance: GlassRadiance,
}

/// How a point light weakens with distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Falloff {
    /// Intensity over distance squared: physics.
    #[default]
    InverseSquare,
    /// The same radiance at every distance, as in the course's base code.
    None,
}

/// Which side of an emitting surface emits when it is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EmissionSides {
    /// The side of the geometric normal.
    #[default]
    Front,
    /// Both sides.
    Both,
}

/// The masking term of the microfacet model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SmithTerm {
    /// G1(wo) · G1(wi), as Mitsuba has it.
    #[default]
    Separable,
    /// 1 / (1 + Λ(wo) + Λ(wi)).
    HeightCorrelated,
}

/// Reflectance of glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GlassFresnel {
    /// The unpolarised Fresnel equations.
    #[default]
    Exact,
    /// Schlick's approximation, as courses teach it: with the cosine of the view, outside and inside.
    Schlick,
    /// Schlick's approximation with the cosine on the side of lower index, from inside too: the same both ways through a face.
    SchlickOutside,
}

/// Whether radiance is scaled by the index squared when it crosses an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GlassRadiance {
    /// Radiance over index squared is conserved: physics.
    #[default]
    Scaled,
    /// Radiance itself is carried over.
    Unscaled,
}
