//! The albedo of a surface by its formula, independent of any core.

use crate::checks::surface::SurfaceEntry;
use crate::contract::{Conventions, GlassRadiance, SmithTerm};
use crate::math::closed_form::microfacet::{self, Masking};
use crate::math::closed_form::rough_dielectric::Shares;
use crate::scene::Surface;

/// ∫ f cos of the green channel, seen from one direction.
///
/// Single scattering from GGX loses light, more of it with the separable Smith term.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Albedo {
    /// Of a surface that light does not pass.
    OfOneSide(f64),
    /// Of one that it does.
    OfBothSides {
        /// To the side of the viewer.
        reflected: f64,
        /// From the other side, with the scaling of radiance that is declared.
        refracted: f64,
    },
}

impl Albedo {
    /// By the conventions that the core declares. Mirrors and smooth glass have none.
    pub(crate) fn expected(surface: SurfaceEntry, angle: f64, conventions: Conventions) -> Self {
        let masking = masking(conventions.smith_term);
        match surface.material().surface {
            Surface::Diffuse { reflectance } => Self::OfOneSide(reflectance[1]),
            Surface::Conductor { reflectance, roughness } => {
                let share = microfacet::albedo(angle.cos(), roughness, masking);
                Self::OfOneSide(reflectance[1] * share)
            }
            Surface::RoughGlass { index, roughness, reflectance, transmittance } => {
                let ratio = if angle.cos() > 0.0 { index } else { index.recip() };
                let shares = Shares::of(angle.cos().abs(), ratio, roughness, masking);
                let scale = match conventions.glass_radiance {
                    GlassRadiance::Scaled => (ratio * ratio).recip(),
                    GlassRadiance::Unscaled => 1.0,
                };
                Self::OfBothSides {
                    reflected: reflectance[1] * shares.reflected,
                    refracted: transmittance[1] * shares.refracted * scale,
                }
            }
            Surface::Mirror { .. } | Surface::Glass { .. } => Self::OfOneSide(0.0),
        }
    }

    pub(crate) fn sum(self) -> f64 {
        match self {
            Self::OfOneSide(albedo) => albedo,
            Self::OfBothSides { reflected, refracted } => reflected + refracted,
        }
    }
}

/// The masking that a core declares, as closed forms name it.
pub(crate) const fn masking(smith: SmithTerm) -> Masking {
    match smith {
        SmithTerm::Separable => Masking::Separable,
        SmithTerm::HeightCorrelated => Masking::HeightCorrelated,
    }
}
