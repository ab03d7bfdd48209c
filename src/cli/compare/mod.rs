//! `furnace compare`: whether an image shows what another shows, and if not, which mistake turns one into the other.

mod side;
mod words;

use super::say::{say, say_line};
use super::{Answer, ExitCode, Failure};
use crate::image::ImageError;
use crate::image::encoding::{Curve, Encoding, Rounding};
use crate::image::file::load;
use crate::image::mask::{Mask, Rectangle};
use crate::stats::{Comparison, Question, Side, Verdict};
use clap::Args;
use side::encoding;
use std::path::PathBuf;

/// What `furnace compare` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct CompareArguments {
    /// Images (EXR, PFM, HDR, PNG); the last is the reference. Several before it are independent
    /// renders of one image, whose mean and variance are taken.
    #[arg(required = true, num_args = 2.., value_name = "PICTURE")]
    pictures: Vec<PathBuf>,
    /// Transfer function of PNG files: srgb, linear, or a gamma such as 2.2.
    #[arg(long, value_parser = encoding, default_value = "srgb")]
    encoding: Curve,
    /// PNG codes were truncated, not rounded.
    #[arg(long)]
    truncated: bool,
    /// An image with the per-pixel variance of the first.
    #[arg(long, value_name = "FILE")]
    variance: Option<PathBuf>,
    /// The same for the reference; an EXR with se.R, se.G and se.B needs none.
    #[arg(long, value_name = "FILE")]
    reference_variance: Option<PathBuf>,
    /// A mask: pixels that are black in it are ignored.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Pixels to ignore: first column, first row from the top, columns, rows.
    #[arg(long, value_name = "X,Y,W,H", value_parser = rectangle)]
    ignore: Vec<Rectangle>,
    /// Leave out FLIP, which takes longest.
    #[arg(long)]
    no_flip: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

impl CompareArguments {
    fn encoding(&self) -> Encoding {
        let rounding = if self.truncated { Rounding::Down } else { Rounding::Nearest };
        Encoding { rounding, ..Encoding::of(self.encoding) }
    }
}

pub(crate) fn compare(arguments: &CompareArguments) -> Answer {
    let comparison = measure(arguments)?;
    if arguments.json {
        say_line!("{}", serde_json::to_string_pretty(&comparison).map_err(Failure::broken)?);
    } else {
        say!("{}", words::told(&comparison));
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
    let question = Question {
        encoding: arguments.encoding(),
        counted: counted(arguments, reference.size()).map_err(Failure::request)?,
        slow_metrics: !arguments.no_flip,
    };
    crate::stats::compare(&picture, &reference, question).map_err(Failure::request)
}

fn picture(arguments: &CompareArguments) -> Result<Side, Failure> {
    let (_, runs) = arguments.pictures.split_last().ok_or_else(nothing)?;
    side::of_runs(runs, arguments.encoding, arguments.variance.as_deref())
}

fn reference(arguments: &CompareArguments) -> Result<Side, Failure> {
    let (reference, _) = arguments.pictures.split_last().ok_or_else(nothing)?;
    let variance = arguments.reference_variance.as_deref();
    side::of_runs(std::slice::from_ref(reference), arguments.encoding, variance)
}

fn nothing() -> Failure {
    Failure::request("two images are needed")
}

/// Whether each pixel counts, as far as that is asked.
fn counted(arguments: &CompareArguments, size: [usize; 2]) -> Result<Vec<bool>, ImageError> {
    let mut counted = Mask::of_rectangles(&arguments.ignore).counted(size)?;
    if let Some(path) = &arguments.mask {
        let drawn = Mask::from_picture(&load(path, None)?.image).counted(size)?;
        counted.iter_mut().zip(drawn).for_each(|(counted, drawn)| *counted &= drawn);
    }
    Ok(counted)
}

fn rectangle(text: &str) -> Result<Rectangle, String> {
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers = numbers.map_err(|error| error.to_string())?;
    numbers.try_into().map_err(|_| "four numbers: X,Y,W,H".to_owned())
}

#[cfg(test)]
mod tests;
