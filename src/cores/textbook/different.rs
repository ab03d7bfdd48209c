//! Choices that are as right as those of the lecture: no case may fail them.

use super::change::Change;
use crate::contract::{
    Capabilities, Conventions, EmissionSides, Falloff, GlassFresnel, GlassRadiance, Precision,
    SmithTerm,
};

/// A core that is right, and not the same.
#[derive(Debug)]
pub struct Different {
    pub(super) change: Change,
    /// Kebab-case, unique: `textbook:NAME` is the core that chooses it.
    pub name: &'static str,
    /// What it does, in one line.
    pub summary: &'static str,
    /// The parts of the course whose answers it changes.
    pub parts: &'static [u32],
}

/// Every choice.
pub const DIFFERENT: &[Different] = &[
    Different {
        change: Change::UniformBounces,
        name: "uniform-bounces",
        summary: "the diffuse surface draws uniform directions, with their density",
        parts: &[3, 4, 5],
    },
    Different {
        change: Change::OtherRoulette,
        name: "other-roulette",
        summary: "dark paths are cut short by roulette of the core's own",
        parts: &[4, 5],
    },
    Different {
        change: Change::LargerOffset,
        name: "larger-offset",
        summary: "rays keep clear of surfaces by 1e-6 in place of 1e-10",
        parts: &[3, 4, 5],
    },
    Different {
        change: Change::StratifiedPixels,
        name: "stratified-pixels",
        summary: "the samples of a pixel fill it evenly",
        parts: &[1, 4, 5],
    },
    Different {
        change: Change::StratifiedLights,
        name: "stratified-lights",
        summary: "the samples of a light are stratified",
        parts: &[3, 4, 5],
    },
    Different {
        change: Change::MedianSplit,
        name: "median-split",
        summary: "nodes are halved, whatever rule is asked for",
        parts: &[2],
    },
    Different {
        change: Change::ReversedLeaves,
        name: "reversed-leaves",
        summary: "the primitives of a leaf are tested from the last to the first",
        parts: &[2],
    },
    Different {
        change: Change::SinglePrecision,
        name: "single-precision",
        summary: "every answer is rounded to f32, and the core says so",
        parts: &[1, 2, 3, 4, 5],
    },
    Different {
        change: Change::SchlickGlass,
        name: "schlick-glass",
        summary: "Schlick's approximation of the view's cosine, declared",
        parts: &[3, 4],
    },
    Different {
        change: Change::SchlickGlassOutside,
        name: "schlick-glass-outside",
        summary: "Schlick's approximation of the cosine on the thin side, declared",
        parts: &[3, 4],
    },
    Different {
        change: Change::CorrelatedSmith,
        name: "correlated-smith",
        summary: "the height-correlated Smith term, declared",
        parts: &[3, 4],
    },
    Different {
        change: Change::TwoSidedEmission,
        name: "two-sided-emission",
        summary: "lamps glow on both sides when they are seen, declared",
        parts: &[1, 3, 4],
    },
    Different {
        change: Change::NoFalloff,
        name: "no-falloff",
        summary: "point lights do not weaken with distance, declared",
        parts: &[3, 4],
    },
    Different {
        change: Change::UnscaledGlass,
        name: "unscaled-glass",
        summary: "radiance crosses glass unchanged, declared",
        parts: &[3, 4],
    },
    Different {
        change: Change::OwnNumbers,
        name: "own-numbers",
        summary: "the core draws its own random numbers, and says so",
        parts: &[3],
    },
    Different {
        change: Change::OtherGenerator,
        name: "other-generator",
        summary: "random numbers come from another generator",
        parts: &[1, 3, 4, 5],
    },
    Different {
        change: Change::ExtraDimensions,
        name: "extra-dimensions",
        summary: "every second random number is thrown away",
        parts: &[1, 3, 4, 5],
    },
];

/// What a copy with this change declares to have chosen.
pub fn conventions(change: Change) -> Conventions {
    let plain = Conventions::default();
    match change {
        Change::SchlickGlass => Conventions { glass_fresnel: GlassFresnel::Schlick, ..plain },
        Change::SchlickGlassOutside => {
            Conventions { glass_fresnel: GlassFresnel::SchlickOutside, ..plain }
        }
        Change::CorrelatedSmith => Conventions { smith_term: SmithTerm::HeightCorrelated, ..plain },
        Change::TwoSidedEmission => Conventions { emission: EmissionSides::Both, ..plain },
        Change::NoFalloff => Conventions { point_light_falloff: Falloff::None, ..plain },
        Change::UnscaledGlass => Conventions { glass_radiance: GlassRadiance::Unscaled, ..plain },
        _ => plain,
    }
}

/// What a copy with this change can be asked.
pub fn capabilities(change: Change) -> Capabilities {
    match change {
        Change::OwnNumbers => Capabilities::all() - Capabilities::CALLERS_RANDOMNESS,
        _ => Capabilities::all(),
    }
}

/// The arithmetic of a copy with this change.
pub fn precision(change: Change) -> Precision {
    match change {
        Change::SinglePrecision => Precision::Single,
        _ => Precision::Double,
    }
}
