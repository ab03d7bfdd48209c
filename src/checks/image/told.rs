//! What a report on pictures says: in words, in numbers and as a picture.

use crate::checks::{Finding, Measure, RejectedCell, STANDARD_ERRORS};
use crate::image::Image;
use crate::stats::{
    CellScore, Component, GlobalRatio, Hypothesis, ImageReport, Impossible, PARTS, PartRatio,
    Scale, ScaleReport, Verdict,
};
use crate::text::fingerprint;
use crate::text::number::{apart, count, percent, with_interval};

/// Standard errors at the ends of the scale of the error picture.
pub(super) const ERROR_SCALE: f32 = 6.0;

/// Difference over its standard error, core and reference together; ±1 is the end of the scale.
pub(super) fn error_picture(report: &ImageReport, mean: &Image, standard_error: &Image) -> Image {
    Image::from_fn(mean.width, mean.height, |x, y| {
        let pixel = y * mean.width + x;
        std::array::from_fn(|c| {
            let of = |image: &Image| image.pixels[pixel][c];
            let difference = of(&report.mean) - of(mean);
            let noise = of(&report.standard_error).hypot(of(standard_error));
            if noise > 0.0 { difference / noise / ERROR_SCALE } else { 0.0 }
        })
    })
}

/// A picture that nothing is said of but which it is: the same to the last bit, or another.
pub(super) fn glance(image: &Image) -> Finding {
    let bytes = image.pixels.iter().flatten().flat_map(|value| value.to_ne_bytes());
    Finding::of(fingerprint(&bytes.collect::<Vec<_>>()), "", Vec::new())
}

/// What a report says in words and numbers; `hypothesis` is what the ledger enters.
pub(super) fn finding(report: &ImageReport, hypothesis: Option<Hypothesis>) -> Finding {
    let ratios = report.ratios.iter().map(|ratio| ratio_measure(ratio, report, hypothesis));
    let parts = report.parts.iter().map(|part| part_measure(part, report.verdict));
    let scales = report.scales.iter().map(scale_measure);
    let measures = ratios.chain(scales).chain(parts).collect();
    let error = percent(report.resolution);
    let caught = format!("would have caught an error of {error} of the whole picture");
    Finding { verdict: report.verdict, ..Finding::of(statement(report), caught, measures) }
}

/// How bright the whole picture is: what people ask first. Luminance stands for the test of the picture.
fn ratio_measure(
    ratio: &GlobalRatio,
    report: &ImageReport,
    hypothesis: Option<Hypothesis>,
) -> Measure {
    let name = component_name(ratio.component);
    let is_luminance = ratio.component == Component::Luminance;
    Measure {
        interval: Some(ratio.interval),
        resolution: is_luminance.then_some(report.resolution),
        verdict: report.verdict,
        doubt: report.doubt.filter(|_| is_luminance),
        hypothesis: hypothesis.filter(|_| is_luminance),
        ..Measure::exact(name, ratio.ratio, 1.0, 0.0)
            .of_row("brightness of the whole picture")
            .in_unit("of the reference")
    }
}

/// How bright a part of the picture is: where one that failed is wrong, and by how much.
fn part_measure(part: &PartRatio, of_picture: Verdict) -> Measure {
    let PartRatio { column, row, ratio, interval: [low, high] } = *part;
    let name = format!("column {}, row {}", column + 1, row + 1);
    Measure {
        interval: Some([low, high]),
        resolution: None,
        verdict: Verdict::pass_if(of_picture != Verdict::Fail || low <= 1.0 && 1.0 <= high),
        ..Measure::exact(name, ratio, 1.0, 0.0)
            .of_row(format!("brightness of its parts, {PARTS} x {PARTS}"))
            .in_unit("of the reference")
    }
}

/// The most suspicious cell of a scale, or what fresh runs made of the suspicion: only they can fail it.
fn scale_measure(scale: &ScaleReport) -> Measure {
    let worst = scale.worst.first();
    let screened = worst.map_or(0.0, |cell| cell.t);
    let (name, measured) = match scale.confirmations {
        None => (String::new(), screened),
        Some([first, second]) => {
            let weaker = if first.t.abs() < second.t.abs() { first.t } else { second.t };
            (", confirmed on fresh runs".to_owned(), weaker)
        }
    };
    let place = match worst {
        Some(cell) if scale.rejects => format!(" at ({}, {})", cell.extent.x, cell.extent.y),
        _ => String::new(),
    };
    let name = format!("worst {}{place}{name}", scale_name(scale.scale));
    Measure {
        verdict: Verdict::pass_if(!scale.rejects),
        ..Measure::exact(name, measured, 0.0, scale.critical).in_unit(STANDARD_ERRORS)
    }
}

fn statement(report: &ImageReport) -> String {
    if let Some(impossible) = report.impossible {
        let kind = match impossible.kind {
            Impossible::NotANumber => "NaN",
            Impossible::Infinite => "infinite",
            Impossible::Negative => "negative",
        };
        return format!(
            "{} {kind}, the first at ({}, {}) from the top left",
            pixels(impossible.pixels, ["is", "are"]),
            impossible.x,
            impossible.y
        );
    }
    if let Some([x, y]) = report.dead_pixels.first() {
        return format!(
            "{} black in every run, the first at ({x}, {y}) from the top left",
            pixels(report.dead_pixels.len(), ["stays", "stay"])
        );
    }
    match report.worst_scale {
        Some(scale) => format!("{}; {}", brightness(report), confirmed(report, scale)),
        None if report.verdict == Verdict::Pass => {
            format!("agrees with the reference; {}", brightness(report))
        }
        None => format!(
            "not yet known to agree: an error of {} could hide, {} has to be seen",
            percent(report.resolution),
            percent(report.detects)
        ),
    }
}

/// "1 pixel is", "2 pixels are".
fn pixels(number: usize, [one, many]: [&str; 2]) -> String {
    format!("{} {}", count(number, "pixel"), if number == 1 { one } else { many })
}

/// "the picture has 0.991 of the light it should have".
fn brightness(report: &ImageReport) -> String {
    let whole = report.ratios.iter().find(|ratio| ratio.component == Component::Luminance);
    let Some(whole) = whole else { return "the picture is black".to_owned() };
    // Of codes it is an extrapolation, which black ones carry below nothing.
    let share = match whole.ratio <= 0.0 {
        true => "none".to_owned(),
        false => with_interval(whole.ratio, whole.interval),
    };
    format!("the picture has {share} of the light it should have")
}

/// Where fresh runs have confirmed the difference.
fn confirmed(report: &ImageReport, scale: Scale) -> String {
    let cell = report.scales.iter().find(|s| s.scale == scale).and_then(|s| s.worst.first());
    let confirmed = format!("confirmed at the scale of a {}", scale_name(scale));
    let Some(cell) = cell else { return confirmed };
    let [mean, expected] = apart([cell.mean, cell.expected]);
    let (component, [x, y]) = (component_name(cell.component), [cell.extent.x, cell.extent.y]);
    format!("{confirmed}: {component} is {mean} instead of {expected} around pixel ({x}, {y})")
}

/// The cells that the screen suspected, of the scales at which fresh runs confirmed it.
pub(super) fn rejected(report: &ImageReport) -> Vec<RejectedCell> {
    let rejecting = report.scales.iter().filter(|scale| scale.rejects);
    let suspected =
        rejecting.flat_map(|scale| scale.worst.iter().filter(|cell| cell.t.abs() > scale.critical));
    let told = |cell: &CellScore| RejectedCell {
        scale: scale_name(cell.scale).to_owned(),
        component: component_name(cell.component).to_owned(),
        extent: [cell.extent.x, cell.extent.y, cell.extent.width, cell.extent.height],
        measured: cell.mean,
        expected: cell.expected,
        t: cell.t,
        p: cell.p,
    };
    suspected.map(told).collect()
}

const fn scale_name(scale: Scale) -> &'static str {
    match scale {
        Scale::Pixel => "pixel",
        Scale::Tile8 => "tile of 8 x 8",
        Scale::Tile32 => "tile of 32 x 32",
        Scale::Rows => "band of 8 rows",
        Scale::Whole => "whole picture",
    }
}

const fn component_name(component: Component) -> &'static str {
    match component {
        Component::Red => "red",
        Component::Green => "green",
        Component::Blue => "blue",
        Component::Luminance => "luminance",
    }
}
