//! Which mistake turns the reference into the picture: told where a fit explains what differs.

use super::shot::Shot;
use crate::cause::{Cause, camera, image, integrator};
use crate::checks::{CheckError, Finding};
use crate::contract::BuiltScene;
use crate::image::Image;
use crate::math::rng::Seed;
use crate::scene::reference::Reference;
use crate::stats::ImageReport;
use crate::stats::misfit::{
    BouncesOff, Estimate, Knowledge, Misfit, Symmetry, bounces_off, explain,
};

/// Of what differs, the share that a mistake has to explain to be told as its cause.
const EXPLAINS: f64 = 0.5;
/// Renders that say how bright a bounce is.
const BOUNCE_RUNS: u32 = 8;
/// Pictures of one sample a pixel that are searched for a limit.
const LIMIT_RUNS: u32 = 16;
/// Pixels that have to share the largest value of all.
const FEWEST_AT_LIMIT: usize = 8;
/// Pixels with a value, to a hundredth, that make it the value of a light.
const FEWEST_OF_LIGHT: usize = 4;

/// Adds what the fits say to a failure.
pub(super) fn explained(
    finding: Finding,
    report: &ImageReport,
    reference: &Reference,
    shot: &Shot,
    built: &mut dyn BuiltScene,
    seed: Seed,
) -> Result<Finding, CheckError> {
    let noises = report.standard_error.pixels.iter().zip(&reference.standard_error.pixels);
    let noise = noises.map(|(a, b)| std::array::from_fn(|c| a[c].hypot(b[c]))).collect();
    let noise = Image { pixels: noise, ..reference.mean };
    let knowledge = Knowledge { standard_error: Some(&noise), ..Knowledge::default() };
    let fits = explain(&report.mean, &reference.mean, &knowledge);
    let single = Shot { samples: 1, ..*shot };
    let singles = renders(&single, LIMIT_RUNS, built, seed.child("limit"))?;
    let limit = shared_limit(&singles, &report.mean, &reference.mean).map(|(level, pixels)| {
        let of = format!("{pixels} pixels of {LIMIT_RUNS} pictures of one sample a pixel");
        format!("{of} have exactly the value {level}, and none is brighter")
    });
    let mut finding = finding.because_of(limit.map(|told| (&image::SAMPLES_CLAMPED, told)));
    // A bounce that is off also looks like a factor: what explains more is told.
    let bounces = Bounces::of(reference, shot, built, seed.child("bounce"))?;
    let off = bounces_off(&report.mean, &reference.mean, &bounces.lights, &knowledge);
    let most = fits.iter().map(|fit| fit.explains).fold(EXPLAINS, f64::max);
    if let Some(off) = off.filter(|off| off.share.explains > most) {
        return Ok(with_bounces_off(finding, &off, bounces.by));
    }
    for fit in fits.iter().filter(|fit| fit.explains > EXPLAINS) {
        finding.statement += &format!("; the picture is {fit}");
        if let Some(cause) = cause_of(&fit.misfit) {
            finding = finding.because(cause, format!("the picture is the reference, {fit}"));
        }
    }
    Ok(finding)
}

fn with_bounces_off(mut finding: Finding, off: &BouncesOff, by: &str) -> Finding {
    let words = format!("{off} what {by} renders alone");
    finding.statement += &format!("; {words}");
    match off {
        BouncesOff { share, .. } if share.missing.value < 0.0 => finding,
        // All from the second on, if that is more than the last.
        BouncesOff { first: 2, last: 3.., .. } => finding.because(&integrator::NO_INDIRECT, words),
        _ => finding.because(&integrator::BOUNCE_MISSING, words),
    }
}

/// Bounces of a reference, each alone.
struct Bounces {
    lights: Vec<Image>,
    /// Who rendered them.
    by: &'static str,
}

impl Bounces {
    /// By the reference, or else by the core if it can, from bounce 0 on: none of a core that cannot.
    fn of(
        reference: &Reference,
        shot: &Shot,
        built: &mut dyn BuiltScene,
        seed: Seed,
    ) -> Result<Self, CheckError> {
        let stored = &reference.layers.bounces;
        if !stored.is_empty() || !shot.isolates {
            return Ok(Self { lights: stored.clone(), by: "Mitsuba" });
        }
        let alone = |bounce| alone(bounce, shot, built, seed.child(bounce));
        let lights = (0..=shot.bounces[1]).map(alone).collect::<Result<_, _>>()?;
        Ok(Self { lights, by: "the core itself" })
    }
}

/// The mean of some renders of one bounce.
fn alone(
    bounce: u32,
    shot: &Shot,
    built: &mut dyn BuiltScene,
    seed: Seed,
) -> Result<Image, CheckError> {
    let shot = Shot { bounces: [bounce; 2], ..*shot };
    let mut runs = renders(&shot, BOUNCE_RUNS, built, seed)?.into_iter();
    let mut light = runs.next().unwrap_or_default();
    runs.for_each(|run| light.add(&run));
    let mean = |pixel: &mut [f32; 3]| *pixel = pixel.map(|sum| sum / BOUNCE_RUNS as f32);
    light.pixels.iter_mut().for_each(mean);
    Ok(light)
}

fn renders(
    shot: &Shot,
    runs: u32,
    built: &mut dyn BuiltScene,
    seed: Seed,
) -> Result<Vec<Image>, CheckError> {
    (0..runs).map(|run| shot.render(built, seed.child(run))).collect()
}

/// The cause that a fit stands for.
fn cause_of(misfit: &Misfit) -> Option<&'static Cause> {
    Some(match misfit {
        Misfit::Turned(Symmetry::LeftRight) => &image::MIRRORED,
        Misfit::Turned(Symmetry::UpsideDown) => &image::UPSIDE_DOWN,
        Misfit::Turned(Symmetry::Transposed | Symmetry::AntiTransposed) => &image::TRANSPOSED,
        Misfit::Turned(_) => &image::TURNED,
        Misfit::EncodedTwice => &image::GAMMA_TWICE,
        Misfit::Power(power) if power.value < 1.0 => &image::GAMMA_TWICE,
        Misfit::Clipped { .. } => &image::CLAMPED,
        Misfit::Displaced { right, down } => displaced([right, down]),
        Misfit::Magnified { .. } => &image::MAGNIFIED,
        Misfit::Brighter(_) => &image::FACTOR,
        Misfit::Stripe { .. } => &image::STRIPE,
        _ => return None,
    })
}

/// Half a pixel and a whole one have mistakes of their own.
fn displaced(offsets: [&Estimate; 2]) -> &'static Cause {
    let is = |size: f64| {
        let fits = |offset: &Estimate| offset.allows(size) || offset.allows(-size);
        offsets.iter().all(|offset| fits(offset) || offset.allows(0.0))
            && offsets.into_iter().any(fits)
    };
    match (is(0.5), is(1.0)) {
        (true, _) => &camera::HALF_A_PIXEL,
        (_, true) => &camera::WHOLE_PIXEL,
        _ => &image::DISPLACED,
    }
}

/// The largest of single samples, if many pixels share it to the last bit and it is not the light of a light in view.
fn shared_limit(singles: &[Image], mean: &Image, expected: &Image) -> Option<(f32, usize)> {
    let of_singles = |single: &Image| {
        let pairs = single.pixels.iter().zip(&expected.pixels);
        // A pixel of a light has the light's value, and rightly so.
        let lit = pairs.filter(|(one, expected)| largest(expected) < 0.5 * largest(one));
        lit.map(|(one, _)| largest(one)).collect::<Vec<_>>()
    };
    let brightest: Vec<f32> = singles.iter().flat_map(of_singles).collect();
    let level = brightest.iter().copied().fold(0.0, f32::max);
    let pixels = brightest.iter().filter(|value| **value == level).count();
    // A light in view has its value in the mean as well, unless it should have more.
    let is_light_pixel = |(mean, expected): &(&[f32; 3], &[f32; 3])| {
        (largest(mean) / level - 1.0).abs() < 0.01 && largest(expected) < 1.01 * level
    };
    let light_pixels = mean.pixels.iter().zip(&expected.pixels).filter(is_light_pixel).count();
    let is_limit = level > 0.0 && pixels >= FEWEST_AT_LIMIT && light_pixels < FEWEST_OF_LIGHT;
    is_limit.then_some((level, pixels))
}

fn largest(pixel: &[f32; 3]) -> f32 {
    pixel.iter().copied().fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(value: f64) -> Estimate {
        Estimate { value, interval: [value - 0.02, value + 0.02] }
    }

    fn told(right: f64, down: f64) -> &'static str {
        let displaced = Misfit::Displaced { right: about(right), down: about(down) };
        cause_of(&displaced).unwrap().name
    }

    #[test]
    fn half_a_pixel_and_a_whole_one_have_causes_of_their_own() {
        assert_eq!(told(0.5, 0.0), camera::HALF_A_PIXEL.name);
        assert_eq!(told(-0.49, 0.51), camera::HALF_A_PIXEL.name);
        assert_eq!(told(0.0, 1.0), camera::WHOLE_PIXEL.name);
        assert_eq!(told(0.3, 0.0), image::DISPLACED.name);
        assert_eq!(told(0.5, 1.0), image::DISPLACED.name);
    }

    #[test]
    fn a_brighter_power_is_gamma_applied_twice_and_a_darker_one_has_no_name() {
        let cause = |power| cause_of(&Misfit::Power(about(power))).map(|cause| cause.name);
        assert_eq!(cause(0.45), Some(image::GAMMA_TWICE.name));
        assert_eq!(cause(2.2), None);
    }

    /// A row of pixels of these values.
    fn row(values: &[f32]) -> Image {
        Image::from_fn(values.len(), 1, |x, _| [values[x]; 3])
    }

    #[test]
    fn samples_that_share_their_largest_value_are_cut_off_there() {
        let mean = row(&[0.5; 12]);
        let mut clamped = [0.1f32; 12];
        clamped[..8].fill(10.0);
        assert_eq!(shared_limit(&[row(&clamped)], &mean, &mean), Some((10.0, 8)));
        clamped[0] = 10.5;
        assert_eq!(shared_limit(&[row(&clamped)], &mean, &mean), None, "one is brighter");
        assert_eq!(shared_limit(&[row(&[0.0; 12])], &mean, &mean), None, "nothing is lit");
    }

    #[test]
    fn the_light_of_a_light_in_view_is_no_limit() {
        let mut seen = [0.5f32; 16];
        seen[..4].fill(10.0);
        let mut single = [10.0f32; 16];
        single[12..].fill(0.1);
        assert_eq!(shared_limit(&[row(&single)], &row(&seen), &row(&seen)), None);
        let mut brighter = seen;
        brighter[..4].fill(30.0);
        assert!(shared_limit(&[row(&single)], &row(&seen), &row(&brighter)).is_some());
    }
}
