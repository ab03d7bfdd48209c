//! A comparison as text.

use super::Comparison;
use crate::stats::{DifferenceReport, Impossible, OddPixels, PatternReport, Verdict};
use std::fmt::Write;

/// What is printed.
pub(super) fn told(comparison: &Comparison) -> String {
    let mut text = format!("{}: {}\n", comparison.verdict, sentence(comparison));
    // Writing into a string cannot fail.
    let mut line = |words: String| {
        let _ = writeln!(text, "  {words}");
    };
    let difference = &comparison.difference;
    difference.outliers.iter().for_each(|odd| line(outliers(odd)));
    difference.patterns.iter().filter(|found| found.rejects).for_each(|found| line(pattern(found)));
    comparison.mistakes.iter().for_each(|fit| line(format!("the picture is {fit}")));
    for metric in &comparison.metrics {
        match metric.value {
            Some(value) => line(format!("{:22} {value:.6}", metric.name)),
            None => line(format!("{:22} no number", metric.name)),
        }
    }
    text
}

fn sentence(comparison: &Comparison) -> String {
    let difference = &comparison.difference;
    let [width, height] = comparison.size;
    if let Some(odd) = difference.impossible {
        return impossible(&odd);
    }
    match comparison.verdict {
        _ if difference.equal => "the pictures are equal to the last bit".to_owned(),
        Verdict::Inconclusive => {
            format!("{width} × {height} pixels are too few to prove anything")
        }
        Verdict::Pass => format!(
            "nothing but noise tells them apart; an error of {:.2} % of the whole picture would \
             have been seen",
            100.0 * difference.resolution
        ),
        Verdict::Fail => brightness(difference),
    }
}

fn brightness(difference: &DifferenceReport) -> String {
    format!("the picture has {:.4} of the light of the reference", difference.ratio)
}

fn impossible(odd: &OddPixels) -> String {
    let kind = match odd.impossible {
        Some(Impossible::NotANumber) => "NaN",
        Some(Impossible::Infinite) => "infinite",
        _ => "negative",
    };
    format!(
        "{} pixels are {kind} or as wrong, the first at ({}, {}) from the top left",
        odd.pixels, odd.x, odd.y
    )
}

fn outliers(odd: &OddPixels) -> String {
    format!(
        "{} pixels are darker than noise makes them; the farthest, at ({}, {}), by {:.1} standard errors",
        odd.pixels,
        odd.x,
        odd.y,
        odd.sigmas.unwrap_or(0.0).abs()
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
        "{} differ{}: {:.1} and {:.1} standard errors in two confirmations{place}",
        found.pattern,
        if found.difference.is_finite() {
            format!(" by {:+.2} %", 100.0 * found.difference)
        } else {
            String::new()
        },
        found.t[0],
        found.t[1]
    )
}
