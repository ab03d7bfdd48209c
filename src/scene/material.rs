//! Materials: BSDF and emission of surfaces.

use super::Rgb;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The material of a shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Material {
    /// As the scene file calls it.
    pub name: String,
    /// How it scatters.
    pub surface: Surface,
    /// How it emits, if it does.
    pub emission: Option<Emission>,
}

/// How a surface scatters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Surface {
    /// f = reflectance/π. Black is a reflectance of zero.
    Diffuse {
        /// Share of light that is scattered, in [0, 1].
        reflectance: Rgb,
    },
    /// Reflects about the normal.
    Mirror {
        /// Share of light that is reflected, the same at every angle.
        reflectance: Rgb,
    },
    /// A smooth interface: outside (the side of the normal) is vacuum, inside has `index`.
    Glass {
        /// Index of refraction inside.
        index: f64,
        /// Multiplies the Fresnel reflectance.
        reflectance: Rgb,
        /// Multiplies the Fresnel transmittance.
        transmittance: Rgb,
    },
    /// Single scattering from GGX microfacets that reflect `reflectance` at every angle.
    Conductor {
        /// Reflectance of a single microfacet.
        reflectance: Rgb,
        /// The width parameter α of the distribution, in (0, 1].
        roughness: f64,
    },
    /// GGX microfacets that are smooth interfaces each (Walter et al. 2007), by Fresnel's exact equations: outside
    /// is vacuum, inside has `index`. Single scattering: what meets two microfacets is lost.
    RoughGlass {
        /// Index of refraction inside; not 1.
        index: f64,
        /// The width parameter α of the distribution, in (0, 1].
        roughness: f64,
        /// Multiplies the Fresnel reflectance.
        reflectance: Rgb,
        /// Multiplies the Fresnel transmittance.
        transmittance: Rgb,
    },
}

impl Surface {
    /// Whether light leaves in directions of a delta distribution: a mirror, or smooth glass.
    pub(crate) const fn is_specular(&self) -> bool {
        matches!(self, Self::Mirror { .. } | Self::Glass { .. })
    }
}

/// How a surface emits, from its front side only (the side of the geometric normal).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Emission {
    /// In every direction of the front side.
    pub radiance: Rgb,
    /// On a sphere: only this part of it emits.
    pub cap: Option<Cap>,
}

/// The part of a sphere within `half_angle` of `axis`, seen from its centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Cap {
    /// Unit.
    pub axis: DVec3,
    /// Radians, in (0, π).
    pub half_angle: f64,
}

impl Emission {
    /// Radiance at a point of a sphere in direction `from_centre` (unit) from its centre.
    pub(crate) fn at_sphere_point(&self, from_centre: DVec3) -> Rgb {
        match self.cap {
            Some(cap) if from_centre.dot(cap.axis) < cap.half_angle.cos() => [0.0; 3],
            _ => self.radiance,
        }
    }
}
