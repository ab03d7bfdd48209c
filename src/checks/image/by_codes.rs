//! Pictures of 8 bits against a reference: what the law of their codes says.

use super::conventions::regarded;
use super::shot::Setup;
use super::told::{error_picture, finding};
use crate::cause::image;
use crate::checks::{CheckError, Context, Finding, Measure, PictureRole};
use crate::image::Image;
use crate::image::encoding::{Encoding, WHITE};
use crate::image::png::Picture as Codes;
use crate::stats::{
    CodeReference, CodeReport, CodeSettings, Deciphered, ImageDraw, Report, Verdict, judge_codes,
};
use crate::text::number::{figure, percent};

/// A finding, and what it was made of.
pub(super) struct Judged {
    finding: Finding,
    report: CodeReport,
    declared: Encoding,
}

/// Judges the codes that `draw` renders.
pub(super) fn judge(
    setup: &Setup,
    declared: Encoding,
    draw: &mut dyn FnMut(ImageDraw) -> Result<Codes, CheckError>,
) -> Result<Judged, CheckError> {
    let reference = CodeReference {
        mean: &setup.reference.mean,
        standard_error: &setup.reference.standard_error,
        samples: Some(setup.reference.provenance.samples_per_pixel()),
    };
    let settings = CodeSettings { declared, effort: setup.effort };
    let report = judge_codes(reference, &settings, draw)?;
    let finding = match &report.image {
        Some(image) => regarded(found(&report), image, &setup.differing),
        None => found(&report),
    };
    Ok(Judged { finding, report, declared })
}

impl Judged {
    /// The finding, with its pictures in the report.
    pub(super) fn shown(self, setup: &Setup, context: &mut Context<'_>) -> Finding {
        context.show(PictureRole::Reference, "Mitsuba", setup.reference.mean.clone());
        if let Some(image) = &self.report.image {
            let caption = format!(
                "mean code of {} runs of {} samples per pixel, as light: black where codes say nothing, and \
                 darker than the reference where noise is bent",
                image.runs, setup.shot.samples
            );
            context.show(PictureRole::Render, caption, as_light(&image.mean, self.declared));
            let exact = Image::new(image.mean.width, image.mean.height, [0.0; 3]);
            let error = error_picture(image, &self.report.expected, &exact);
            let caption = "codes off, 6 standard errors at the ends";
            context.show(PictureRole::SignedError, caption, error);
        }
        self.finding
    }
}

/// What light mean codes would stand for.
#[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
fn as_light(codes: &Image, encoding: Encoding) -> Image {
    let light = |code: f32| {
        let share = f64::from(code) / WHITE;
        (encoding.curve.decode(share) / encoding.exposure) as f32
    };
    let pixels = codes.pixels.iter().map(|pixel| pixel.map(light)).collect();
    Image { pixels, ..*codes }
}

fn found(report: &CodeReport) -> Finding {
    let Some(image) = &report.image else { return mismatch(report) };
    let mut finding = finding(image, report.judgement().hypothesis);
    finding.verdict = report.verdict;
    let compared = percent(report.compared);
    finding.statement = format!("in codes ({}): {}", report.deciphered.declared, finding.statement);
    if image.verdict != report.verdict && report.verdict == Verdict::Inconclusive {
        finding.statement = format!(
            "only {compared} of the channels can be compared; the others are clipped or too noisy"
        );
    }
    finding.resolution += &format!(", by the codes of {compared} of the channels");
    if let Some(clipping) = report.clipping {
        if clipping.rejects {
            finding.statement += &format!(
                "; of {} channels that are brighter than white, {} are clipped and not {}",
                clipping.channels,
                percent(clipping.share),
                percent(clipping.expected)
            );
        }
        finding.measures.push(Measure {
            verdict: Verdict::pass_if(!clipping.rejects),
            ..Measure::exact("clipped, of what should be", clipping.share, clipping.expected, 0.0)
        });
    }
    finding
}

/// The codes are made in another way than declared: nothing can be said of the light.
fn mismatch(report: &CodeReport) -> Finding {
    let deciphered = &report.deciphered;
    let found = deciphered.found.unwrap_or(deciphered.declared);
    let evidence = format!(
        "the codes of {} tiles are {found}, and not {}{}{}",
        deciphered.tiles,
        deciphered.declared,
        number(", they follow light to the power", deciphered.power),
        number("; with the gain that suits best they lie off by a constant", deciphered.offset),
    );
    let cause = cause_of(deciphered);
    let statement = format!("encoding mismatch, nothing is said of the light: {evidence}");
    let measure = Measure::of("encodings other than declared", report);
    Finding::of(statement, "", vec![measure]).because(cause, evidence)
}

fn cause_of(deciphered: &Deciphered) -> &'static crate::cause::Cause {
    match deciphered.is_rounded_otherwise() {
        true => &image::ROUNDED_OTHERWISE,
        false => &image::ENCODED_OTHERWISE,
    }
}

fn number(words: &str, value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{words} {}", figure(value)))
}
