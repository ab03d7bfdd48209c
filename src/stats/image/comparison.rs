//! Two pictures compared with all that their files say of their noise: whether they show the same,
//! which mistake turns one into the other, and how far apart the metrics see them.

use super::codes::{CodeReference, Deciphered, LightOfCodes, NoiseSource, light_of_codes};
use super::difference::{DifferenceReport, Sample, judge_difference};
use super::misfit::{BouncesOff, Fit, Knowledge, bounces_off, explain};
use crate::image::encoding::Encoding;
use crate::image::file::Loaded;
use crate::image::flip;
use crate::image::metric::{METRICS, Metric};
use crate::image::pair::{Pair, Plane};
use crate::image::png::Picture as Codes;
use crate::image::{Image, ImageError};
use crate::stats::{Moments, Verdict};
use serde::Serialize;
use std::borrow::Cow;

/// Of white, what a pixel may have so that hardly any noise clips it.
const SAFE_FROM_CLIPPING: f32 = 0.5;
/// Fewer renders say too little of their variance.
const FEWEST_RUNS: usize = 4;

/// A picture and how well it is known.
pub struct Side {
    image: Image,
    alpha: Option<Plane>,
    /// Each bounce alone, where the file holds them.
    bounces: Vec<Image>,
    variance: Option<Image>,
    /// Whether the variance is that of a picture of its own.
    is_variance_given: bool,
    rounding: Option<Image>,
    /// Whether it came from a file of whole numbers.
    is_coded: bool,
    /// The codes of every file, if all hold 8 bits.
    codes: Vec<Codes>,
}

impl Side {
    /// A file, with the standard errors and the isolated bounces that it holds.
    pub(crate) fn of(loaded: Loaded, standard_error: Option<&Image>, bounces: Vec<Image>) -> Self {
        let rounding = loaded.codes.as_ref().map(|codes| rounding(&loaded, codes.largest));
        Self {
            is_coded: rounding.is_some(),
            codes: loaded.codes.and_then(|codes| codes.picture).into_iter().collect(),
            image: loaded.image,
            alpha: loaded.alpha,
            bounces,
            variance: standard_error
                .map(|errors| errors.map(|error| error.map(|error| error * error))),
            is_variance_given: false,
            rounding,
        }
    }

    /// The mean of several renders of one picture; [`ImageError::DifferentSizes`] if they are not.
    pub(crate) fn mean_of(runs: &[Loaded]) -> Result<Self, ImageError> {
        let [width, height] = runs.first().map_or([0; 2], |run| run.image.size());
        if let Some(other) = runs.iter().map(|run| run.image.size()).find(|s| *s != [width, height])
        {
            return Err(ImageError::DifferentSizes { sizes: [[width, height], other] });
        }
        let picture = |value: fn(&Moments) -> f64| {
            Image::from_fn(width, height, |x, y| {
                [0, 1, 2].map(|c| {
                    let runs = runs.iter().map(|run| f64::from(run.image.pixels[y * width + x][c]));
                    value(&runs.collect()) as f32
                })
            })
        };
        let codes = runs.iter().map(|run| run.codes.as_ref()?.picture.clone());
        Ok(Self {
            image: picture(Moments::mean),
            alpha: runs.first().and_then(|run| run.alpha.clone()),
            bounces: Vec::new(),
            variance: (runs.len() >= FEWEST_RUNS)
                .then(|| picture(|moments| moments.standard_error().powi(2))),
            is_variance_given: false,
            rounding: None,
            is_coded: runs.iter().any(|run| run.codes.is_some()),
            codes: codes.collect::<Option<_>>().unwrap_or_default(),
        })
    }

    /// The same with a picture of the variance of every value; none if it has another size or is negative.
    pub(crate) fn with_variance(self, variance: Image) -> Option<Self> {
        let is_variance = |value: &f32| *value >= 0.0 && value.is_finite();
        let fits = variance.size() == self.image.size();
        let is_one = fits && variance.pixels.as_flattened().iter().all(is_variance);
        is_one.then_some(Self { variance: Some(variance), is_variance_given: true, ..self })
    }

    pub(crate) fn size(&self) -> [usize; 2] {
        self.image.size()
    }

    pub(crate) fn image(&self) -> &Image {
        &self.image
    }

    /// Of each value, if it is known.
    pub(crate) fn standard_error(&self) -> Option<Image> {
        Some(self.variance.as_ref()?.map(|pixel| pixel.map(f32::sqrt)))
    }

    pub(crate) const fn is_coded(&self) -> bool {
        self.is_coded
    }

    /// The light behind the codes of this side, if it has no more than 8 bits and the other is
    /// radiance that is known with its errors: decoded, noise would look like darkness.
    fn light_against(&self, reference: &Self, encoding: Encoding) -> Option<LightOfCodes> {
        let errors = reference.variance.as_ref().filter(|_| !reference.is_coded)?;
        let standard_error = errors.map(|variance| variance.map(f32::sqrt));
        let known = CodeReference {
            mean: &reference.image,
            standard_error: &standard_error,
            samples: None,
        };
        let codes: Vec<&Codes> = self.codes.iter().collect();
        let variance = self.variance.as_ref().filter(|_| self.is_variance_given);
        (!codes.is_empty()).then(|| light_of_codes(known, &codes, variance, encoding))
    }

    fn sample(&self) -> Sample<'_> {
        Sample {
            image: &self.image,
            variance: self.variance.as_ref(),
            rounding: self.rounding.as_ref(),
        }
    }
}

/// All that a comparison found out.
#[derive(Debug, Serialize)]
pub struct Comparison {
    pub(crate) verdict: Verdict,
    pub(crate) size: [usize; 2],
    /// Pixels that the test judges.
    pub(crate) pixels: usize,
    pub(crate) difference: DifferenceReport,
    /// How the codes of an 8-bit picture were compared, if it could be done by their law.
    pub(crate) codes: Option<CodesCompared>,
    /// What turns the reference into the picture, the greatest mistake first.
    pub(crate) mistakes: Vec<Fit>,
    /// Bounces that are missing or there too often, if the reference holds its bounces apart and that
    /// explains more than any mistake.
    pub(crate) bounces: Option<BouncesOff>,
    /// Of what is displayed, where a side has codes: whole numbers that end at black and white.
    pub(crate) clipped: Option<Clipped>,
    /// Of the codes over the largest if either side has codes; of radiance otherwise.
    pub(crate) metrics: Vec<Measured>,
}

/// Pixels at the ends of what an 8-bit image holds. Metrics take them as they are, as all tools do; the test
/// leaves out those that noise may have clipped.
#[derive(Debug, Serialize)]
pub(crate) struct Clipped {
    pub(crate) image: Ends,
    pub(crate) reference: Ends,
}

/// Pixels with a channel at an end of the scale.
#[derive(Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct Ends {
    pub(crate) black: usize,
    pub(crate) white: usize,
}

impl Ends {
    fn of(codes: &Image, counted: &[bool]) -> Self {
        let with = |is_end: fn(f32) -> bool| {
            let pixels = codes.pixels.iter().zip(counted).filter(|(_, counted)| **counted);
            pixels.filter(|(pixel, _)| pixel.iter().any(|share| is_end(*share))).count()
        };
        Self { black: with(|share| share <= 0.0), white: with(|share| share >= 1.0) }
    }
}

/// What was done with codes.
#[derive(Debug, Serialize)]
pub struct CodesCompared {
    pub(crate) deciphered: Deciphered,
    pub(crate) noise: NoiseSource,
}

/// A metric of all pixels but those that were asked to be ignored.
#[derive(Debug, Serialize)]
pub(crate) struct Measured {
    pub(crate) name: &'static str,
    /// None where a pixel is not a number.
    pub(crate) value: Option<f64>,
}

/// What is asked of a comparison, besides its pictures.
#[derive(Clone, Debug)]
pub struct Question {
    /// How the codes of 8-bit pictures are said to be made.
    pub encoding: Encoding,
    /// Whether each pixel counts, row by row.
    pub counted: Vec<bool>,
    /// Whether metrics are measured that take long.
    pub slow_metrics: bool,
}

/// Compares a picture with its reference.
///
/// # Errors
/// [`ImageError::DifferentSizes`], of the pictures or of what counts.
pub(crate) fn compare(
    picture: &Side,
    reference: &Side,
    question: Question,
) -> Result<Comparison, ImageError> {
    let size = reference.size();
    if picture.size() != size {
        return Err(ImageError::DifferentSizes { sizes: [picture.size(), size] });
    }
    let light = picture.light_against(reference, question.encoding);
    let measured = || metrics(picture, reference, &question);
    let counted = counted(question.counted.clone(), picture, reference, light.as_ref());
    let counted = counted.contains(&false).then_some(counted);
    let judged = || judged(picture, reference, light.as_ref(), counted.as_deref());
    let ((difference, mistakes, bounces), measured) = rayon::join(judged, measured);
    let (clipped, metrics) = measured?;
    Ok(Comparison {
        verdict: if is_encoded_otherwise(light.as_ref()) {
            Verdict::Fail
        } else {
            difference.verdict
        },
        size,
        pixels: counted.map_or(size[0] * size[1], |all| all.iter().filter(|one| **one).count()),
        clipped,
        metrics,
        difference,
        codes: light
            .map(|light| CodesCompared { deciphered: light.deciphered, noise: light.noise }),
        mistakes,
        bounces,
    })
}

fn is_encoded_otherwise(light: Option<&LightOfCodes>) -> bool {
    light.is_some_and(|light| light.deciphered.is_another())
}

/// The difference, and what explains it.
fn judged(
    picture: &Side,
    reference: &Side,
    light: Option<&LightOfCodes>,
    counted: Option<&[bool]>,
) -> (DifferenceReport, Vec<Fit>, Option<BouncesOff>) {
    let sample = light.map_or(picture.sample(), LightOfCodes::sample);
    let difference = judge_difference(sample, reference.sample(), counted);
    if difference.verdict != Verdict::Fail || is_encoded_otherwise(light) {
        return (difference, Vec::new(), None);
    }
    let knowledge = Knowledge { alpha: picture.alpha.as_ref(), counted, standard_error: None };
    let (mistakes, bounces) = explanation(&picture.image, reference, &knowledge);
    (difference, mistakes, bounces)
}

/// What turns the reference into the picture: mistakes, or bounces that explain more than they.
fn explanation(
    picture: &Image,
    reference: &Side,
    knowledge: &Knowledge<'_>,
) -> (Vec<Fit>, Option<BouncesOff>) {
    let mistakes = explain(picture, &reference.image, knowledge);
    let most = mistakes.iter().map(|fit| fit.explains).fold(0.0, f64::max);
    let off = bounces_off(picture, &reference.image, &reference.bounces, knowledge);
    match off.filter(|off| off.share.explains > most) {
        Some(off) => (Vec::new(), Some(off)),
        None => (mistakes, None),
    }
}

/// Codes are measured as codes, as every tool for PNG does: both sides as the files have them or, of radiance, as
/// its encoding would make them.
fn metrics(
    picture: &Side,
    reference: &Side,
    question: &Question,
) -> Result<(Option<Clipped>, Vec<Measured>), ImageError> {
    if !picture.is_coded && !reference.is_coded {
        let shown = without_ignored(&picture.image, &reference.image, &question.counted);
        return Ok((None, measured(&Pair::new(&shown, &reference.image)?, question)));
    }
    let [image, reference] =
        [picture, reference].map(|side| codes_of(&side.image, question.encoding));
    let counted = &question.counted;
    let clipped =
        Clipped { image: Ends::of(&image, counted), reference: Ends::of(&reference, counted) };
    let shown = without_ignored(&image, &reference, counted);
    Ok((Some(clipped), measured(&Pair::of_codes(&shown, &reference)?, question)))
}

/// FLIP of each pixel as the metrics have its mean: of codes as they are displayed, of radiance HDR-FLIP.
pub(crate) fn flip_map(
    picture: &Side,
    reference: &Side,
    encoding: Encoding,
) -> Result<Plane, ImageError> {
    if !picture.is_coded && !reference.is_coded {
        return Pair::new(&picture.image, &reference.image)
            .map(|pair| flip::high_dynamic_range_flip(&pair));
    }
    let [image, reference] = [picture, reference].map(|side| codes_of(&side.image, encoding));
    Pair::of_codes(&image, &reference).map(|pair| flip::flip(&pair))
}

/// Codes over the largest, not rounded.
fn codes_of(light: &Image, encoding: Encoding) -> Image {
    let share = |light: f32| encoding.curve.encode(encoding.exposure * f64::from(light));
    #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
    light.map(|pixel| pixel.map(|light| share(light) as f32))
}

/// The picture, with the reference where it is to be ignored.
fn without_ignored<'a>(picture: &'a Image, reference: &Image, counted: &[bool]) -> Cow<'a, Image> {
    let mut shown = Cow::Borrowed(picture);
    if counted.contains(&false) {
        shown.to_mut().paint_over(counted, reference);
    }
    shown
}

fn measured(pair: &Pair<'_>, question: &Question) -> Vec<Measured> {
    let suits = |metric: &&Metric| metric.suits(pair) && (question.slow_metrics || !metric.is_slow);
    let measured = METRICS.iter().filter(suits).map(|metric| {
        let value = metric.measure(pair);
        Measured { name: metric.name, value: (!value.is_nan()).then_some(value) }
    });
    measured.collect()
}

/// Of files of codes, pixels that noise may clip do not count: what is lost above white is no mistake.
/// The law of codes says which those are, where it is known.
fn counted(
    mut counted: Vec<bool>,
    picture: &Side,
    reference: &Side,
    light: Option<&LightOfCodes>,
) -> Vec<bool> {
    if let Some(light) = light {
        counted.iter_mut().zip(&light.compared).for_each(|(counted, says)| *counted &= says);
    } else if picture.is_coded || reference.is_coded {
        let is_safe = |level: &[f32; 3]| level.iter().all(|value| *value < SAFE_FROM_CLIPPING);
        let levels = reference.image.pixels.iter().zip(&mut counted);
        levels.for_each(|(level, counted)| *counted &= is_safe(level));
    }
    counted
}

/// Half a step of the codes, as light, at every value.
fn rounding(loaded: &Loaded, largest: u32) -> Image {
    let half = 0.5 / f64::from(largest);
    let step = |value: f32| {
        let share = loaded.encoding.encode(f64::from(value));
        let light = |share: f64| loaded.encoding.decode(share.clamp(0.0, 1.0));
        #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
        let step = (light(share + half) - light(share - half)) as f32;
        0.5 * step
    };
    loaded.image.map(|pixel| pixel.map(step))
}
