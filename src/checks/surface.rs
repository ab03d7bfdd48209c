//! Surfaces as cases write them, with the words of scene files: `{ diffuse = 0.8 }`, `{ mirror = 0.83 }`,
//! `{ glass = { index = 1.5 } }`, `{ conductor = { reflectance = 1, roughness = 0.3 } }`,
//! `{ rough-glass = { index = 1.5, roughness = 0.3 } }`.

use crate::contract::{BsdfQuery, BsdfSample, BsdfValue, Capabilities, Core, Randomness, Result};
use crate::math::rng::Stream;
use crate::math::sphere::{on_hemisphere, on_sphere};
use crate::scene::{Material, Surface};
use crate::text::{Bending, Positive, Reflectance, Roughness};
use glam::DVec3;
use serde::Deserialize;
use std::fmt;

/// A surface without emission.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) enum SurfaceEntry {
    Diffuse(Reflectance),
    Mirror(Reflectance),
    /// A smooth interface.
    Glass(GlassEntry),
    /// GGX microfacets.
    Conductor(ConductorEntry),
    /// GGX microfacets that light passes.
    RoughGlass(RoughGlassEntry),
}

/// `{ index = 1.5, reflectance = 0.8, transmittance = 0.9 }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GlassEntry {
    /// Inside; outside is vacuum.
    pub(crate) index: Positive,
    /// Multiplies what is reflected, as `transmittance` what is transmitted.
    #[serde(default = "white")]
    pub(crate) reflectance: Reflectance,
    #[serde(default = "white")]
    pub(crate) transmittance: Reflectance,
}

/// `{ reflectance = 1, roughness = 0.3 }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConductorEntry {
    /// Of a single microfacet.
    pub(crate) reflectance: Reflectance,
    /// The width parameter α.
    pub(crate) roughness: Roughness,
}

/// `{ index = 1.5, roughness = 0.3, reflectance = 0.8, transmittance = 0.9 }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RoughGlassEntry {
    /// Inside; outside is vacuum.
    pub(crate) index: Bending,
    /// The width parameter α.
    pub(crate) roughness: Roughness,
    /// Multiplies what is reflected, as `transmittance` what is transmitted.
    #[serde(default = "white")]
    pub(crate) reflectance: Reflectance,
    #[serde(default = "white")]
    pub(crate) transmittance: Reflectance,
}

const fn white() -> Reflectance {
    Reflectance([1.0; 3])
}

impl SurfaceEntry {
    pub(crate) fn material(self) -> Material {
        let surface = match self {
            Self::Diffuse(Reflectance(reflectance)) => Surface::Diffuse { reflectance },
            Self::Mirror(Reflectance(reflectance)) => Surface::Mirror { reflectance },
            Self::Glass(glass) => Surface::Glass {
                index: glass.index.0,
                reflectance: glass.reflectance.0,
                transmittance: glass.transmittance.0,
            },
            Self::Conductor(metal) => Surface::Conductor {
                reflectance: metal.reflectance.0,
                roughness: metal.roughness.0,
            },
            Self::RoughGlass(glass) => Surface::RoughGlass {
                index: glass.index.0,
                roughness: glass.roughness.0,
                reflectance: glass.reflectance.0,
                transmittance: glass.transmittance.0,
            },
        };
        Material { name: self.to_string(), surface, emission: None }
    }

    /// What a core has to know of besides.
    pub(crate) const fn needs(self) -> Capabilities {
        match self {
            Self::RoughGlass(_) => Capabilities::ROUGH_GLASS,
            _ => Capabilities::empty(),
        }
    }

    pub(crate) fn all_need(surfaces: &[Self]) -> Capabilities {
        surfaces.iter().map(|surface| surface.needs()).collect()
    }

    /// An error about the first that a core evaluates as zero everywhere, which says why.
    pub(crate) fn refuse_delta(surfaces: &[Self], why: &str) -> std::result::Result<(), String> {
        match surfaces.iter().find(|surface| surface.is_delta()) {
            Some(delta) => Err(format!("{delta} {why}")),
            None => Ok(()),
        }
    }

    /// Whether light passes, so that samples may lie on either side, and viewers too.
    pub(crate) fn lets_pass(self) -> bool {
        lets_pass(&self.material().surface)
    }

    /// A random direction from which light may come to it, or where a viewer may be.
    pub(crate) fn direction(self, stream: &mut Stream) -> DVec3 {
        if self.lets_pass() { on_sphere(stream) } else { on_hemisphere(stream) }
    }

    pub(crate) const fn is_delta(self) -> bool {
        matches!(self, Self::Mirror(_) | Self::Glass(_))
    }
}

impl fmt::Display for SurfaceEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diffuse(_) => f.write_str("a diffuse surface"),
            Self::Mirror(_) => f.write_str("a mirror"),
            Self::Glass(glass) => write!(f, "glass of index {}", glass.index.0),
            Self::Conductor(metal) => write!(f, "a conductor of roughness {}", metal.roughness.0),
            Self::RoughGlass(RoughGlassEntry { index, roughness, .. }) => {
                write!(f, "glass of index {} and roughness {}", index.0, roughness.0)
            }
        }
    }
}

/// What a core says of a material at pairs of directions.
pub(crate) fn evaluated(
    core: &mut dyn Core,
    material: &Material,
    queries: &[BsdfQuery],
) -> Result<Vec<BsdfValue>> {
    let mut values = vec![BsdfValue { f: [0.0; 3], pdf: 0.0 }; queries.len()];
    core.eval_bsdf(material, queries, &mut values)?;
    Ok(values)
}

/// One sample for each view.
pub(crate) fn sampled(
    core: &mut dyn Core,
    material: &Material,
    wo: &[DVec3],
    random: Randomness<'_>,
) -> Result<Vec<BsdfSample>> {
    let mut samples = vec![BsdfSample::NONE; wo.len()];
    core.sample_bsdf(material, wo, random, &mut samples)?;
    Ok(samples)
}

/// Whether light that is scattered to one side may come from the other.
pub(crate) const fn lets_pass(surface: &Surface) -> bool {
    matches!(surface, Surface::RoughGlass { .. })
}

/// The height at which f and its pdf may jump, seen from this angle: rough glass refracts by microfacets that face
/// the side of the normal, and where the half vector has just turned over there are none.
pub(crate) fn kink(surface: &Surface, angle: f64) -> Option<f64> {
    match surface {
        Surface::RoughGlass { index, .. } if angle.cos() > 0.0 => Some(-angle.cos() / index),
        Surface::RoughGlass { index, .. } => Some(-angle.cos() * index),
        _ => None,
    }
}

/// The direction at this angle from the normal, turned to an azimuth that is no multiple of anything.
pub(crate) fn seen_from(angle: f64) -> DVec3 {
    const AZIMUTH: f64 = 0.7;
    crate::math::frame::direction(angle, AZIMUTH)
}
