//! Smooth surfaces, right and wrong: where a mirror or a pane of glass sends light, how much of it, and what
//! comes out if one of the usual mistakes is made in working that out.

use crate::cause::{Cause, bsdf as cause, convention};
use crate::contract::{Conventions, GlassFresnel, GlassRadiance};
use crate::math::closed_form::fresnel;
use crate::scene::{Rgb, Surface};
use glam::DVec3;

/// One of the two ways light takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lobe {
    /// Local, unit, away from the surface.
    pub(crate) wi: DVec3,
    /// The share of the radiance along `wi` that leaves along `wo`: f · |cos θi|.
    pub(crate) carried: Rgb,
    /// The share of all light that goes this way, but for colours: what samples are usually chosen by.
    pub(crate) probability: f64,
}

/// What a smooth surface makes of one view; `None` where no light goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lobes {
    /// To the side of the viewer.
    pub(crate) reflected: Option<Lobe>,
    /// Through the interface.
    pub(crate) refracted: Option<Lobe>,
}

/// A smooth surface, and the conventions it is worked out by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interface {
    surface: Surface,
    conventions: Conventions,
}

/// How the lobes are worked out. A mistake changes one step.
#[derive(Clone, Copy)]
pub(crate) struct Working {
    /// Of the index beyond over the index before: the ratio that Snell's law is given.
    bends_by: fn(f64) -> f64,
    /// Of the cosine of `wo` and that ratio.
    reflectance: fn(f64, f64) -> f64,
    /// Of the same ratio: the factor of radiance that crosses.
    crossing: fn(f64) -> f64,
    /// Of `wo`: where a reflection goes.
    reflects_to: fn(DVec3) -> DVec3,
    /// What f · |cos θi| comes to.
    carried: fn(&Share) -> f64,
    /// Whether light below the critical angle comes back.
    reflects_totally: bool,
}

/// What the value of a lobe is made of, in one channel.
pub(crate) struct Share {
    /// Reflectance or transmittance of the material.
    colour: f64,
    /// The share that the lobe has of all light, and of the samples.
    probability: f64,
    /// The factor of radiance that crosses; 1 of what does not.
    crossing: f64,
    /// |cos θi|.
    cosine: f64,
}

impl Share {
    const fn carried(&self) -> f64 {
        self.colour * self.probability * self.crossing
    }
}

/// A change of one step.
pub(crate) type Mistake = fn(&mut Working);

/// The mistakes that can be told apart by what they predict.
pub(crate) static MISTAKES: &[(&Cause, Mistake)] = &[
    (&cause::ETA_SWAPPED, |w| {
        w.bends_by = f64::recip;
        w.reflectance = |cosine, ratio| fresnel::reflectance(cosine, ratio.recip());
        w.crossing = |ratio| ratio * ratio;
    }),
    (&cause::SNELL_INVERTED, |w| w.bends_by = f64::recip),
    (&cause::SCHLICK_UNDECLARED, |w| w.reflectance = fresnel::schlick),
    (&cause::SCHLICK_UNDECLARED, |w| w.reflectance = fresnel::schlick_of_view),
    (&cause::POLARISATIONS_NOT_AVERAGED, |w| {
        w.reflectance = |c, eta| fresnel::amplitudes(c, eta)[0].powi(2)
    }),
    (&cause::POLARISATIONS_NOT_AVERAGED, |w| {
        w.reflectance = |c, eta| fresnel::amplitudes(c, eta)[1].powi(2)
    }),
    (&cause::POLARISATIONS_NOT_AVERAGED, |w| {
        w.reflectance = |c, eta| (fresnel::amplitudes(c, eta).iter().sum::<f64>() / 2.0).powi(2)
    }),
    (&cause::TOTAL_REFLECTION_FORGOTTEN, |w| w.reflects_totally = false),
    (&convention::UNSCALED_RADIANCE, |w| w.crossing = |_| 1.0),
    (&cause::GLASS_RADIANCE_SCALED_BACKWARDS, |w| w.crossing = |ratio| ratio * ratio),
    (&cause::GLASS_RADIANCE_SCALED_UNDECLARED, |w| w.crossing = |ratio| (ratio * ratio).recip()),
    (&cause::DELTA_COSINE_FORGOTTEN, |w| w.carried = |share| share.carried() * share.cosine),
    (&cause::DELTA_WEIGHT_TIMES_PROBABILITY, |w| {
        w.carried = |share| share.carried() * share.probability
    }),
    (&cause::GLASS_WEIGHT_WITHOUT_FRESNEL, |w| w.carried = |share| share.colour * share.crossing),
    (&cause::DELTA_COLOUR_MISSING, |w| w.carried = |share| share.carried() / share.colour),
    (&cause::MIRROR_RETURNS_VIEW, |w| w.reflects_to = |wo| wo),
    (&cause::MIRROR_GOES_THROUGH, |w| w.reflects_to = |wo| -wo),
];

impl Lobes {
    /// Those that light takes.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Lobe> {
        self.reflected.into_iter().chain(self.refracted)
    }
}

impl Interface {
    /// A mirror or glass; anything else sends light nowhere.
    pub(crate) const fn new(surface: Surface, conventions: Conventions) -> Self {
        Self { surface, conventions }
    }

    /// As it should be.
    pub(crate) fn lobes(&self, wo: DVec3) -> Lobes {
        self.worked_out(wo, &self.working())
    }

    /// With a mistake.
    pub(crate) fn mistaken(&self, wo: DVec3, mistake: Mistake) -> Lobes {
        let mut working = self.working();
        mistake(&mut working);
        self.worked_out(wo, &working)
    }

    /// The right steps, by the core's own conventions.
    fn working(&self) -> Working {
        Working {
            bends_by: |ratio| ratio,
            reflectance: match self.conventions.glass_fresnel {
                GlassFresnel::Exact => fresnel::reflectance,
                GlassFresnel::Schlick => fresnel::schlick_of_view,
                GlassFresnel::SchlickOutside => fresnel::schlick,
            },
            crossing: match self.conventions.glass_radiance {
                GlassRadiance::Scaled => |ratio| (ratio * ratio).recip(),
                GlassRadiance::Unscaled => |_| 1.0,
            },
            reflects_to: |wo| DVec3::new(-wo.x, -wo.y, wo.z),
            carried: Share::carried,
            reflects_totally: true,
        }
    }

    fn worked_out(&self, wo: DVec3, working: &Working) -> Lobes {
        let cosine = wo.z.abs();
        let lobe = |wi: DVec3, colour: Rgb, probability: f64, crossing: f64| {
            let share = |colour| Share { colour, probability, crossing, cosine: wi.z.abs() };
            let carried = colour.map(|colour| (working.carried)(&share(colour)));
            (probability > 0.0).then_some(Lobe { wi, carried, probability })
        };
        match self.surface {
            Surface::Mirror { reflectance } => Lobes {
                reflected: lobe((working.reflects_to)(wo), reflectance, 1.0, 1.0),
                refracted: None,
            },
            Surface::Glass { index, reflectance, transmittance } => {
                let ratio = if wo.z > 0.0 { index } else { index.recip() };
                let beyond = refracted(wo, (working.bends_by)(ratio));
                let share = match (working.reflectance)(cosine, ratio) {
                    1.0 if !working.reflects_totally => 0.0,
                    share => share,
                };
                let crossing = (working.crossing)(ratio);
                Lobes {
                    reflected: lobe((working.reflects_to)(wo), reflectance, share, 1.0),
                    refracted: beyond.and_then(|wi| lobe(wi, transmittance, 1.0 - share, crossing)),
                }
            }
            Surface::Diffuse { .. } | Surface::Conductor { .. } | Surface::RoughGlass { .. } => {
                Lobes::default()
            }
        }
    }
}

/// Snell's law; `None` if no light passes. `ratio`: index beyond over index on the side of `wo`.
fn refracted(wo: DVec3, ratio: f64) -> Option<DVec3> {
    let (x, y) = (-wo.x / ratio, -wo.y / ratio);
    let sine_squared = x * x + y * y;
    (sine_squared < 1.0).then(|| DVec3::new(x, y, -(1.0 - sine_squared).sqrt().copysign(wo.z)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::surface::seen_from;
    use std::f64::consts::PI;

    fn glass() -> Interface {
        let white = [1.0; 3];
        let surface = Surface::Glass { index: 1.5, reflectance: white, transmittance: white };
        Interface::new(surface, Conventions::default())
    }

    /// Angle of the view, share reflected, angle of the refraction; computed apart from this program.
    const TABLE: [(f64, f64, Option<f64>); 7] = [
        (0.0, 0.04, Some(180.0)),
        (30.0, 0.041_522_6, Some(160.528_8)),
        (60.0, 0.089_186_7, Some(144.735_6)),
        (85.0, 0.612_799_6, Some(138.384_4)),
        (160.0, 0.041_728_5, Some(30.865_9)),
        (145.0, 0.086_138, Some(59.357_6)),
        (130.0, 1.0, None),
    ];

    #[test]
    fn glass_of_index_three_halves_is_that_of_the_table() {
        for (degrees, share, refracts_to) in TABLE {
            let lobes = glass().lobes(seen_from(degrees.to_radians()));
            let reflected = lobes.reflected.unwrap();
            assert!((reflected.carried[0] - share).abs() < 1e-7, "{degrees}: {reflected:?}");
            let angle = lobes.refracted.map(|lobe| lobe.wi.z.acos() * 180.0 / PI);
            match (angle, refracts_to) {
                (Some(angle), Some(expected)) => assert!((angle - expected).abs() < 1e-4),
                (angle, expected) => assert_eq!(angle, expected),
            }
        }
    }

    #[test]
    fn in_and_out_again_radiance_is_as_before() {
        let inward = glass().lobes(seen_from(0.6)).refracted.unwrap();
        let back = glass().lobes(inward.wi).refracted.unwrap();
        assert!(back.wi.distance(seen_from(0.6)) < 1e-12);
        let share = 1.0 - fresnel::reflectance(0.6f64.cos(), 1.5);
        assert!((inward.carried[0] * back.carried[0] - share * share).abs() < 1e-12);
    }

    #[test]
    fn every_mistake_changes_what_is_answered_somewhere() {
        for (cause, mistake) in MISTAKES {
            let conventions =
                |glass_radiance| Conventions { glass_radiance, ..Conventions::default() };
            let changes = [GlassRadiance::Scaled, GlassRadiance::Unscaled].map(|radiance| {
                let colours = ([0.9, 0.8, 0.7], [0.6, 0.5, 0.4]);
                let (reflectance, transmittance) = colours;
                let surface = Surface::Glass { index: 1.5, reflectance, transmittance };
                let interface = Interface::new(surface, conventions(radiance));
                TABLE.iter().any(|(degrees, ..)| {
                    let wo = seen_from(degrees.to_radians());
                    interface.lobes(wo) != interface.mistaken(wo, *mistake)
                })
            });
            assert!(changes.contains(&true), "{}", cause.name);
        }
    }
}
