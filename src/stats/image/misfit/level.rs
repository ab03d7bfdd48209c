//! Pictures whose values went through something: a factor, a power, the curve of a screen, a limit,
//! coverage.

use super::normal::{Sums, estimates, solve};
use super::question::Question;
use super::{Estimate, Misfit};
use crate::image::Image;
use rayon::prelude::*;

/// Powers that the search begins at: none, and the two that screens make.
const POWERS: [f64; 3] = [1.0, 1.0 / 2.2, 2.2];
/// Steps of Gauss and Newton.
const STEPS: usize = 20;
/// A step shorter than this is the last.
const CONVERGED: f64 = 1e-6;
/// Pixels of the reference that have to be brighter than a limit by [`CLEARLY`], so that it is one.
const FEWEST_CLIPPED: usize = 4;
const CLEARLY: f32 = 1.02;
/// Coverage below this cannot be divided by.
const TRANSPARENT: f32 = 1e-3;

/// What becomes of a value.
type Curve = fn(f32) -> f32;

/// The curve of a screen and its inverse.
const CURVES: [(Misfit, Curve); 2] =
    [(Misfit::EncodedTwice, encoded), (Misfit::DecodedTwice, decoded)];

/// What becomes of the reference by each of them, as fits the picture best.
pub(super) fn candidates(question: &Question<'_>, consider: &mut dyn FnMut((Misfit, Image))) {
    let picture = |value: &(dyn Fn(usize, f32) -> f32 + Sync)| each(question.reference, value);
    if let Some(level) = clip_level(question) {
        let above = |pixel: &&[f32; 3]| pixel.iter().any(|value| *value > level);
        let pixels = question.reference.pixels.iter().filter(above).count();
        let misfit = Misfit::Clipped { level: f64::from(level), pixels };
        consider((misfit, picture(&|_, value| value.min(level))));
    }
    for (misfit, curve) in CURVES {
        if question.is_worth_a_look(|pixel| question.reference.pixels[pixel].map(curve)) {
            consider((misfit, picture(&|_, value| curve(value))));
        }
    }
    if let Some(alpha) = question.knowledge.alpha {
        let alpha = |pixel: usize| alpha.values[pixel];
        consider((Misfit::TimesAlpha, picture(&|pixel, value| value * alpha(pixel))));
        let over = |pixel: usize, value: f32| value / alpha(pixel).max(TRANSPARENT);
        consider((Misfit::OverAlpha, picture(&over)));
    }
    if let Some(gain) = gain(question) {
        #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
        let factors = gain.map(|estimate| estimate.value as f32);
        let brighter = question.reference.pixels.par_iter().map(|pixel| {
            let channel = |c: usize| pixel[c] * factors[c];
            [channel(0), channel(1), channel(2)]
        });
        let pixels = brighter.collect();
        consider((Misfit::Brighter(gain), Image { pixels, ..*question.reference }));
    }
    if let Some(power) = power(&question.thin()) {
        #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
        let exponent = power.value as f32;
        let raised = |value: f32| value.max(0.0).powf(exponent);
        if question.is_worth_a_look(|pixel| question.reference.pixels[pixel].map(raised)) {
            consider((Misfit::Power(power), picture(&|_, value| raised(value))));
        }
    }
}

/// A picture of `value` of the number of each pixel and each of its channels.
fn each(image: &Image, value: &(dyn Fn(usize, f32) -> f32 + Sync)) -> Image {
    let pixels = image.pixels.par_iter().enumerate();
    let pixels = pixels.map(|(i, pixel)| pixel.map(|channel| value(i, channel))).collect();
    Image { pixels, ..*image }
}

/// The sRGB curve, going on beyond white.
fn encoded(value: f32) -> f32 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

/// Its inverse.
fn decoded(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The largest value of the picture, if pixels that should be brighter by far have just that.
fn clip_level(question: &Question<'_>) -> Option<f32> {
    let counted = |i: usize| question.weights[i] > 0.0;
    let pixels = || (0..question.image.pixels.len()).into_par_iter().filter(|i| counted(*i));
    let brightest = |i: usize| question.image.pixels[i].into_iter().fold(f32::MIN, f32::max);
    let level = pixels().map(brightest).reduce(|| f32::MIN, f32::max);
    let clipped = |i: &usize| {
        let (image, reference) = (question.image.pixels[*i], question.reference.pixels[*i]);
        let at_limit = |c: usize| image[c] > 0.999 * level && reference[c] > CLEARLY * level;
        (0..3).any(at_limit)
    };
    let found = pixels().filter(clipped).count();
    (level > 0.0 && found >= FEWEST_CLIPPED).then_some(level)
}

/// The factor of each channel: light over light, unit by unit. Least squares would take the noise of
/// the reference for darkness.
fn gain(question: &Question<'_>) -> Option<[Estimate; 3]> {
    let units = question.fold_units([[0.0f64; 2]; 3], |sums, pixel| {
        let weight = f64::from(question.weights[pixel]);
        let pair = [question.image.pixels[pixel], question.reference.pixels[pixel]];
        if weight > 0.0 {
            for (c, sum) in sums.iter_mut().enumerate() {
                sum[0] += weight * f64::from(pair[0][c]);
                sum[1] += weight * f64::from(pair[1][c]);
            }
        }
    });
    let of_channel = |c: usize| {
        let total = |i: usize| units.iter().map(|unit| unit[c][i]).sum::<f64>();
        let [image, reference] = [total(0), total(1)];
        if reference <= 0.0 {
            // A channel that is black everywhere has no factor to be found.
            return (1.0, 0.0);
        }
        let factor = image / reference;
        let off = units.iter().map(|unit| (unit[c][0] - factor * unit[c][1]).powi(2)).sum::<f64>();
        (factor, off.sqrt() / reference)
    };
    let found = [0, 1, 2].map(of_channel);
    let is_sane = found.iter().all(|(factor, _)| *factor > 0.0 && factor.is_finite());
    is_sane.then(|| estimates(found.map(|f| f.0), found.map(|f| f.1), [0.0; 3]))
}

/// The power that all values were raised to, by least squares.
fn power(question: &Question<'_>) -> Option<Estimate> {
    let starts = POWERS.map(|power| (energy(question, power), power));
    let (_, mut power) = starts.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut error = 0.0;
    for _ in 0..STEPS {
        let units = power_sums(question, power);
        let ([step], [found]) = solve(&units)?;
        power += step.clamp(-0.2, 0.2);
        error = found;
        if step.abs() < CONVERGED {
            break;
        }
    }
    let [estimate] = estimates([power], [error], [0.0]);
    (0.1..=10.0).contains(&power).then_some(estimate)
}

fn energy(question: &Question<'_>, power: f64) -> f64 {
    let raised = |value: f32| value.max(0.0).powf(power as f32);
    question.energies_of(|pixel| question.reference.pixels[pixel].map(raised)).iter().sum()
}

fn power_sums(question: &Question<'_>, power: f64) -> Vec<Sums<1>> {
    question.fold_units(Sums::NOTHING, |sums, pixel| {
        let weight = question.weights[pixel];
        let (image, reference) = (question.image.pixels[pixel], question.reference.pixels[pixel]);
        for c in 0..3 {
            if weight > 0.0 && reference[c] > 0.0 {
                let logarithm = reference[c].ln();
                let raised = (power as f32 * logarithm).exp();
                let slope = f64::from(weight * raised * logarithm);
                sums.add([slope], f64::from(question.difference(pixel, image[c], raised)));
            }
        }
    })
}
