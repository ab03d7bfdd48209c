//! `furnace compare`: whether a picture shows what another shows, and if not, which mistake turns
//! one into the other.

mod side;
mod words;

use super::{Answer, ExitCode, Failure};
use crate::image::encoding::{Curve, Encoding, Rounding};
use crate::image::mask::{Mask, Rectangle};
use crate::image::metric::METRICS;
use crate::image::pair::Pair;
use crate::image::{Image, ImageError};
use crate::stats::misfit::{BouncesOff, Fit, Knowledge, bounces_off, explain};
use crate::stats::{
    Deciphered, DifferenceReport, LightOfCodes, NoiseSource, Verdict, judge_difference,
};
use clap::Args;
use serde::Serialize;
use side::{Side, encoding};
use std::borrow::Cow;
use std::path::PathBuf;

/// What `furnace compare` understands.
#[derive(Clone, Debug, Args)]
pub struct CompareArguments {
    /// Pictures (EXR, PFM, HDR, PNG); the last is the reference. Several before it are independent
    /// renders of one picture, whose mean and variance are taken.
    #[arg(required = true, num_args = 2.., value_name = "PICTURE")]
    pictures: Vec<PathBuf>,
    /// How PNG stands for light: srgb, linear, or a gamma such as 2.2.
    #[arg(long, value_parser = encoding, default_value = "srgb")]
    encoding: Curve,
    /// PNG holds codes whose fractions were cut off, not rounded.
    #[arg(long)]
    truncated: bool,
    /// A picture of the variance of every value of the first.
    #[arg(long, value_name = "FILE")]
    variance: Option<PathBuf>,
    /// The same of the reference; an EXR with se.R, se.G and se.B needs none.
    #[arg(long, value_name = "FILE")]
    reference_variance: Option<PathBuf>,
    /// A picture that is black where pixels do not count.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Pixels that do not count: first column, first row from the top, columns, rows.
    #[arg(long, value_name = "X,Y,W,H", value_parser = rectangle)]
    ignore: Vec<Rectangle>,
    /// Leave out FLIP, which takes longest.
    #[arg(long)]
    no_flip: bool,
    /// Answer in JSON.
    #[arg(long)]
    json: bool,
}

/// All that a comparison found out.
#[derive(Debug, Serialize)]
struct Comparison {
    verdict: Verdict,
    size: [usize; 2],
    /// Pixels that count.
    pixels: usize,
    difference: DifferenceReport,
    /// How the codes of an 8-bit picture were compared, if it could be done by their law.
    codes: Option<CodesCompared>,
    /// What turns the reference into the picture, the greatest mistake first.
    mistakes: Vec<Fit>,
    /// Bounces that are missing or there too often, if the reference holds its bounces apart and that
    /// explains more than any mistake.
    bounces: Option<BouncesOff>,
    metrics: Vec<Measured>,
}

/// What was done with codes.
#[derive(Debug, Serialize)]
struct CodesCompared {
    deciphered: Deciphered,
    /// Where the noise of the picture is known from.
    noise: NoiseSource,
}

#[derive(Debug, Serialize)]
struct Measured {
    name: &'static str,
    /// None where a pixel is no number.
    value: Option<f64>,
}

impl CompareArguments {
    /// How codes are said to be made.
    fn encoding(&self) -> Encoding {
        let rounding = if self.truncated { Rounding::Down } else { Rounding::Nearest };
        Encoding { rounding, ..Encoding::of(self.encoding) }
    }
}

/// Compares, and says how it went.
pub fn compare(arguments: &CompareArguments) -> Answer {
    let comparison = measure(arguments)?;
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&comparison).map_err(Failure::broken)?);
    } else {
        print!("{}", words::told(&comparison));
    }
    Ok(match comparison.verdict {
        Verdict::Pass => ExitCode::Good,
        Verdict::Fail => ExitCode::Failed,
        Verdict::Inconclusive => ExitCode::Broken,
    })
}

fn measure(arguments: &CompareArguments) -> Result<Comparison, Failure> {
    let (picture, reference) = rayon::join(|| picture(arguments), || reference(arguments));
    let (picture, reference) = (picture?, reference?);
    let size = [reference.image.width, reference.image.height];
    if !picture.image.same_size(&reference.image) {
        let sizes = [[picture.image.width, picture.image.height], size];
        return Err(Failure::request(ImageError::DifferentSizes { sizes }));
    }
    let light =
        picture.light_against(&reference, arguments.encoding(), arguments.variance.is_some());
    let counted = counted(arguments, &picture, &reference, light.as_ref())?;
    let is_encoded_otherwise = light.as_ref().is_some_and(|light| light.deciphered.is_another());
    let judged = || {
        let sample = light.as_ref().map_or(picture.sample(), side::sample_of);
        let difference = judge_difference(sample, reference.sample(), counted.as_deref());
        let is_to_explain = difference.verdict == Verdict::Fail && !is_encoded_otherwise;
        let knowledge = Knowledge {
            alpha: picture.alpha.as_ref(),
            counted: counted.as_deref(),
            standard_error: None,
        };
        let explained = || explanation(&picture.image, &reference, &knowledge);
        (difference, is_to_explain.then(explained).unwrap_or_default())
    };
    let measured = || metrics(arguments, &picture.image, &reference.image, counted.as_deref());
    let ((difference, (mistakes, bounces)), metrics) = rayon::join(judged, measured);
    Ok(Comparison {
        verdict: if is_encoded_otherwise { Verdict::Fail } else { difference.verdict },
        size,
        pixels: counted.map_or(size[0] * size[1], |all| all.iter().filter(|one| **one).count()),
        metrics: metrics?,
        difference,
        codes: light
            .map(|light| CodesCompared { deciphered: light.deciphered, noise: light.noise }),
        mistakes,
        bounces,
    })
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

/// The metrics that are asked for, of the pixels that count.
fn metrics(
    arguments: &CompareArguments,
    picture: &Image,
    reference: &Image,
    counted: Option<&[bool]>,
) -> Result<Vec<Measured>, Failure> {
    let mut shown = Cow::Borrowed(picture);
    if let Some(counted) = counted {
        shown.to_mut().paint_over(counted, reference);
    }
    let pair = Pair::new(&shown, reference).map_err(Failure::request)?;
    let asked = METRICS.iter().filter(|metric| !(arguments.no_flip && metric.is_slow));
    let measured = asked.map(|metric| {
        let value = metric.measure(&pair);
        Measured { name: metric.name, value: (!value.is_nan()).then_some(value) }
    });
    Ok(measured.collect())
}

fn picture(arguments: &CompareArguments) -> Result<Side, Failure> {
    let (_, runs) = arguments.pictures.split_last().ok_or_else(nothing)?;
    Side::of_runs(runs, arguments.encoding, arguments.variance.as_deref())
}

fn reference(arguments: &CompareArguments) -> Result<Side, Failure> {
    let (reference, _) = arguments.pictures.split_last().ok_or_else(nothing)?;
    let variance = arguments.reference_variance.as_deref();
    Side::of_runs(std::slice::from_ref(reference), arguments.encoding, variance)
}

fn nothing() -> Failure {
    Failure::request("two pictures are needed")
}

/// The pixels that count, if not all do. Of files of codes, those that noise may clip do not: what
/// is lost above white is no mistake. The law of codes says which those are, where it is known.
fn counted(
    arguments: &CompareArguments,
    picture: &Side,
    reference: &Side,
    light: Option<&LightOfCodes>,
) -> Result<Option<Vec<bool>>, Failure> {
    let size = [reference.image.width, reference.image.height];
    let mut counted = Mask::of_rectangles(&arguments.ignore).counted(size);
    if let (Some(path), Ok(counted)) = (&arguments.mask, &mut counted) {
        let mask = crate::image::file::load(path, None).map_err(Failure::request)?;
        let drawn = Mask::from_picture(&mask.image).counted(size).map_err(Failure::request)?;
        counted.iter_mut().zip(drawn).for_each(|(counted, drawn)| *counted &= drawn);
    }
    let mut counted = counted.map_err(Failure::request)?;
    if let Some(light) = light {
        counted.iter_mut().zip(&light.compared).for_each(|(counted, says)| *counted &= says);
    } else if picture.is_coded || reference.is_coded {
        let levels = reference.image.pixels.iter().zip(&mut counted);
        levels.for_each(|(level, counted)| *counted &= side::is_safe_from_clipping(*level));
    }
    Ok(counted.contains(&false).then_some(counted))
}

fn rectangle(text: &str) -> Result<Rectangle, String> {
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers = numbers.map_err(|error| error.to_string())?;
    numbers.try_into().map_err(|_| "four numbers: X,Y,W,H".to_owned())
}

#[cfg(test)]
mod tests;
