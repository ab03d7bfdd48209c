//! Which mistake turns the reference into the picture: told where a fit explains what differs.

use super::shot::Shot;
use crate::cause::{Cause, bsdf, camera, image, integrator};
use crate::checks::{CheckError, Finding};
use crate::contract::BuiltScene;
use crate::image::Image;
use crate::math::rng::Seed;
use crate::scene::reference::Reference;
use crate::stats::ImageReport;
use crate::stats::misfit::{
    BouncesOff, Estimate, FactorOfBounces, Fit, Knowledge, Misfit, Symmetry, bounces_off, explain,
    factor_of_bounces, times_off,
};
use std::f64::consts::{FRAC_1_PI, PI};

/// Of what differs, the share that a mistake has to explain to be told as its cause.
const EXPLAINS: f64 = 0.5;
/// What explains less by so much than the best is no rival.
const ALIKE: f64 = 0.03;
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
    let pair = Pair { image: &report.mean, reference: &reference.mean, knowledge };
    let single = Shot { samples: 1, ..*shot };
    let singles = renders(&single, LIMIT_RUNS, built, seed.child("limit"))?;
    let bounces = Bounces::of(reference, shot, built, seed.child("bounce"))?;
    let fits = explain(pair.image, pair.reference, &pair.knowledge);
    let mut resembled: Vec<_> = fits.iter().flat_map(|fit| of_film(fit, shot.samples)).collect();
    resembled.extend(of_bounces(&pair, &bounces));
    resembled.extend(of_every_bounce(&pair, &bounces));
    let best = resembled.iter().map(|one| one.explains).fold(EXPLAINS, f64::max);
    let off = bounces_off(pair.image, pair.reference, &bounces.lights, &pair.knowledge);
    let off = off.filter(|off| off.share.explains > best - ALIKE).map(|off| bounces.words(&off));
    let fits = fits.iter().filter(|fit| fit.explains > EXPLAINS);
    let fits = fits.map(|fit| format!("the picture is {fit}"));
    let mut finding = finding;
    for words in off.map_or_else(|| fits.collect(), |off| vec![off]) {
        finding.statement += &format!("; {words}");
    }
    resembled.retain(|one| one.explains >= best - ALIKE);
    resembled.extend(limited(&singles, &pair));
    Ok(resembled
        .into_iter()
        .fold(finding, |finding, one| finding.because_in_size(one.cause, one.words, one.size)))
}

/// A picture, and what it should be.
struct Pair<'a> {
    image: &'a Image,
    reference: &'a Image,
    knowledge: Knowledge<'a>,
}

/// A mistake that would make much the same picture.
struct Resembled {
    cause: &'static Cause,
    words: String,
    /// What is the same in every picture that the mistake is made in.
    size: Option<[f64; 2]>,
    /// The share of the difference, from 0 to 1.
    explains: f64,
}

/// What a fit of the whole image says of the film.
fn of_film(fit: &Fit, samples: u32) -> Vec<Resembled> {
    let words = format!("the picture is the reference, {fit}");
    let one = |cause, size| Resembled { cause, words: words.clone(), size, explains: fit.explains };
    let of_a_pixel = format!("{words}, and a pixel has {samples} samples");
    let sums = not_divided(&fit.misfit, samples)
        .map(|cause| Resembled { words: of_a_pixel, ..one(cause, None) });
    cause_of(&fit.misfit).map(|(cause, size)| one(cause, size)).into_iter().chain(sums).collect()
}

/// A factor that is the number of samples of a pixel, or one over it.
fn not_divided(misfit: &Misfit, samples: u32) -> Option<&'static Cause> {
    let Misfit::Brighter(gain) = misfit else { return None };
    let is = |factor: f64| samples > 1 && gain.iter().all(|channel| channel.tells(factor));
    let samples = f64::from(samples);
    let causes = [(samples, &image::NOT_DIVIDED), (samples.recip(), &image::DIVIDED_TWICE)];
    causes.into_iter().find_map(|(factor, cause)| is(factor).then_some(cause))
}

/// Mistakes that take the light of some bounces away, or add it once more.
fn of_bounces(pair: &Pair<'_>, bounces: &Bounces) -> Vec<Resembled> {
    let Some(deepest) = bounces.lights.len().checked_sub(1) else { return Vec::new() };
    let laws = [
        (&integrator::EMISSION_LOST, [0, 0], 1.0),
        (&integrator::NO_INDIRECT, [2, deepest], 1.0),
        (&integrator::ONE_BOUNCE_SHORT, [deepest.max(2), deepest], 1.0),
        (&integrator::EMISSION_AGAIN, [1, deepest], -1.0),
        (&integrator::EMISSION_AGAIN, [2, deepest], -1.0),
    ];
    let inner = (1..deepest).map(|bounce| (&integrator::BOUNCE_MISSING, [bounce; 2], 1.0));
    let resembled = laws.into_iter().chain(inner).filter_map(|(cause, [first, last], times)| {
        let light = bounces.sum(first, last)?;
        let share = times_off(pair.image, pair.reference, &light, &pair.knowledge)?;
        let words = bounces.words(&BouncesOff { first, last, share });
        let explains = share.explains;
        // Which bounce of several is missing has to be the same everywhere, and one image has to tell it.
        let size = match *cause == integrator::BOUNCE_MISSING {
            true => share.missing.tells(times).then_some([first as f64; 2]),
            false => share.missing.allows(times).then(|| share.missing.length().interval),
        };
        Some(Resembled { cause, words, size: Some(size?), explains })
    });
    resembled.collect()
}

/// A factor with a name that light meets at every bounce.
fn of_every_bounce(pair: &Pair<'_>, bounces: &Bounces) -> Option<Resembled> {
    let Pair { image, reference, knowledge } = pair;
    let FactorOfBounces { factor, explains } =
        factor_of_bounces(image, reference, &bounces.lights, knowledge)?;
    let causes = [
        (PI, &bsdf::WITHOUT_PI),
        (FRAC_1_PI, &bsdf::WITH_PI),
        (0.5, &bsdf::ALBEDO_HALVED),
        (2.0, &bsdf::ALBEDO_DOUBLED),
    ];
    let (_, cause) = causes.into_iter().find(|(times, _)| factor.tells(*times))?;
    let by = bounces.by;
    let words = format!("bounce k is f^k times what {by} renders alone, with f = {factor}");
    Some(Resembled { cause, words, size: Some(factor.interval), explains })
}

/// Samples that are cut off lose light, and lose it at one value.
fn limited(singles: &[Image], pair: &Pair<'_>) -> Option<Resembled> {
    let light = |image: &Image| image.pixels.iter().flatten().map(|v| f64::from(*v)).sum::<f64>();
    let (level, pixels) = shared_limit(singles, pair.image, pair.reference)?;
    let of = format!("{pixels} pixels of {LIMIT_RUNS} pictures of one sample a pixel");
    let limited = Resembled {
        cause: &image::SAMPLES_CLAMPED,
        words: format!("{of} have exactly the value {level}, and none is brighter"),
        size: Some([f64::from(level); 2]),
        explains: 1.0,
    };
    (light(pair.image) < light(pair.reference)).then_some(limited)
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

    /// The light of bounces `first..=last`; none where there are none.
    fn sum(&self, first: usize, last: usize) -> Option<Image> {
        let mut bounces = self.lights.get(first..=last)?.iter();
        let mut light = bounces.next()?.clone();
        bounces.for_each(|bounce| light.add(bounce));
        Some(light)
    }

    /// `bounce 1 is missing, 1.0 ± 0.1 times what Mitsuba renders alone`
    fn words(&self, off: &BouncesOff) -> String {
        format!("{off} what {} renders alone", self.by)
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

/// The cause that a fit stands for, and its size where it has one.
fn cause_of(misfit: &Misfit) -> Option<(&'static Cause, Option<[f64; 2]>)> {
    let cause = match misfit {
        Misfit::Turned(Symmetry::LeftRight) => &image::MIRRORED,
        Misfit::Turned(Symmetry::UpsideDown) => &image::UPSIDE_DOWN,
        Misfit::Turned(Symmetry::Transposed | Symmetry::AntiTransposed) => &image::TRANSPOSED,
        Misfit::Turned(_) => &image::TURNED,
        Misfit::EncodedTwice => &image::GAMMA_TWICE,
        Misfit::Power(power) if power.value < 1.0 => &image::GAMMA_TWICE,
        Misfit::Clipped { .. } => &image::CLAMPED,
        Misfit::Displaced { right, down } => displaced([right, down]),
        Misfit::Magnified { .. } => &image::MAGNIFIED,
        // What colours the light is not the film's.
        Misfit::Brighter(gain) if is_grey(gain) => &image::FACTOR,
        Misfit::Stripe { .. } => &image::STRIPE,
        _ => return None,
    };
    Some((cause, size_of(misfit)))
}

/// What is the same in every picture that the mistake is made in.
fn size_of(misfit: &Misfit) -> Option<[f64; 2]> {
    match misfit {
        Misfit::Power(size)
        | Misfit::Stripe { factor: size, .. }
        | Misfit::Magnified { across: size, .. } => Some(size.interval),
        Misfit::Clipped { level, .. } => Some([*level; 2]),
        Misfit::Brighter(gain) => Some(common(gain)),
        Misfit::Displaced { right, down } => {
            let further = if right.value.abs() < down.value.abs() { down } else { right };
            Some(further.interval)
        }
        _ => None,
    }
}

fn is_grey(gain: &[Estimate; 3]) -> bool {
    let [low, high] = common(gain);
    low <= high
}

/// What is in the intervals of all channels.
fn common(gain: &[Estimate; 3]) -> [f64; 2] {
    gain.iter().fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], channel| {
        [low.max(channel.interval[0]), high.min(channel.interval[1])]
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
        cause_of(&displaced).unwrap().0.name
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
        let cause = |power| cause_of(&Misfit::Power(about(power))).map(|found| found.0.name);
        assert_eq!(cause(0.45), Some(image::GAMMA_TWICE.name));
        assert_eq!(cause(2.2), None);
    }

    #[test]
    fn a_factor_is_the_films_only_where_it_is_grey() {
        let cause = |gain: [f64; 3]| cause_of(&Misfit::Brighter(gain.map(about))).map(|f| f.0.name);
        assert_eq!(cause([1.5, 1.51, 1.49]), Some(image::FACTOR.name));
        assert_eq!(cause([1.2, 1.5, 1.6]), None);
    }

    /// Three bounces that look different.
    fn bounces() -> Bounces {
        let light = |of: fn(f64, f64) -> f64| {
            Image::from_fn(96, 64, |x, y| [of(x as f64, y as f64) as f32; 3])
        };
        let lights = vec![
            light(|x, _| if x < 20.0 { 1.0 } else { 0.5 }),
            light(|x, _| 0.05 + 0.001 * x),
            light(|_, y| 0.1 + 0.1 * (0.1 * y).sin().powi(2)),
        ];
        Bounces { lights, by: "Mitsuba" }
    }

    fn resembled(image: &Image) -> Vec<&'static str> {
        let bounces = bounces();
        let reference = &bounces.sum(0, 2).unwrap();
        let pair = Pair { image, reference, knowledge: Knowledge::default() };
        let of_bounces = of_bounces(&pair, &bounces).into_iter();
        of_bounces.filter(|one| one.explains > 0.99).map(|one| one.cause.name).collect()
    }

    #[test]
    fn a_factor_that_is_hardly_known_has_no_cause() {
        let cause = |value: f64, half: f64| {
            let gain = Estimate { value, interval: [value - half, value + half] };
            not_divided(&Misfit::Brighter([gain; 3]), 3).map(|cause| cause.name)
        };
        assert_eq!(cause(0.32, 0.03), Some(image::DIVIDED_TWICE.name));
        assert_eq!(cause(0.28, 0.06), None, "a third and a quarter alike");
        assert_eq!(cause(f64::NAN, 0.03), None);
    }

    #[test]
    fn bounces_that_are_off_have_causes_by_where_they_begin_and_end() {
        let of = |bounces: &[&Image]| {
            bounces.iter().fold(Image::new(96, 64, [0.0; 3]), |mut sum, light| {
                sum.add(light);
                sum
            })
        };
        let [emitted, direct, indirect] = &bounces().lights[..] else { panic!("three bounces") };
        assert_eq!(resembled(&of(&[direct, indirect])), [integrator::EMISSION_LOST.name]);
        assert_eq!(resembled(&of(&[emitted, indirect])), [integrator::BOUNCE_MISSING.name]);
        let short = [integrator::NO_INDIRECT.name, integrator::ONE_BOUNCE_SHORT.name];
        assert_eq!(resembled(&of(&[emitted, direct])), short, "nothing tells them apart");
        let again = of(&[emitted, direct, direct, indirect, indirect]);
        assert_eq!(resembled(&again), [integrator::EMISSION_AGAIN.name]);
    }

    #[test]
    fn a_factor_that_is_the_number_of_samples_is_a_sum_left_undivided() {
        let cause = |factor: f64, samples| {
            not_divided(&Misfit::Brighter([about(factor); 3]), samples).map(|cause| cause.name)
        };
        assert_eq!(cause(3.0, 3), Some(image::NOT_DIVIDED.name));
        assert_eq!(cause(0.5, 2), Some(image::DIVIDED_TWICE.name));
        assert_eq!(cause(2.0, 3), None);
        assert_eq!(cause(1.0, 1), None);
    }

    #[test]
    fn a_picture_that_is_too_bright_is_not_cut_off() {
        let expected = row(&[0.5; 12]);
        let pair = |image| Pair { image, reference: &expected, knowledge: Knowledge::default() };
        let mut single = [0.1f32; 12];
        single[..8].fill(10.0);
        let (dark, bright) = (row(&[0.4; 12]), row(&[0.6; 12]));
        assert!(limited(&[row(&single)], &pair(&dark)).is_some());
        assert!(limited(&[row(&single)], &pair(&bright)).is_none());
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
