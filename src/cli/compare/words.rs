//! A comparison as text.

use crate::stats::misfit::BouncesOff;
use crate::stats::{
    CodesCompared, Comparison, DifferenceReport, Impossible, NoiseSource, OddPixels, PatternReport,
    Verdict,
};
use crate::text::number::{figure, percent, ratio, signed_percent, significant};
use std::fmt::Write;

pub(super) fn told(comparison: &Comparison) -> String {
    let mut text = format!("{}: {}\n", comparison.verdict, sentence(comparison));
    // Writing into a string cannot fail.
    let mut line = |words: String| {
        let _ = writeln!(text, "  {words}");
    };
    let difference = &comparison.difference;
    comparison.codes.iter().for_each(|codes| line(by_law(codes, comparison)));
    difference.outliers.iter().for_each(|odd| line(outliers(odd)));
    difference.patterns.iter().filter(|found| found.rejects).for_each(|found| line(pattern(found)));
    comparison.mistakes.iter().for_each(|fit| line(format!("the image is {fit}")));
    comparison.bounces.iter().for_each(|off| line(bounces(off)));
    for metric in &comparison.metrics {
        match metric.value {
            Some(value) => line(format!("{:22} {}", metric.name, significant(value, 6))),
            None => line(format!("{:22} not a number", metric.name)),
        }
    }
    text
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

fn sentence(comparison: &Comparison) -> String {
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
            format!("{width} × {height} pixels are too few to decide")
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
        "{} pixels are {kind} or otherwise invalid, the first at ({}, {}) from the top left",
        odd.pixels, odd.x, odd.y
    )
}

fn outliers(odd: &OddPixels) -> String {
    format!(
        "{} pixels are darker than noise explains; the worst, at ({}, {}), by {} standard errors",
        odd.pixels,
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
