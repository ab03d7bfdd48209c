//! `furnace compare`: whether images show what another shows, and if not, which mistake turns one into the other.

mod side;

use super::inline;
use super::say::{complain, say, say_line};
use super::{Answer, ExitCode, Failure};
use crate::image::ImageError;
use crate::image::encoding::{Curve, Encoding, Rounding};
use crate::image::file::load;
use crate::image::mask::{Mask, Rectangle};
use crate::report::comparison::{Compared, Comparisons, told};
use crate::report::html::comparison::{Page, Pixels};
use crate::report::html::develop::Shows;
use crate::stats::{Question, Side, Verdict, flip_map};
use clap::Args;
use side::encoding;
use std::path::{Path, PathBuf};

/// What `furnace compare` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct CompareArguments {
    /// Images (EXR, PFM, HDR, PNG); the last is the reference, and each of the others is compared with it.
    #[arg(required = true, num_args = 2.., value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// The images before the reference are independent renders of one image: compare their mean,
    /// with the noise that they tell.
    #[arg(long)]
    renders: bool,
    /// Transfer function of PNG files: srgb, linear, or a gamma such as 2.2.
    #[arg(long, value_parser = encoding, default_value = "srgb")]
    encoding: Curve,
    /// PNG codes were truncated, not rounded.
    #[arg(long)]
    truncated: bool,
    /// An image with the per-pixel variance of an image; once for each, in their order.
    #[arg(long, value_name = "FILE")]
    variance: Vec<PathBuf>,
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
    /// Write a page with the images, their errors and all numbers in the viewer of the report.
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
}

impl CompareArguments {
    fn encoding(&self) -> Encoding {
        let rounding = if self.truncated { Rounding::Down } else { Rounding::Nearest };
        Encoding { rounding, ..Encoding::of(self.encoding) }
    }
}

pub(crate) fn compare(arguments: &CompareArguments) -> Answer {
    let (comparisons, sides) = measure(arguments)?;
    if !arguments.json {
        show(&sides);
    }
    if let Some(path) = &arguments.html {
        page(arguments, &comparisons, sides)?.write(path).map_err(Failure::broken)?;
        complain(format_args!("page   {}", path.display()));
    }
    if arguments.json {
        say_line!("{}", serde_json::to_string_pretty(&comparisons).map_err(Failure::broken)?);
    } else {
        say!("{}", told(&comparisons));
    }
    let verdicts: Vec<_> = comparisons.images.iter().map(|one| one.comparison.verdict).collect();
    Ok(match () {
        () if verdicts.contains(&Verdict::Fail) => ExitCode::Failed,
        () if verdicts.contains(&Verdict::Inconclusive) => ExitCode::Broken,
        () => ExitCode::Good,
    })
}

/// What was compared, once it is read.
struct Sides {
    images: Vec<Side>,
    reference: Side,
}

fn measure(arguments: &CompareArguments) -> Result<(Comparisons, Sides), Failure> {
    let named = named(arguments)?;
    let reference = named.reference.read(arguments.encoding)?;
    let question = Question {
        encoding: arguments.encoding(),
        counted: counted(arguments, reference.size()).map_err(Failure::request)?,
        slow_metrics: !arguments.no_flip,
    };
    let compared = named.images.iter().map(|image| {
        let side = image.read(arguments.encoding)?;
        let comparison = crate::stats::compare(&side, &reference, question.clone());
        let comparison = comparison.map_err(|error| image.cannot(&error))?;
        Ok((Compared { files: image.names(), comparison }, side))
    });
    let compared = compared.collect::<Result<Vec<_>, Failure>>()?;
    let (compared, images) = compared.into_iter().unzip();
    let comparisons = Comparisons { reference: named.reference.names().concat(), images: compared };
    Ok((comparisons, Sides { images, reference }))
}

/// The images and the reference, on a terminal that can show them.
fn show(sides: &Sides) {
    let images = sides.images.iter().map(|side| (side.image(), Shows::Render));
    let reference = [(sides.reference.image(), Shows::Reference)];
    inline::show(&images.chain(reference).collect::<Vec<_>>());
}

/// The page of what was compared.
fn page<'a>(
    arguments: &CompareArguments,
    comparisons: &'a Comparisons,
    sides: Sides,
) -> Result<Page<'a>, Failure> {
    let Sides { images, reference } = sides;
    let pixels = |side: &Side, flip| Pixels {
        image: side.image().clone(),
        standard_error: side.standard_error(),
        flip,
        is_coded: side.is_coded(),
    };
    let flip = |side: &Side| {
        let wanted = !arguments.no_flip;
        wanted.then(|| flip_map(side, &reference, arguments.encoding())).transpose()
    };
    let images = images.iter().map(|side| Ok(pixels(side, flip(side).map_err(Failure::request)?)));
    let images = images.collect::<Result<_, Failure>>()?;
    let words = std::env::args().skip(1).map(|word| shell_words::quote(&word).into_owned());
    let command = std::iter::once("furnace".to_owned()).chain(words).collect::<Vec<_>>().join(" ");
    Ok(Page { comparisons, images, reference: pixels(&reference, None), command })
}

/// The files of every side, before any is read.
struct Named<'a> {
    images: Vec<Files<'a>>,
    reference: Files<'a>,
}

/// One image, or renders of one, and its variance if it is given.
struct Files<'a> {
    renders: &'a [PathBuf],
    variance: Option<&'a Path>,
}

impl Files<'_> {
    fn read(&self, encoding: Curve) -> Result<Side, Failure> {
        side::of_runs(self.renders, encoding, self.variance)
    }

    fn names(&self) -> Vec<String> {
        self.renders.iter().map(|path| path.display().to_string()).collect()
    }

    fn cannot(&self, error: &ImageError) -> Failure {
        Failure::request(format!("cannot compare {}: {error}", self.names().join(", ")))
    }
}

fn named(arguments: &CompareArguments) -> Result<Named<'_>, Failure> {
    let CompareArguments { images, variance, .. } = arguments;
    let (reference, images) =
        images.split_last().ok_or_else(|| Failure::request("two images are needed"))?;
    let sides: Vec<&[PathBuf]> =
        if arguments.renders { vec![images] } else { images.chunks(1).collect() };
    if !variance.is_empty() && variance.len() != sides.len() {
        return Err(Failure::request(format!(
            "--variance stands {} times for {} images: give one for each image before the reference, in \
             their order",
            variance.len(),
            sides.len()
        )));
    }
    let files = sides.into_iter().enumerate().map(|(number, renders)| Files {
        renders,
        variance: variance.get(number).map(PathBuf::as_path),
    });
    let reference = Files {
        renders: std::slice::from_ref(reference),
        variance: arguments.reference_variance.as_deref(),
    };
    Ok(Named { images: files.collect(), reference })
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
mod codes;
#[cfg(test)]
mod tests;
