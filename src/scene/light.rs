//! Lights: point, directional, constant and gradient environment lights (no environment maps), area lights.

use super::Rgb;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A light of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Light {
    /// Shines from a point equally in all directions.
    Point {
        /// World space.
        position: DVec3,
        /// Watts per steradian.
        intensity: Rgb,
    },
    /// Shines from infinitely far away.
    Directional {
        /// The way the light travels, unit.
        direction: DVec3,
        /// Watts per square unit on a surface that faces the light.
        irradiance: Rgb,
    },
    /// The same radiance from every direction that meets no shape.
    ConstantSky {
        /// Radiance.
        radiance: Rgb,
    },
    /// A sky that is brighter above: `horizon + (zenith − horizon) · max(0, w · up)` from direction w.
    GradientSky {
        /// Unit.
        up: DVec3,
        /// Radiance at and below the horizon.
        horizon: Rgb,
        /// Radiance straight above.
        zenith: Rgb,
    },
    /// A shape whose material emits.
    Area {
        /// Number of the shape.
        shape: u32,
    },
}

impl Light {
    /// Whether no ray can meet the light by chance.
    pub(crate) const fn is_delta(&self) -> bool {
        matches!(self, Self::Point { .. } | Self::Directional { .. })
    }

    /// Radiance of the sky from direction `w` (unit, away from the scene); zero for other lights.
    pub(crate) fn sky_radiance(&self, w: DVec3) -> Rgb {
        match *self {
            Self::ConstantSky { radiance } => radiance,
            Self::GradientSky { up, horizon, zenith } => {
                let height = w.dot(up).max(0.0);
                std::array::from_fn(|c| horizon[c] + (zenith[c] - horizon[c]) * height)
            }
            _ => [0.0; 3],
        }
    }
}
