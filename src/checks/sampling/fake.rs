//! Cores that sample by any map and claim any pdf, for the tests of the checks in this folder.

use crate::checks::fake::Fake;
use crate::contract::{BsdfSample, BsdfValue, DirectionSample};
use crate::math::sphere::at_height;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, TAU};

/// Draws by `map` and claims `pdf`, whatever the sampler; BSDFs do the same with f = pdf. A map that gives no
/// direction fails.
pub(crate) fn drawing(map: fn(DVec2) -> Option<DVec3>, pdf: fn(DVec3) -> f64) -> Fake {
    Fake {
        direction: Box::new(move |random, number| {
            let direction = map(random.points[number]).unwrap_or(DVec3::Z);
            DirectionSample { direction, pdf: pdf(direction) }
        }),
        sample: Box::new(move |_, _, point, _| sample(map(point), pdf)),
        ..claiming(pdf)
    }
}

/// Reflects and refracts with the cosine, whatever its material and the viewer, and claims `pdf`.
pub(crate) fn interface(reflected: f64, pdf: fn(DVec3) -> f64) -> Fake {
    let draw = move |point, lobe| {
        let up = cosine(point)?;
        Some(if lobe < reflected { up } else { -up })
    };
    Fake {
        sample: Box::new(move |_, _, point, lobe| sample(draw(point, lobe), pdf)),
        ..claiming(pdf)
    }
}

fn claiming(pdf: fn(DVec3) -> f64) -> Fake {
    Fake {
        pdf: Box::new(pdf),
        value: Box::new(move |_, query| {
            let pdf = pdf(query.wi);
            BsdfValue { f: [pdf; 3], pdf }
        }),
        ..Fake::default()
    }
}

fn sample(wi: Option<DVec3>, pdf: fn(DVec3) -> f64) -> BsdfSample {
    let is_valid = wi.is_some().into();
    let wi = wi.unwrap_or(DVec3::Z);
    let pdf = pdf(wi);
    BsdfSample { wi, f: [pdf; 3], pdf, is_delta: 0, is_valid }
}

/// Malley's method, right.
pub(crate) fn cosine(point: DVec2) -> Option<DVec3> {
    Some(at_height((1.0 - point.x).sqrt(), TAU * point.y))
}

/// Archimedes' method, right.
pub(crate) fn uniform(point: DVec2) -> Option<DVec3> {
    Some(at_height(1.0 - point.x, TAU * point.y))
}

/// cos θ/π.
pub(crate) fn cosine_pdf(direction: DVec3) -> f64 {
    direction.z.max(0.0) * FRAC_1_PI
}

/// 1/2π.
pub(crate) fn uniform_pdf(direction: DVec3) -> f64 {
    if direction.z > 0.0 { 1.0 / TAU } else { 0.0 }
}
