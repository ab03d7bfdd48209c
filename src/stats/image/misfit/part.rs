//! Light that a picture lacks, or has once too often: a part of it that was rendered alone.

use super::normal::{Sums, estimates, solve};
use super::question::{self, Question};
use super::{Estimate, Knowledge};
use crate::image::Image;
use serde::{Deserialize, Serialize};

/// What the noise of the part itself may shift the share by.
const ALLOWANCE: f64 = 0.1;

/// How often a part has to be taken from the reference to make it the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Share {
    /// 1 if the part is missing once, negative if it is there once too often.
    pub(crate) missing: Estimate,
    /// The share of the difference that this explains, from 0 to 1, without known noise.
    pub(crate) explains: f64,
}

impl Share {
    /// Whether the part is missing once, or there once too often: and not a part of it, for what
    /// looks much the same is off in part.
    fn is_whole(&self) -> bool {
        let is = |times: f64| self.missing.allows(times) && !self.missing.allows(0.5 * times);
        is(1.0) || is(-1.0)
    }
}

/// Bounces whose light is what a picture lacks, or has once too often.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BouncesOff {
    /// 0 is the emission that the camera sees.
    pub(crate) first: usize,
    pub(crate) last: usize,
    /// How often they are missing.
    pub(crate) share: Share,
}

/// The bounce, or all bounces from one on, whose light is what the picture lacks or has once too
/// often; none if nothing that differs is explained by that. `bounces` shows each alone, from
/// bounce 0.
pub(crate) fn bounces_off(
    image: &Image,
    reference: &Image,
    bounces: &[Image],
    knowledge: &Knowledge<'_>,
) -> Option<BouncesOff> {
    assert!(image.same_size(reference), "two pictures of one size");
    let weights = question::weights(image, reference, knowledge);
    let question = Question { image, reference, knowledge, weights: &weights, every: 1 };
    let mut best: Option<BouncesOff> = None;
    let mut consider = |first, last, light: &Image| {
        let share = share_of_part(&question, light).filter(Share::is_whole);
        let explains = best.map_or(f64::NEG_INFINITY, |best| best.share.explains);
        if let Some(share) = share.filter(|share| share.explains > explains) {
            best = Some(BouncesOff { first, last, share });
        }
    };
    let mut from_here = Image::new(image.width, image.height, [0.0; 3]);
    for (bounce, light) in bounces.iter().enumerate().rev() {
        consider(bounce, bounce, light);
        from_here.add(light);
        if bounce + 1 < bounces.len() {
            consider(bounce, bounces.len() - 1, &from_here);
        }
    }
    best
}

/// How often a part of the light is missing, or there too often; none where that is not a whole time, or the part is
/// black.
pub(crate) fn times_off(
    image: &Image,
    reference: &Image,
    part: &Image,
    knowledge: &Knowledge<'_>,
) -> Option<Share> {
    let weights = question::weights(image, reference, knowledge);
    let question = Question { image, reference, knowledge, weights: &weights, every: 1 };
    share_of_part(&question, part).filter(Share::is_whole)
}

/// Steps of Gauss and Newton.
const STEPS: usize = 30;
/// A step shorter than this is the last.
const CONVERGED: f64 = 1e-9;

/// A factor that light meets at every bounce: bounce k has its power k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FactorOfBounces {
    pub(crate) factor: Estimate,
    /// The share of the difference that this explains, from 0 to 1, without known noise.
    pub(crate) explains: f64,
}

/// The factor at every bounce that fits best; none where no bounce has light, or nothing fits.
pub(crate) fn factor_of_bounces(
    image: &Image,
    reference: &Image,
    bounces: &[Image],
    knowledge: &Knowledge<'_>,
) -> Option<FactorOfBounces> {
    let weights = question::weights(image, reference, knowledge);
    let question = Question { image, reference, knowledge, weights: &weights, every: 1 };
    let nothing: [_; 3] = std::array::from_fn(|_| vec![0.0; bounces.len() + 2]);
    // Of a unit and channel: the light of every bounce, what is there beyond the reference, and its noise squared.
    let units = question.fold_units(nothing, |sums, pixel| {
        let weight = f64::from(weights[pixel]);
        if weight > 0.0 {
            for (c, sums) in sums.iter_mut().enumerate() {
                let of = |picture: &Image| weight * f64::from(picture.pixels[pixel][c]);
                let noise = knowledge.standard_error.map_or(0.0, |error| of(error).powi(2));
                let beyond = of(image) - of(reference);
                let values = bounces.iter().map(of).chain([beyond, noise]);
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            }
        }
    });
    let light = |unit: &[f64], weight: &dyn Fn(i32) -> f64| -> f64 {
        (0..).zip(&unit[..bounces.len()]).map(|(bounce, light)| weight(bounce) * light).sum()
    };
    let beyond = |unit: &[f64]| unit[bounces.len()];
    let left =
        |unit: &[f64], factor: f64| beyond(unit) - light(unit, &|bounce| factor.powi(bounce) - 1.0);
    let (mut factor, mut error) = (1.0_f64, 0.0);
    for _ in 0..STEPS {
        let slope = |unit: &[f64]| {
            light(unit, &|bounce| f64::from(bounce) * factor.powi((bounce - 1).max(0)))
        };
        let sums = units.iter().map(|unit| {
            let mut sums = Sums::<1>::NOTHING;
            unit.iter().for_each(|unit| sums.add([slope(unit)], left(unit, factor)));
            sums
        });
        let ([step], [of_step]) = solve(&sums.collect::<Vec<_>>())?;
        (factor, error) = (factor + step, of_step);
        if step.abs() < CONVERGED {
            break;
        }
    }
    let channels = || units.iter().flatten();
    let before: f64 = channels().map(|unit| beyond(unit).powi(2)).sum();
    let after: f64 = channels().map(|unit| left(unit, factor).powi(2)).sum();
    let noise = channels().map(|unit| unit[bounces.len() + 1]).sum::<f64>().min(after);
    let [estimate] = estimates([factor], [error], [0.0]);
    let is_sane = factor > 0.0 && factor.is_finite();
    let explains = 1.0 - (after - noise) / (before - noise);
    is_sane.then_some(FactorOfBounces { factor: estimate, explains })
}

/// By least squares over units of 8 by 8 pixels, each weighted against the brightness around it; none if
/// the part is black.
fn share_of_part(question: &Question<'_>, part: &Image) -> Option<Share> {
    assert!(part.same_size(question.image), "three pictures of one size");
    let Question { image, reference, knowledge, weights, .. } = question;
    // Sums over a unit first: there, noise is small against light.
    let units = question.fold_units([[0.0f64; 3]; 3], |sums, pixel| {
        let weight = f64::from(weights[pixel]);
        if weight > 0.0 {
            for (c, sum) in sums.iter_mut().enumerate() {
                let of = |picture: &Image| f64::from(picture.pixels[pixel][c]);
                sum[0] += weight * of(part);
                sum[1] += weight * (of(reference) - of(image));
                sum[2] += knowledge.standard_error.map_or(0.0, |e| (weight * of(e)).powi(2));
            }
        }
    });
    let sums: Vec<Sums<1>> = units
        .iter()
        .map(|unit| {
            let mut sums = Sums::NOTHING;
            unit.iter().for_each(|[part, lacks, _]| sums.add([*part], *lacks));
            sums
        })
        .collect();
    let ([share], [error]) = solve(&sums)?;
    let parts = || units.iter().flatten();
    let before: f64 = parts().map(|[_, lacks, _]| lacks * lacks).sum();
    let after: f64 = parts().map(|[part, lacks, _]| (lacks - share * part).powi(2)).sum();
    let noise = parts().map(|[_, _, noise]| noise).sum::<f64>().min(after);
    let [missing] = estimates([share], [error], [ALLOWANCE]);
    Some(Share { missing, explains: 1.0 - (after - noise) / (before - noise) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    fn picture(value: impl Fn(f64, f64) -> f64, seed: u64) -> Image {
        let mut stream = Seed(seed).stream();
        Image::from_fn(96, 64, |x, y| {
            let noise = 1.0 + 0.1 * (2.0 * uniform(&mut stream) - 1.0);
            [(noise * value(x as f64, y as f64)) as f32; 3]
        })
    }

    #[test]
    fn the_bounce_that_is_off_is_told_from_the_others() {
        let lights: [fn(f64, f64) -> f64; 3] = [
            |x, _| if x < 20.0 { 1.0 } else { 0.5 },
            |x, _| 0.05 + 0.001 * x,
            |_, y| 0.1 * (0.1 * y).sin().powi(2),
        ];
        let reference = picture(|x, y| lights.iter().map(|light| light(x, y)).sum(), 1);
        let bounces: Vec<Image> = (3..).zip(lights).map(|(s, light)| picture(light, s)).collect();
        for (first, last, times) in [(1, 1, 0.0), (2, 2, 0.0), (1, 1, 2.0), (1, 2, 0.0)] {
            let shown = |x, y| {
                let factor = |i| if (first..=last).contains(&i) { times } else { 1.0 };
                (0..3).map(|i| factor(i) * lights[i](x, y)).sum()
            };
            let image = picture(shown, 2);
            let off = bounces_off(&image, &reference, &bounces, &Knowledge::default()).unwrap();
            assert_eq!([off.first, off.last], [first, last], "{off:?}");
            let share = off.share;
            assert!(share.missing.allows(1.0 - times) && share.explains > 0.5, "{share:?}");
        }
    }

    #[test]
    fn a_factor_at_every_bounce_is_measured() {
        let lights: [fn(f64, f64) -> f64; 4] = [
            |x, _| if x < 20.0 { 1.0 } else { 0.0 },
            |x, _| 0.05 + 0.001 * x,
            |_, y| 0.1 * (0.1 * y).sin().powi(2),
            |_, _| 0.03,
        ];
        let reference = picture(|x, y| lights.iter().map(|light| light(x, y)).sum(), 1);
        let bounces: Vec<Image> = (3..).zip(lights).map(|(s, light)| picture(light, s)).collect();
        for factor in [0.5, 1.2, std::f64::consts::PI] {
            let shown =
                |x, y| (0..4).map(|k| f64::powi(factor, k) * lights[k as usize](x, y)).sum();
            let image = picture(shown, 2);
            let knowledge = Knowledge::default();
            let found = factor_of_bounces(&image, &reference, &bounces, &knowledge).unwrap();
            assert!((found.factor.value / factor - 1.0).abs() < 0.02, "{factor}: {found:?}");
            assert!(found.explains > 0.9, "{factor}: {found:?}");
        }
        let black = [Image::new(96, 64, [0.0; 3])];
        assert_eq!(factor_of_bounces(&reference, &reference, &black, &Knowledge::default()), None);
    }

    #[test]
    fn a_missing_part_is_measured_and_another_is_not_taken_for_it() {
        let part = |x: f64, _: f64| 0.05 + 0.001 * x;
        let other = |_: f64, y: f64| 0.3 * (0.1 * y).sin().powi(2);
        let whole = |x: f64, y: f64| 1.0 + part(x, y) + other(x, y);
        let reference = picture(whole, 1);
        let image = picture(|x, y| whole(x, y) - part(x, y), 2);
        let knowledge = Knowledge::default();
        let weights = question::weights(&image, &reference, &knowledge);
        let (image, reference) = (&image, &reference);
        let question =
            Question { image, reference, knowledge: &knowledge, weights: &weights, every: 1 };
        let share = |part: &Image| share_of_part(&question, part).unwrap();
        let right = share(&picture(part, 3));
        assert!(right.missing.allows(1.0) && right.explains > 0.5, "{right:?}");
        let wrong = share(&picture(other, 4));
        assert!(!wrong.missing.allows(1.0) || wrong.explains < right.explains, "{wrong:?}");
        let black = Image::new(96, 64, [0.0; 3]);
        assert_eq!(share_of_part(&question, &black), None);
    }
}
