//! `[material.<name>]`

use super::{Context, exactly_one};
use crate::scene::{Cap, Emission, Material, Surface};
use crate::text::{
    Angle, Bending, Colour, Diagnostic, Direction, Positive, Reflectance, Roughness, Spanned,
    did_you_mean, listed,
};
use serde::Deserialize;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;

tables! {
    pub(super) struct Entry {
        /// f = reflectance/π.
        diffuse: Option<Reflectance>,
        /// Reflects about the normal: the share that is reflected, the same at every angle.
        mirror: Option<Reflectance>,
        /// A smooth interface: outside, on the side of the normal, is vacuum.
        glass: Option<Glass>,
        /// Single scattering from GGX microfacets.
        conductor: Option<Conductor>,
        /// GGX microfacets that are smooth interfaces each.
        rough_glass: Option<RoughGlass>,
        /// Radiance that the surface emits, on the side of its normal.
        emission: Option<Colour>,
        /// The part of a sphere that emits; all of it unless said otherwise.
        cap: Option<Spanned<CapEntry>>,
    }

    struct Glass {
        /// Index of refraction inside.
        index: Positive,
        /// Multiplies the Fresnel reflectance; 1 unless said otherwise.
        reflectance: Option<Reflectance>,
        /// Multiplies the Fresnel transmittance; 1 unless said otherwise.
        transmittance: Option<Reflectance>,
    }

    struct Conductor {
        /// Of a single microfacet, the same at every angle.
        reflectance: Reflectance,
        /// The width parameter α of the distribution.
        roughness: Roughness,
    }

    struct RoughGlass {
        /// Index of refraction inside.
        index: Bending,
        /// The width parameter α of the distribution.
        roughness: Roughness,
        /// Multiplies the Fresnel reflectance; 1 unless said otherwise.
        reflectance: Option<Reflectance>,
        /// Multiplies the Fresnel transmittance; 1 unless said otherwise.
        transmittance: Option<Reflectance>,
    }

    struct CapEntry {
        /// From the centre of the sphere to the middle of the cap.
        axis: Direction,
        /// From the axis to the edge of the cap.
        half_angle: Angle,
    }
}

/// The materials of a file, numbered by the alphabet, and which of them were asked for.
pub(super) struct Materials(Vec<Named>);

struct Named {
    material: Material,
    span: Range<usize>,
    is_used: Cell<bool>,
}

pub(super) fn resolve_all(
    entries: BTreeMap<String, Spanned<Entry>>,
    context: &Context<'_>,
) -> Result<Materials, Diagnostic> {
    let resolve = |(name, entry): (String, Spanned<Entry>)| {
        let span = entry.span();
        let surface = entry.get_ref().surface();
        let surface = surface.map_err(|problem| context.wrong(span.clone(), problem))?;
        let emission = entry.into_inner().emission(context)?;
        let material = Material { name, surface, emission };
        Ok(Named { material, span, is_used: Cell::new(false) })
    };
    entries.into_iter().map(resolve).collect::<Result<_, _>>().map(Materials)
}

impl Materials {
    /// Number and content of the material that a shape names.
    pub(crate) fn find(
        &self,
        name: &Spanned<String>,
        context: &Context<'_>,
    ) -> Result<(u32, &Material), Diagnostic> {
        let wanted = name.get_ref();
        let number = self.0.iter().position(|named| named.material.name == *wanted);
        let number = number.ok_or_else(|| {
            let names = || self.0.iter().map(|named| named.material.name.as_str());
            let problem = format!("there is no material `{wanted}`, only {}", listed(names()));
            context.wrong(name.span(), problem).with_hint_if_any(did_you_mean(wanted, names()))
        })?;
        self.0[number].is_used.set(true);
        Ok((number as u32, &self.0[number].material))
    }

    /// The materials themselves. One that no shape asked for is a mistake.
    pub(crate) fn into_scene(self, context: &Context<'_>) -> Result<Vec<Material>, Diagnostic> {
        let keep = |named: Named| match named.is_used.get() {
            true => Ok(named.material),
            false => {
                let problem = format!("material `{}` is unused", named.material.name);
                Err(context.wrong(named.span, problem))
            }
        };
        self.0.into_iter().map(keep).collect()
    }
}

impl Entry {
    fn surface(&self) -> Result<Surface, String> {
        let whole = |share: Option<Reflectance>| share.map_or([1.0; 3], |share| share.0);
        let glass = |glass: &Glass| Surface::Glass {
            index: glass.index.0,
            reflectance: whole(glass.reflectance),
            transmittance: whole(glass.transmittance),
        };
        let conductor = |conductor: &Conductor| Surface::Conductor {
            reflectance: conductor.reflectance.0,
            roughness: conductor.roughness.0,
        };
        let rough_glass = |glass: &RoughGlass| Surface::RoughGlass {
            index: glass.index.0,
            roughness: glass.roughness.0,
            reflectance: whole(glass.reflectance),
            transmittance: whole(glass.transmittance),
        };
        let kinds = [
            ("diffuse", self.diffuse.map(|share| Surface::Diffuse { reflectance: share.0 })),
            ("mirror", self.mirror.map(|share| Surface::Mirror { reflectance: share.0 })),
            ("glass", self.glass.as_ref().map(glass)),
            ("conductor", self.conductor.as_ref().map(conductor)),
            ("rough-glass", self.rough_glass.as_ref().map(rough_glass)),
        ];
        exactly_one("a material", kinds)
    }

    /// How it emits. An emission of zero is none: parameters can put a light out.
    fn emission(self, context: &Context<'_>) -> Result<Option<Emission>, Diagnostic> {
        let radiance = self.emission.map(|power| power.0);
        if let (None, Some(cap)) = (radiance, &self.cap) {
            return Err(context.wrong(cap.span(), "a `cap` without emission: add `emission`"));
        }
        let cap = self.cap.map(|cap| resolve_cap(&cap, context)).transpose()?;
        let lit = radiance.filter(|radiance| *radiance != [0.0; 3]);
        Ok(lit.map(|radiance| Emission { radiance, cap }))
    }
}

fn resolve_cap(cap: &Spanned<CapEntry>, context: &Context<'_>) -> Result<Cap, Diagnostic> {
    let CapEntry { axis, half_angle: Angle(half_angle) } = cap.get_ref();
    if *half_angle > 0.0 && *half_angle < PI {
        Ok(Cap { axis: axis.0, half_angle: *half_angle })
    } else {
        Err(context.wrong(cap.span(), "invalid half angle of a cap: must be between 0 and 180 deg"))
    }
}
