//! How a core is asked to build, integrate and render.

use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// What stands between a ray and the primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", rename_all_fields = "kebab-case")]
pub enum Acceleration {
    /// A loop over every primitive: the oracle of every BVH check and the baseline of every speed-up.
    BruteForce,
    /// A bounding volume hierarchy.
    Bvh {
        /// How a node is divided. [`Split::CoresChoice`] unless the core declares `SPLIT_RULES`.
        split: Split,
        /// At most this many primitives in a leaf, as far as they can be told apart.
        max_leaf_size: u32,
        /// Whether the tests of its rays are asked for: a core that is lent counted tests is lent them then.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        counted: bool,
    },
}

impl Acceleration {
    /// The core's own best structure.
    pub const DEFAULT: Self =
        Self::Bvh { split: Split::CoresChoice, max_leaf_size: 4, counted: false };
    /// The same with tests that are counted.
    pub const COUNTED: Self =
        Self::Bvh { split: Split::CoresChoice, max_leaf_size: 4, counted: true };

    /// Whether tests of rays are asked for.
    pub(crate) const fn is_counted(self) -> bool {
        matches!(self, Self::Bvh { counted: true, .. })
    }
}

/// How a node of the BVH is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Split {
    /// Whatever the core thinks best.
    #[default]
    CoresChoice,
    /// Equal counts along the longest axis.
    Median,
    /// At the mean of the centroids along the longest axis.
    MeanOfCentroids,
    /// At the middle of the box of centroids along its longest axis.
    Midpoint,
    /// The surface area heuristic.
    SurfaceArea,
}

/// What the build made. Zero for what is not known.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct BuildStats {
    /// Inner nodes and leaves.
    pub nodes: u64,
    /// Leaves.
    pub leaves: u64,
    /// Nodes on the longest way from the root to a leaf.
    pub max_depth: u64,
    /// Memory of the structure.
    pub bytes: u64,
}

/// How a path is traced.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct IntegratorSettings {
    /// Shadow rays to each area light or sky at each vertex; a delta light always gets one.
    /// With hemisphere sampling this many directions *per light* are drawn.
    pub samples_per_light: u32,
    /// Which bounces to add up: `0..=0` emission that the camera sees, `1..=1` light scattered once,
    /// `0..=m` everything up to m scatterings.
    pub bounces: RangeInclusive<u32>,
    /// Of a core with [`super::Capabilities::DEPTH_LIMIT`] alone: what its renderer shows at the maximum depth that
    /// `bounces` end with. They begin at 0.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub by_depth: bool,
    /// How direct light is sampled at each vertex.
    pub direct: DirectSampling,
    /// When paths end before the last bounce asked for.
    pub roulette: Option<Roulette>,
    /// The only source of randomness. Different seeds give independent estimates.
    pub seed: u64,
    /// Threads the core may use; 0 means as many as it likes. The answer must not depend on it.
    pub threads: u32,
}

impl Default for IntegratorSettings {
    fn default() -> Self {
        Self {
            samples_per_light: 1,
            bounces: 0..=1,
            by_depth: false,
            direct: DirectSampling::Lights,
            roulette: None,
            seed: 0,
            threads: 0,
        }
    }
}

/// How direct light is sampled at each vertex that is not a mirror or glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DirectSampling {
    /// Uniform directions over the hemisphere, adding what is emitted where they arrive. Lights that no direction
    /// can meet (point, directional) are sampled as in [`Self::Lights`].
    Hemisphere,
    /// Points on the lights. A core may combine them with BSDF samples on glossy surfaces.
    #[default]
    Lights,
}

/// Russian roulette.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Roulette {
    /// Probability of stopping at each bounce it is played at, in [0, 1).
    pub stop: f64,
    /// The first bounces are traced without it: 1 is "always at least one indirect bounce".
    pub guaranteed: u32,
}

/// How a picture is made. By default it has no pixels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct RenderSettings {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Camera rays per pixel, or the cap if adaptive.
    pub samples_per_pixel: u32,
    /// How each is traced.
    pub integrator: IntegratorSettings,
    /// Stop early where the noise allows.
    pub adaptive: Option<AdaptiveSettings>,
    /// Of k · k samples of a pixel one lies in each cell of a grid of k by k. Asked of cores with
    /// [`super::Capabilities::STRATIFIED_PIXELS`] alone; off, samples lie as the core likes.
    #[serde(default)]
    pub stratified: bool,
}

/// The course's adaptive rule: after every batch, with mean μ and sample standard deviation σ (n − 1) of the n
/// luminances so far, stop if 1.96 σ/√n ≤ max_tolerance · μ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct AdaptiveSettings {
    /// Samples between two looks.
    pub samples_per_batch: u32,
    /// Half width of the 95 % interval, relative to the mean.
    pub max_tolerance: f64,
}

impl Default for AdaptiveSettings {
    /// The course's own.
    fn default() -> Self {
        Self { samples_per_batch: 32, max_tolerance: 0.05 }
    }
}
