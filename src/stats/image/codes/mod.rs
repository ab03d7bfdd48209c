//! Whether an 8-bit picture shows what it should: by the law of its codes, never by decoding them.
//!
//! Noise is averaged before a renderer writes a picture, then bent by the curve, rounded and
//! clipped: the mean code is not the code of the mean, and cannot be decoded. With 64 samples of
//! relative deviation 1 a pixel of radiance 0.3 looks 0.4 % darker, one of 0.95 looks 3 % darker,
//! since a third of its pictures clip. The mean of n samples has, nearly, the law of a Gamma
//! variable with the pixel's mean and deviation ([`law::PixelLaw`]); that gives every code's probability.
//!
//! A few pictures tell the noise of every code and how light was encoded. Then the codes are
//! screened and confirmed on fresh pictures like radiance is ([`super::judge_image`]). What a code
//! can say of light is limited: by the reference, by how well the noise is known, by steps that no
//! noise hides, and by the law itself. All that widens the band.
//!
//! Pixels that are clipped in most pictures are not compared; they can only fail for being clipped
//! too seldom. Pixels whose noise is not small against their light say nothing: what they do not
//! show may be clipped. Light that reaches a pixel in fewer pictures than there are is never seen,
//! neither here nor by eye.

mod channel;
mod clipping;
mod decipher;
mod law;
mod light;
mod model;
mod observed;

#[cfg(test)]
mod simulation;
#[cfg(test)]
mod tests;

pub(crate) use clipping::ClippingReport;
pub(crate) use decipher::Deciphered;
pub(crate) use light::{LightOfCodes, NoiseSource, light_of_codes};

use super::draw::Levels;
use super::screening::Screening;
use crate::image::Image;
use crate::image::encoding::Encoding;
use crate::image::png::Picture as Codes;
use crate::stats::law::Spread;
use crate::stats::plan::{Hypothesis, Judgement, Report, TestKind};
use crate::stats::{Compared, ImageDraw, ImageEffort, ImageReport, Stage, Verdict, judge_exact};
use clipping::Clipping;
use decipher::decipher;
use model::Model;
use observed::Observed;

/// Pictures that tell the noise of the codes.
const PILOT_RUNS: u32 = 16;
/// Share of the channels that has to be comparable.
const FEWEST_COMPARED: f64 = 0.5;

/// What a picture should show, and how well that is known.
#[derive(Clone, Copy, Debug)]
pub struct CodeReference<'a> {
    /// Mean radiance.
    pub(crate) mean: &'a Image,
    pub(crate) standard_error: &'a Image,
    /// Samples a pixel behind it, if that is known: from them follows how noisy a picture with fewer
    /// is, whether or not its codes show it.
    pub(crate) samples: Option<u64>,
}

impl CodeReference<'_> {
    /// How many times noisier a pixel of a picture with so many samples is; 0 if that is not known.
    fn noise_share(&self, samples: Option<u32>) -> f64 {
        let share = |(more, fewer): (u64, u32)| (more as f64 / f64::from(fewer)).sqrt();
        self.samples.zip(samples).map_or(0.0, share)
    }
}

/// How pictures are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodeSettings {
    pub(crate) declared: Encoding,
    /// What has to be seen, and on how many pictures.
    pub(crate) effort: ImageEffort,
}

/// The judgement of 8-bit pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeReport {
    pub(crate) verdict: Verdict,
    pub(crate) deciphered: Deciphered,
    /// Cells of codes; relative errors are those of the light behind them. None if the encoding is
    /// another than declared: nothing can be compared then.
    pub(crate) image: Option<ImageReport>,
    /// None where nothing should be clipped.
    pub(crate) clipping: Option<ClippingReport>,
    /// Share of the channels of all pixels whose codes are compared.
    pub(crate) compared: f64,
    /// The codes that there should be on average, where they are compared; 0 elsewhere.
    pub(crate) expected: Image,
}

impl Report for CodeReport {
    /// The luminance of the whole picture, as far as codes tell it; where they are encoded otherwise
    /// than declared, that this is so once and not never.
    fn judgement(&self) -> Judgement {
        let suspected = self.image.as_ref().is_some_and(ImageReport::suspected);
        let hypothesis = Some(Hypothesis::new(TestKind::Codes, suspected));
        let mismatch = Compared::within(1.0, 0.0, 0.0);
        let judgement = match &self.image {
            Some(image) => image.judgement(),
            None => judge_exact([mismatch]).judgement(),
        };
        Judgement { verdict: self.verdict, hypothesis, ..judgement }
    }
}

/// Judges the pictures that `draw` renders and encodes against a reference of the same size.
/// Pictures of [`Stage::Pilot`] come first.
///
/// # Panics
///
/// If a picture has another size than the reference.
pub(crate) fn judge_codes<E>(
    reference: CodeReference<'_>,
    settings: &CodeSettings,
    draw: &mut dyn FnMut(ImageDraw) -> Result<Codes, E>,
) -> Result<CodeReport, E> {
    judge_codes_at(Levels::DEFAULT, reference, settings, draw)
}

/// The same at other levels, so that calibration can be simulated.
fn judge_codes_at<E>(
    levels: Levels,
    reference: CodeReference<'_>,
    settings: &CodeSettings,
    draw: &mut dyn FnMut(ImageDraw) -> Result<Codes, E>,
) -> Result<CodeReport, E> {
    let observed = pilot(draw)?;
    let deciphered = decipher(reference, &observed, settings.declared);
    if deciphered.is_another() {
        return Ok(CodeReport {
            verdict: Verdict::Fail,
            deciphered,
            image: None,
            clipping: None,
            compared: 0.0,
            expected: Image::default(),
        });
    }
    let model = Model::new(reference, &observed, settings.declared, Some(settings.effort.samples));
    let mut clipping = Clipping::new(&model.channels, levels);
    let mut codes = |request: ImageDraw| {
        let picture = draw(request)?;
        let codes = model.codes_of(&picture);
        clipping.take(request.stage, codes);
        Ok(vec![model.compared(|index| f64::from(codes[index]))])
    };
    let expected = model.image(|channel| channel.expected);
    let screening = Screening::new(model.target(), &expected, &settings.effort, &mut codes);
    let image = screening.at(levels).judge()?;
    if image.verdict != Verdict::Fail {
        clipping.confirm(&settings.effort, draw)?;
    }
    let (clipping, compared) = (clipping.report(), model.share_compared());
    let verdict = match image.verdict {
        _ if clipping.is_some_and(|clipping| clipping.rejects) => Verdict::Fail,
        Verdict::Pass if compared < FEWEST_COMPARED => Verdict::Inconclusive,
        verdict => verdict,
    };
    Ok(CodeReport { verdict, deciphered, image: Some(image), clipping, compared, expected })
}

/// Mean and spread of every code over a few pictures.
fn pilot<E>(draw: &mut dyn FnMut(ImageDraw) -> Result<Codes, E>) -> Result<Observed, E> {
    let mut spread = Spread::default();
    for run in 0..PILOT_RUNS {
        let picture = draw(ImageDraw { stage: Stage::Pilot, run })?;
        let codes: Vec<f64> =
            picture.pixels.as_flattened().iter().copied().map(f64::from).collect();
        spread.push(&codes);
    }
    Ok(Observed::of_runs(&spread))
}
