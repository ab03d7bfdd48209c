//! How surfaces scatter, in the local frame whose +z is the shading normal on the front side.
//!
//! Diffuse, mirror and conductor are the same seen from behind. Weights of samples, `f · |cos| / pdf`, are worked
//! out with their cosines cancelled, so that a white furnace loses nothing to rounding.

use super::conductor::Conductor;
use super::glass::Glass;
use super::rough_glass::RoughGlass;
use super::scattering::Scattering;
use super::warp;
use crate::scene::{Rgb, Surface};
use glam::{Vec2, Vec3, vec3};
use std::f32::consts::FRAC_1_PI;

/// A surface's scattering with its constants in single precision.
#[derive(Clone, Debug)]
pub(crate) enum Bsdf {
    /// f = reflectance/π.
    Diffuse {
        reflectance: Vec3,
    },
    Mirror {
        reflectance: Vec3,
    },
    Glass(Glass),
    Conductor(Conductor),
    RoughGlass(RoughGlass),
}

/// Linear RGB in single precision.
pub(crate) fn rgb(colour: Rgb) -> Vec3 {
    Vec3::from_array(colour.map(|channel| channel as f32))
}

impl Bsdf {
    pub(crate) fn new(surface: &Surface) -> Self {
        match *surface {
            Surface::Diffuse { reflectance } => Self::Diffuse { reflectance: rgb(reflectance) },
            Surface::Mirror { reflectance } => Self::Mirror { reflectance: rgb(reflectance) },
            Surface::Glass { index, reflectance, transmittance } => {
                Self::Glass(Glass::new(index, rgb(reflectance), rgb(transmittance)))
            }
            Surface::Conductor { reflectance, roughness } => {
                Self::Conductor(Conductor::new(rgb(reflectance), roughness as f32))
            }
            Surface::RoughGlass { index, roughness, reflectance, transmittance } => {
                let colours = [reflectance, transmittance].map(rgb);
                Self::RoughGlass(RoughGlass::new(index, roughness, colours[0], colours[1]))
            }
        }
    }

    /// Whether all light goes into single directions, which no light sample can meet.
    pub(crate) const fn is_delta(&self) -> bool {
        matches!(self, Self::Mirror { .. } | Self::Glass(_))
    }

    /// Whether directions sampled here are worth combining with light samples.
    pub(crate) const fn is_glossy(&self) -> bool {
        matches!(self, Self::Conductor(_) | Self::RoughGlass(_))
    }

    /// Whether it has an inside, to which light passes: the others are the same from both sides.
    pub(crate) const fn is_interface(&self) -> bool {
        matches!(self, Self::Glass(_) | Self::RoughGlass(_))
    }

    /// `f` (RGB, without the cosine) and the pdf of [`Self::sample`]. Delta lobes answer zero.
    pub(crate) fn evaluate(&self, wo: Vec3, wi: Vec3) -> (Vec3, f32) {
        let is_same_side = (wo.z > 0.0 && wi.z > 0.0) || (wo.z < 0.0 && wi.z < 0.0);
        match self {
            Self::Diffuse { reflectance } if is_same_side => {
                (*reflectance * FRAC_1_PI, warp::cosine_pdf(wi.z.abs()))
            }
            Self::Conductor(conductor) if is_same_side => {
                conductor.evaluate(upward(wo, wo), upward(wi, wo))
            }
            Self::RoughGlass(glass) => glass.evaluate(wo, wi),
            _ => (Vec3::ZERO, 0.0),
        }
    }

    /// A direction for `wo`, by two random numbers, and by a third that chooses between lobes; `None` if the
    /// sample is to count as zero.
    pub(crate) fn sample(&self, wo: Vec3, point: Vec2, lobe: f32) -> Option<Scattering> {
        if wo.z == 0.0 {
            return None;
        }
        let scattering = match self {
            Self::Diffuse { reflectance } => {
                let wi = warp::cosine_hemisphere(point);
                Scattering { wi, weight: *reflectance, pdf: warp::cosine_pdf(wi.z) }
            }
            Self::Mirror { reflectance } => {
                let wi = vec3(-wo.x, -wo.y, wo.z.abs());
                Scattering { wi, weight: *reflectance, pdf: 1.0 }
            }
            Self::Conductor(conductor) => conductor.sample(upward(wo, wo), point)?,
            Self::Glass(glass) => return glass.sample(wo, lobe),
            Self::RoughGlass(glass) => return glass.sample(wo, point, lobe),
        };
        Some(Scattering { wi: upward(scattering.wi, wo), ..scattering })
    }
}

/// `w` turned over if `wo` is behind the surface: there, and back again.
fn upward(w: Vec3, wo: Vec3) -> Vec3 {
    if wo.z < 0.0 { vec3(w.x, w.y, -w.z) } else { w }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GREY: Rgb = [0.37, 0.53, 0.71];

    fn direction(degrees: f32) -> Vec3 {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        vec3(sine * 0.6, sine * 0.8, cosine)
    }

    #[test]
    fn a_diffuse_surface_reflects_its_reflectance_from_both_sides() {
        let bsdf = Bsdf::new(&Surface::Diffuse { reflectance: GREY });
        for wo in [direction(30.0), -direction(30.0)] {
            let sample = bsdf.sample(wo, Vec2::new(0.3, 0.8), 0.0).expect("a direction");
            assert_eq!(sample.weight, rgb(GREY));
            assert!(sample.wi.z * wo.z > 0.0, "on the side of {wo}");
            let (f, pdf) = bsdf.evaluate(wo, sample.wi);
            assert!(((f * sample.wi.z.abs() / pdf) - rgb(GREY)).length() < 1e-6);
            assert_eq!(pdf, sample.pdf);
        }
    }

    #[test]
    fn a_reflecting_surface_transmits_nothing() {
        for surface in [
            Surface::Diffuse { reflectance: GREY },
            Surface::Conductor { reflectance: GREY, roughness: 0.3 },
        ] {
            let value = Bsdf::new(&surface).evaluate(direction(20.0), -direction(50.0));
            assert_eq!(value, (Vec3::ZERO, 0.0), "{surface:?}");
        }
    }
}
