//! What would have to be done to a reference to make it the picture: displaced, magnified, turned,
//! brighter as a whole or in a stripe, encoded, clipped.
//!
//! Each kind of mistake is fitted, and what it leaves of the difference is measured. The one that
//! leaves the least is named, with its numbers, if it explains a part of the difference that noise
//! cannot; then the rest is looked at again. Differences are relative to the brightness, and none
//! counts for more than its pixel's whole light, so that fireflies do not decide.
//!
//! Not here: whether the pictures differ. A fit names what has been found, and never grades.

mod level;
mod normal;
mod part;
mod place;
mod question;
mod resample;
mod stripe;
mod symmetry;
mod words;

#[cfg(test)]
mod tests;

pub(crate) use part::{BouncesOff, FactorOfBounces, bounces_off, factor_of_bounces, times_off};
pub(crate) use stripe::Lines;
pub(crate) use symmetry::Symmetry;

use crate::image::Image;
use crate::image::pair::Plane;
use question::Question;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Mistakes that are looked for in one picture, each in what the ones before leave.
const MOST_MISTAKES: usize = 3;
/// A mistake is named if what it explains is this many times its standard error between units.
const CERTAIN: f64 = 6.0;
/// A mistake that explains this share of the difference is named with less, for no noise follows
/// so few parameters so far: what differs may lie at a few edges only...
const MOSTLY: f64 = 0.5;
/// ...in two or three units at least.
const SEVERAL: f64 = 1.5;
/// A mistake with more parameters is preferred if it explains more by this many standard errors...
const BETTER: f64 = 4.0;
/// ...and by this share of the difference.
const MORE: f64 = 0.01;
/// Less than this share of a difference is not worth naming.
const WORTH_NAMING: f64 = 0.05;
/// A factor is, for it is what people ask first, and no noise is less for being multiplied.
const FACTOR_WORTH_NAMING: f64 = 0.001;

/// A number, and where it lies with 99.9 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Estimate {
    pub(crate) value: f64,
    pub(crate) interval: [f64; 2],
}

impl Estimate {
    fn new(value: f64, half_width: f64) -> Self {
        Self { value, interval: [value - half_width, value + half_width] }
    }

    /// The same of the number without its sign.
    pub(crate) fn length(self) -> Self {
        let [low, high] = self.interval;
        match self.value < 0.0 {
            true => Self { value: -self.value, interval: [-high, -low] },
            false => self,
        }
    }

    /// Whether a number is in the interval.
    pub(crate) fn allows(&self, value: f64) -> bool {
        self.interval[0] <= value && value <= self.interval[1]
    }

    /// Whether a number is in the interval, and hardly any other is.
    pub(crate) fn tells(&self, value: f64) -> bool {
        tells(self.interval, value)
    }
}

/// Whether a number is in an interval, and hardly any other is: a wide one would allow whatever is looked for.
pub(crate) fn tells([low, high]: [f64; 2], value: f64) -> bool {
    let reach = TELLING * value.abs();
    low <= value && value <= high && high - value <= reach && value - low <= reach
}

/// How far an interval reaches at most from a number that it tells, as a share of that number. Of the factors that causes
/// have the nearest two, 1/π and 1/2, lie more than a third apart.
const TELLING: f64 = 0.2;

/// What was done to the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Misfit {
    Turned(Symmetry),
    /// All light times a factor, for each channel.
    Brighter([Estimate; 3]),
    /// Every value to a power, where the reference is linear.
    Power(Estimate),
    /// Every value through the sRGB curve once too often.
    EncodedTwice,
    /// Every value through the inverse of the sRGB curve once too often.
    DecodedTwice,
    /// Cut off at a level, pixels above it in the reference.
    Clipped {
        level: f64,
        /// How many pixels of the reference are brighter.
        pixels: usize,
    },
    /// Multiplied by its coverage once more than the reference.
    TimesAlpha,
    /// Divided by its coverage once more than the reference.
    OverAlpha,
    /// Moved by a part of a pixel or more.
    Displaced {
        /// Pixels to the right.
        right: Estimate,
        /// Pixels down.
        down: Estimate,
    },
    /// Lines side by side times a factor.
    Stripe {
        lines: Lines,
        /// The first, from the top left.
        first: usize,
        last: usize,
        /// How bright they are beside what they should be.
        factor: Estimate,
    },
    /// Larger about its centre, and moved.
    Magnified {
        /// Factor along rows.
        across: Estimate,
        /// Factor along columns.
        upright: Estimate,
        /// Pixels to the right, after that.
        right: Estimate,
        /// Pixels down, after that.
        down: Estimate,
    },
}

/// A mistake that was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Fit {
    pub(crate) misfit: Misfit,
    /// The share of what differed before that no longer does, from 0 to 1.
    pub(crate) explains: f64,
    /// What it explains, over its standard error between units of 8 by 8 pixels.
    pub(crate) certainty: f64,
}

/// What is known of a picture beside its colours.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Knowledge<'a> {
    /// Coverage, where the picture's file holds it.
    pub(crate) alpha: Option<&'a Plane>,
    /// Pixels that count; all, if none.
    pub(crate) counted: Option<&'a [bool]>,
    /// The energy that the noise of both pictures adds to the difference is taken off before shares
    /// are computed, where its standard errors are known.
    pub(crate) standard_error: Option<&'a Image>,
}

/// The mistakes that turn `reference` into `image`, the greatest first; none where nothing known
/// explains the difference.
pub(crate) fn explain(image: &Image, reference: &Image, knowledge: &Knowledge<'_>) -> Vec<Fit> {
    assert!(image.same_size(reference), "two pictures of one size");
    let weights = question::weights(image, reference, knowledge);
    let (image, mut explained) = (finite(image), finite(reference));
    let mut fits = Vec::new();
    while fits.len() < MOST_MISTAKES {
        let question = Question {
            image: &image,
            reference: &explained,
            knowledge,
            weights: &weights,
            every: 1,
        };
        let Some((fit, picture)) = best(&question) else { break };
        let kind = std::mem::discriminant(&fit.misfit);
        // What was fitted before the rest was known is only a little off: no second mistake.
        if fits.iter().any(|other: &Fit| std::mem::discriminant(&other.misfit) == kind) {
            break;
        }
        fits.push(fit);
        explained = Cow::Owned(picture);
    }
    fits
}

/// Black where the picture is not a number: such pixels do not count, and must not spoil others.
fn finite(image: &Image) -> Cow<'_, Image> {
    if image.pixels.par_iter().all(|pixel| pixel.iter().all(|value| value.is_finite())) {
        return Cow::Borrowed(image);
    }
    let finite = |pixel: &[f32; 3]| pixel.map(|value| if value.is_finite() { value } else { 0.0 });
    Cow::Owned(Image { pixels: image.pixels.par_iter().map(finite).collect(), ..*image })
}

/// The mistake that explains most of what differs, and what it makes of the reference. One with
/// more parameters has to explain clearly more.
fn best(question: &Question<'_>) -> Option<(Fit, Image)> {
    let before = question.energies(question.reference);
    let total: f64 = before.iter().sum();
    let mut found: Option<(Misfit, Image, Vec<f64>)> = None;
    let mut consider = |(misfit, picture): (Misfit, Image)| {
        let after = question.energies(&picture);
        let incumbent = found.as_ref().map_or(&before, |(_, _, after)| after);
        let worth = match misfit {
            Misfit::Brighter(_) => FACTOR_WORTH_NAMING,
            _ => WORTH_NAMING,
        };
        let needed = if found.is_some() { (BETTER, MORE) } else { (CERTAIN, worth) };
        let gained: f64 = incumbent.iter().zip(&after).map(|(a, b)| a - b).sum();
        let left: f64 = incumbent.iter().sum();
        let certain = certainty(incumbent, &after);
        let is_clear = certain > needed.0 && gained > needed.1 * total;
        let is_most = certain > SEVERAL && gained > MOSTLY * left && gained > needed.1 * total;
        if is_clear || is_most {
            found = Some((misfit, picture, after));
        }
    };
    symmetry::candidates(question, &mut consider);
    level::candidates(question, &mut consider);
    place::candidates(question, &mut consider);
    stripe::candidates(question, &mut consider);
    let (misfit, picture, after) = found?;
    let noise = question.noise_energy().min(after.iter().sum());
    let explains = 1.0 - (after.iter().sum::<f64>() - noise) / (total - noise);
    Some((Fit { misfit, explains, certainty: certainty(&before, &after) }, picture))
}

/// The sum of what is gained in each unit over the standard error of that sum.
fn certainty(before: &[f64], after: &[f64]) -> f64 {
    let gains: crate::stats::Moments = before.iter().zip(after).map(|(a, b)| a - b).collect();
    let error = gains.standard_error();
    // Of a picture of one unit there is no spread to judge by.
    if error > 0.0 { gains.mean() / error } else { 0.0 }
}
