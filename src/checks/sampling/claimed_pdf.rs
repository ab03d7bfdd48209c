//! Wrong pdfs and wrong maps, recognised by what they are to the right ones.

use super::distribution::Distribution;
use crate::cause::{Cause, sampling};
use crate::checks::bsdf::ggx_pair::{Pair, mistake_of_pdf};
use crate::checks::bsdf::rough_glass::RoughGlass;
use crate::checks::form::Form;
use crate::contract::{BsdfQuery, Conventions, Core, Result, Sampler};
use crate::math::closed_form::microfacet::Masking;
use crate::math::rng::Seed;
use crate::math::sphere::on_hemisphere;
use crate::scene::Surface;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Directions at which a pdf is looked at.
const DIRECTIONS: usize = 200;

/// What a distribution may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    Uniform,
    Cosine,
    /// A diffuse surface may draw as it likes, if only it says so.
    Either,
    /// Rough metal may draw by all its microfacets, or by those that are seen.
    Metal,
    /// As may rough glass, and choose between its ways as it likes.
    RoughGlass,
}

impl Wanted {
    fn of(distribution: &Distribution) -> Option<Self> {
        match distribution {
            Distribution::Sampler(Sampler::UniformHemisphere) => Some(Self::Uniform),
            Distribution::Sampler(Sampler::CosineHemisphere) => Some(Self::Cosine),
            Distribution::Bsdf { material, .. } => match material.surface {
                Surface::Diffuse { .. } => Some(Self::Either),
                Surface::Conductor { .. } => Some(Self::Metal),
                Surface::RoughGlass { .. } => Some(Self::RoughGlass),
                Surface::Mirror { .. } | Surface::Glass { .. } => None,
            },
        }
    }
}

/// The form of the core's pdf over the upper hemisphere, and whether it is 0 below.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClaimedPdf {
    wanted: Wanted,
    form: Option<Form>,
    is_dark_below: bool,
    /// What is wrong with the pdf of microfacets, which has no such form.
    of_microfacets: Option<&'static Cause>,
}

impl ClaimedPdf {
    /// Asks the core. None for distributions whose pdf is no simple one.
    pub(crate) fn of(core: &mut dyn Core, distribution: &Distribution) -> Result<Option<Self>> {
        let Some(wanted) = Wanted::of(distribution) else { return Ok(None) };
        let mut stream = Seed::SUITE.child("form of a density").stream();
        let above: Vec<_> = (0..DIRECTIONS).map(|_| on_hemisphere(&mut stream)).collect();
        let below: Vec<_> = above.iter().map(|direction| -*direction).collect();
        let (mut pdf, mut pdf_below) = (vec![0.0; above.len()], vec![0.0; below.len()]);
        distribution.pdf(core, &above, &mut pdf)?;
        distribution.pdf(core, &below, &mut pdf_below)?;
        let values: Vec<_> = pdf.iter().zip(&above).map(|(pdf, wi)| (*pdf, wi.z)).collect();
        let is_dark_below = pdf_below.iter().all(|pdf| *pdf == 0.0);
        let of_microfacets = match wanted {
            Wanted::Metal => mistake_of_metal(distribution, &above, &pdf),
            Wanted::RoughGlass => {
                let all = above.iter().zip(&pdf).chain(below.iter().zip(&pdf_below));
                mistake_of_rough_glass(distribution, all)
            }
            _ => None,
        };
        let is_of_microfacets = matches!(wanted, Wanted::Metal | Wanted::RoughGlass);
        let form = if is_of_microfacets { None } else { Form::of(&values) };
        Ok(Some(Self { wanted, form, is_dark_below, of_microfacets }))
    }

    /// The mistake that makes such a pdf, whatever is drawn.
    pub(crate) fn mistake(self) -> Option<&'static Cause> {
        let Some(form) = self.form else { return self.of_microfacets };
        let right = match (self.wanted, form.power) {
            (Wanted::Uniform, _) | (Wanted::Either, 0) => Form::UNIFORM,
            _ => Form::COSINE,
        };
        if form.is_like(right) {
            return (!self.is_dark_below).then_some(&sampling::PDF_BELOW_HORIZON);
        }
        let made = [
            (right.times(PI), &sampling::PDF_WITHOUT_PI),
            (right.times(0.5), &sampling::PDF_HALVED),
            (right.times(2.0), &sampling::PDF_DOUBLED),
            (right.times(TAU * TAU), &sampling::PDF_INVERTED),
            (right.times(PI * PI), &sampling::PDF_INVERTED),
            (Form::UNIFORM, &sampling::UNIFORM_PDF_FOR_COSINE),
            (Form::COSINE, &sampling::COSINE_PDF_FOR_UNIFORM),
        ];
        made.into_iter().find(|(made, _)| form.is_like(*made)).map(|(_, cause)| cause)
    }

    /// The mistake that draws directions by this law of heights, where the pdf is right in itself.
    pub(crate) fn mistake_of_map(self, law: Law) -> Option<&'static Cause> {
        let is_uniform = self.form?.is_like(Form::UNIFORM);
        match (law, self.wanted) {
            (Law::PartOfAzimuths, _) => Some(&sampling::HALF_OF_AZIMUTHS),
            (Law::ThetaUniform, _) => Some(&sampling::THETA_UNIFORM),
            (Law::Line, _) => Some(&sampling::ONE_NUMBER_TWICE),
            (Law::Uniform, Wanted::Cosine) => Some(&sampling::UNIFORM_FOR_COSINE),
            (Law::Cosine, Wanted::Uniform) => Some(&sampling::COSINE_FOR_UNIFORM),
            (Law::Uniform, Wanted::Either) if !is_uniform => {
                Some(&sampling::COSINE_PDF_FOR_UNIFORM)
            }
            (Law::Cosine, Wanted::Either) if is_uniform => Some(&sampling::UNIFORM_PDF_FOR_COSINE),
            _ => None,
        }
    }

    /// The law that gives this product of pdf and Jacobian, over the sine: it draws the angle uniformly.
    pub(crate) fn law_of_angle(self, product: Form) -> Option<Law> {
        let pdf = self.form?;
        let predicted = Form { constant: AREA_BY_ANGLE * pdf.constant, power: pdf.power };
        product.is_like(predicted).then_some(Law::ThetaUniform)
    }

    /// The law of heights that gives this product of pdf and Jacobian.
    pub(crate) fn law_of_product(self, product: Form, leaves_azimuths_out: bool) -> Option<Law> {
        let pdf = self.form?;
        let jacobian =
            Form { constant: product.constant / pdf.constant, power: product.power - pdf.power };
        let is = |right: Form| {
            jacobian.is_times(1.0, Form { constant: right.constant.recip(), power: -right.power })
        };
        if is(Form::UNIFORM) {
            Some(Law::Uniform)
        } else if is(Form::COSINE) {
            Some(Law::Cosine)
        } else if leaves_azimuths_out && product.constant < 0.75 && product.power == 0 {
            Some(Law::PartOfAzimuths)
        } else {
            None
        }
    }
}

fn mistake_of_metal(
    distribution: &Distribution,
    directions: &[DVec3],
    pdf: &[f64],
) -> Option<&'static Cause> {
    let Distribution::Bsdf { material, wo, .. } = distribution else { return None };
    let Surface::Conductor { reflectance, roughness } = material.surface else { return None };
    let (wo, masking) = (*wo, Masking::Separable);
    let pairs = directions.iter().map(|wi| Pair { wo, wi: *wi, reflectance, roughness, masking });
    mistake_of_pdf(&pairs.zip(pdf.iter().copied()).collect::<Vec<_>>())
}

fn mistake_of_rough_glass<'a>(
    distribution: &Distribution,
    pdfs: impl Iterator<Item = (&'a DVec3, &'a f64)>,
) -> Option<&'static Cause> {
    let Distribution::Bsdf { material, wo, .. } = distribution else { return None };
    let Surface::RoughGlass { index, roughness, .. } = material.surface else { return None };
    let glass = RoughGlass { index, roughness, conventions: Conventions::default() };
    let pairs = pdfs.map(|(wi, pdf)| (BsdfQuery { wo: *wo, wi: *wi }, *pdf));
    glass.mistake_of_pdf(&pairs.collect::<Vec<_>>())
}

/// The area of the map that draws θ uniformly: π² sin θ.
const AREA_BY_ANGLE: f64 = PI * PI;

/// How the directions of a sampler are distributed, whatever its pdf says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Law {
    /// Over the hemisphere.
    Uniform,
    /// As cos θ.
    Cosine,
    /// Uniform in the angle θ.
    ThetaUniform,
    /// Nowhere in a part of the azimuths.
    PartOfAzimuths,
    /// Along a line.
    Line,
}
