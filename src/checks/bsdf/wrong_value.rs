//! The mistake that makes the values of a BSDF, from many pairs of directions.

use super::albedo::masking;
use super::ggx_pair::{self, Pair};
use super::rough_glass::RoughGlass;
use super::terms::{Scattering, Value};
use crate::cause::{Cause, bsdf};
use crate::checks::form::Form;
use crate::checks::surface::{SurfaceEntry, evaluated};
use crate::checks::{Context, Result};
use crate::contract::{BsdfQuery, BsdfValue};
use crate::scene::{Rgb, Surface};
use crate::stats::Tolerance;
use std::f64::consts::{FRAC_1_PI, PI};

/// Pairs of directions at which f is looked at.
pub(super) const DIRECTIONS: usize = 200;

/// How far from the mean albedo a channel may be to be it, relative.
const AVERAGED: f64 = 1e-4;

/// What makes f at many pairs of directions.
#[derive(Default)]
pub(super) struct Made {
    /// The mistake that predicts all of them.
    pub(super) cause: Option<&'static Cause>,
    /// Of the wrong ones.
    pub(super) law: Option<String>,
}

/// What makes f of this surface.
pub(super) fn made(context: &mut Context<'_>, surface: SurfaceEntry) -> Result<Made> {
    let mut stream = context.seed.child("form of a value").stream();
    let mut direction = || surface.direction(&mut stream);
    let queries: Vec<_> =
        (0..DIRECTIONS).map(|_| BsdfQuery { wo: direction(), wi: direction() }).collect();
    let values = evaluated(context.core, &surface.material(), &queries)?;
    let law = law(context, surface, &queries, &values);
    let cause = match surface.material().surface {
        Surface::Diffuse { reflectance } if is_averaged(reflectance, &values) => {
            Some(&bsdf::ALBEDO_AVERAGED)
        }
        Surface::Diffuse { reflectance } => {
            let share = |(query, value): (&BsdfQuery, &BsdfValue)| {
                (value.f[1] * PI / reflectance[1], query.wi.z)
            };
            let shares: Vec<_> = queries.iter().zip(&values).map(share).collect();
            Form::of(&shares).and_then(mistake)
        }
        Surface::Conductor { reflectance, roughness } => {
            let masking = masking(context.info.conventions.smith_term);
            let pair = |(BsdfQuery { wo, wi }, value): (BsdfQuery, &BsdfValue)| {
                (Pair { wo, wi, reflectance, roughness, masking }, value.f[1])
            };
            let pairs: Vec<_> = queries.into_iter().zip(&values).map(pair).collect();
            ggx_pair::mistake_of_value(&pairs)
        }
        Surface::RoughGlass { index, roughness, reflectance, transmittance } => {
            let conventions = context.info.conventions;
            let white = |(query, value): (BsdfQuery, &BsdfValue)| {
                let passes = query.wo.z * query.wi.z < 0.0;
                let colour = if passes { transmittance } else { reflectance };
                (query, value.f[1] / colour[1])
            };
            let pairs: Vec<_> = queries.into_iter().zip(&values).map(white).collect();
            RoughGlass { index, roughness, conventions }.mistake_of_value(&pairs)
        }
        Surface::Mirror { .. } | Surface::Glass { .. } => None,
    };
    Ok(Made { cause, law })
}

fn law(
    context: &Context<'_>,
    surface: SurfaceEntry,
    queries: &[BsdfQuery],
    values: &[BsdfValue],
) -> Option<String> {
    let conventions = context.info.conventions;
    let scattering = Scattering { surface: surface.material().surface, conventions };
    let value = |(query, value): (&BsdfQuery, &BsdfValue)| {
        Some(Value { query: *query, found: value.f, right: scattering.value(query)? })
    };
    let values: Vec<_> = queries.iter().zip(values).filter_map(value).collect();
    let law = scattering.law_of_values(&values, Tolerance::FORMULA.of(context.info.precision))?;
    Some(format!("f of {} {law}", scattering.kind()))
}

/// Whether a coloured surface answers the mean of its albedos in every channel.
fn is_averaged(reflectance: Rgb, values: &[BsdfValue]) -> bool {
    let mean = reflectance.iter().sum::<f64>() / 3.0;
    let is_mean = |f: &f64| (f * PI / mean - 1.0).abs() <= AVERAGED;
    let is_coloured = reflectance.iter().any(|albedo| (albedo / mean - 1.0).abs() > 0.01);
    is_coloured && values.iter().flat_map(|value| &value.f).all(is_mean)
}

/// The mistake that makes f this share of albedo/π.
pub(super) fn mistake(share: Form) -> Option<&'static Cause> {
    let made: [(Form, &Cause); 7] = [
        (Form::constant(PI), &bsdf::WITHOUT_PI),
        (Form::constant(0.5), &bsdf::ALBEDO_HALVED),
        (Form::constant(2.0), &bsdf::ALBEDO_DOUBLED),
        (Form::constant(FRAC_1_PI), &bsdf::WITH_PI),
        (Form::constant(PI * PI), &bsdf::TIMES_PI),
        (Form { constant: 1.0, power: 1 }, &bsdf::COSINE_IN_F),
        (Form { constant: 1.0, power: -1 }, &bsdf::F_OVER_COSINE),
    ];
    made.into_iter().find(|(form, _)| share.is_like(*form)).map(|(_, cause)| cause)
}
