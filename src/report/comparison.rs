//! Images held against one reference, in words: for the terminal and for the page.

use crate::stats::misfit::BouncesOff;
use crate::stats::{
    Clipped, CodesCompared, Comparison, DifferenceReport, Ends, Impossible, Measured, NoiseSource,
    OddPixels, PatternReport, Verdict,
};
use crate::text::number::{count, figure, percent, ratio, signed_percent, significant};
use serde::Serialize;

/// What was compared with what.
#[derive(Debug, Serialize)]
pub(crate) struct Comparisons {
    /// The file of the reference.
    pub(crate) reference: String,
    pub(crate) images: Vec<Compared>,
}

/// One image against the reference.
#[derive(Debug, Serialize)]
pub(crate) struct Compared {
    /// Its file, or those of the renders that it is the mean of.
    pub(crate) files: Vec<String>,
    #[serde(flatten)]
    pub(crate) comparison: Comparison,
}

impl Compared {
    /// What it is called.
    pub(crate) fn name(&self) -> String {
        match &self.files[..] {
            [file] => file.clone(),
            [first, .., last] => format!("mean of {} renders, {first} to {last}", self.files.len()),
            [] => String::new(),
        }
    }
}

/// Every image, its verdict first.
pub(crate) fn told(comparisons: &Comparisons) -> String {
    let one = |compared: &Compared| {
        let (name, words) = (compared.name(), told_of(&compared.comparison));
        format!("{name} against {}\n{words}", comparisons.reference)
    };
    comparisons.images.iter().map(one).collect::<Vec<_>>().join("\n")
}

/// Verdict, evidence and metrics of one image.
pub(crate) fn told_of(comparison: &Comparison) -> String {
    let verdict = format!("{}: {}", comparison.verdict, statement(comparison));
    let evidence = evidence(comparison).into_iter().map(|words| format!("  {words}"));
    let metric = |metric: &Measured| format!("  {:22} {}", metric.name, value(metric));
    let lines = std::iter::once(verdict).chain(evidence);
    lines.chain(comparison.metrics.iter().map(metric)).map(|line| line + "\n").collect()
}

/// What was found besides, a line each.
pub(crate) fn evidence(comparison: &Comparison) -> Vec<String> {
    let difference = &comparison.difference;
    let codes = comparison.codes.iter().map(|codes| by_law(codes, comparison));
    let outliers = difference.outliers.iter().map(outliers);
    let patterns = difference.patterns.iter().filter(|found| found.rejects).map(pattern);
    let mistakes = comparison.mistakes.iter().map(|fit| format!("the image is {fit}"));
    let bounces = comparison.bounces.iter().map(bounces);
    let clipped = comparison.clipped.iter().map(|clipped| clipping(clipped, comparison));
    codes.chain(outliers).chain(patterns).chain(mistakes).chain(bounces).chain(clipped).collect()
}

/// The number of a metric.
pub(crate) fn value(metric: &Measured) -> String {
    metric.value.map_or_else(|| "not a number".to_owned(), |value| significant(value, 6))
}

/// What metrics are of, and how much of it lies at the ends of the codes.
fn clipping(clipped: &Clipped, comparison: &Comparison) -> String {
    let [width, height] = comparison.size;
    let share = |pixels: usize| percent(pixels as f64 / (width * height) as f64);
    let ends =
        |ends: &Ends| format!("{} at black and {} at white", share(ends.black), share(ends.white));
    let judged = match comparison.codes {
        Some(_) => String::new(),
        None => {
            format!("; the test judges {}, bright pixels may be clipped", share(comparison.pixels))
        }
    };
    format!(
        "metrics are of the codes as displayed, clipped pixels included: {} of the image, {} of the \
         reference{judged}",
        ends(&clipped.image),
        ends(&clipped.reference)
    )
}

/// How an 8-bit image was compared, and what is not known of its noise.
fn by_law(codes: &CodesCompared, comparison: &Comparison) -> String {
    let [width, height] = comparison.size;
    let share = percent(comparison.pixels as f64 / (width * height) as f64);
    let noise = match codes.noise {
        NoiseSource::Runs => "noise: measured between the images",
        NoiseSource::Variance => "noise: from the variance image",
        NoiseSource::Scatter => {
            "the noise of the image is unknown: it is estimated from how codes scatter within 8 × 8 \
             pixels, so that errors as small as that count as noise"
        }
    };
    format!(
        "8-bit codes ({}) compared by their distribution, not decoded, in {share} of the pixels; {noise}",
        codes.deciphered.declared
    )
}

fn bounces(off: &BouncesOff) -> String {
    let explains = percent(off.share.explains);
    format!("{off} what the reference holds alone: explains {explains} of the difference")
}

/// What the verdict says.
pub(crate) fn statement(comparison: &Comparison) -> String {
    let difference = &comparison.difference;
    let deciphered = comparison.codes.as_ref().map(|codes| &codes.deciphered);
    if let Some(deciphered) = deciphered.filter(|deciphered| deciphered.is_another()) {
        let found = deciphered.found.unwrap_or(deciphered.declared);
        return format!(
            "encoding mismatch: the codes are {found}, not {}; radiance is not compared",
            deciphered.declared
        );
    }
    let [width, height] = comparison.size;
    if let Some(odd) = difference.impossible {
        return impossible(&odd);
    }
    match comparison.verdict {
        _ if difference.equal => "the images are equal to the last bit".to_owned(),
        Verdict::Inconclusive => {
            let judged = comparison.pixels;
            format!("{judged} pixels to judge, of {width} × {height}, are too few to decide")
        }
        Verdict::Pass => format!(
            "nothing but noise tells them apart; an error of {} of the whole image would \
             have been seen",
            percent(difference.resolution)
        ),
        Verdict::Fail => brightness(difference),
    }
}

fn brightness(difference: &DifferenceReport) -> String {
    format!("the image has {} times the radiance of the reference", ratio(difference.ratio))
}

fn impossible(odd: &OddPixels) -> String {
    let kind = match odd.impossible {
        Some(Impossible::NotANumber) => "NaN",
        Some(Impossible::Infinite) => "infinite",
        _ => "negative",
    };
    format!(
        "{} {kind} or otherwise invalid, the first at ({}, {}) from the top left",
        are(odd.pixels),
        odd.x,
        odd.y
    )
}

/// `1 pixel is`, `5 pixels are`
fn are(pixels: usize) -> String {
    let verb = if pixels == 1 { "is" } else { "are" };
    format!("{} {verb}", count(pixels, "pixel"))
}

fn outliers(odd: &OddPixels) -> String {
    format!(
        "{} darker than noise explains; the worst, at ({}, {}), by {} standard errors",
        are(odd.pixels),
        odd.x,
        odd.y,
        figure(odd.sigmas.unwrap_or(0.0).abs())
    )
}

fn pattern(found: &PatternReport) -> String {
    let place = found.worst.map_or(String::new(), |extent| {
        format!(
            ", most at ({}, {}), {} × {} pixels",
            extent.x, extent.y, extent.width, extent.height
        )
    });
    format!(
        "{} differ{}: {} and {} standard errors in two confirmations{place}",
        found.pattern,
        if found.difference.is_finite() {
            format!(" by {}", signed_percent(found.difference))
        } else {
            String::new()
        },
        figure(found.t[0]),
        figure(found.t[1])
    )
}
