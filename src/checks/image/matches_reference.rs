//! A render against a Mitsuba reference, with the noise of both in the account.

use super::{by_codes, clues};
use crate::checks::{Check, CheckError, Context, Finding, Measure, PictureRole, camera_of, check};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, DirectSampling, Film, IntegratorSettings,
    RenderSettings,
};
use crate::image::Image;
use crate::image::encoding::Encoding;
use crate::image::png::Picture;
use crate::math::rng::Seed;
use crate::scene::reference::{self, Reference};
use crate::scene::{Camera, SceneDescription};
use crate::stats::{
    self, Component, GlobalRatio, Hypothesis, ImageEffort, ImageReport, Impossible, Report, Scale,
    ScaleReport, Verdict, judge_image,
};
use crate::text::number::{apart, percent, with_interval};
use crate::text::{Between, Bounces, Percent};
use std::sync::Arc;

/// Standard errors at the ends of the scale of the error picture.
const ERROR_SCALE: f32 = 6.0;

check! {
    /// Independent renders agree with a reference, at every scale from a pixel to the whole picture.
    pub(crate) struct MatchesReference {
        /// The folder below `references/`.
        reference: String,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        /// Of each run, at the default budget.
        samples_per_pixel: Between<1, 65536>,
        /// The error of the whole picture that must be seen.
        detects: Percent,
    }
    name: "matches-reference",
    summary: "independent renders against a Mitsuba reference, at every scale",
}

impl Check for MatchesReference {
    fn needs_besides(&self) -> Capabilities {
        self.needs_beside(Capabilities::RENDER)
    }

    fn needs_instead(&self) -> Option<Capabilities> {
        Some(self.needs_beside(Capabilities::RENDER_CODES))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        match context.info.capabilities.contains(Capabilities::RENDER) {
            true => self.by_radiance(context),
            false => self.by_codes(context),
        }
    }
}

impl MatchesReference {
    fn needs_beside(&self, picture: Capabilities) -> Capabilities {
        let mut needs = Capabilities::BUILD_SCENE | picture;
        if self.direct == DirectSampling::Hemisphere {
            needs |= Capabilities::HEMISPHERE_SAMPLING;
        }
        if self.bounces.0[0] > 0 {
            needs |= Capabilities::ISOLATED_BOUNCES;
        }
        needs
    }

    /// The reference, and how the core is asked for the same.
    pub(super) fn setup(&self, context: &Context<'_>) -> Result<Setup<'_>, CheckError> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let reference = reference::load(context.references, &self.reference, &scene)
            .map_err(|error| CheckError::Broken(error.to_string()))?;
        if reference.provenance.bounces != self.bounces.0 {
            return Err(CheckError::Broken(format!(
                "reference `{}` holds bounces {:?}, the case asks for {:?}",
                self.reference, reference.provenance.bounces, self.bounces.0
            )));
        }
        let samples = context.budget.samples(u64::from(self.samples_per_pixel.0));
        let samples = samples.try_into().unwrap_or(u32::MAX);
        let isolates = context.info.capabilities.contains(Capabilities::ISOLATED_BOUNCES);
        let shot = Shot { check: self, camera, bounces: self.bounces.0, samples, isolates };
        let effort = ImageEffort::new(self.detects.0 * context.budget.coarseness(), samples);
        Ok(Setup { scene, reference, shot, effort })
    }

    /// A core that writes 8 bits and nothing else.
    fn by_codes(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let setup = self.setup(context)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&setup.scene, Acceleration::DEFAULT)?;
        let declared = setup.shot.codes(built.as_mut(), seed.child("encoding"))?.0;
        let judged = by_codes::judge(&setup, declared, &mut |draw| {
            Ok(setup.shot.codes(built.as_mut(), draw.seed(seed))?.1)
        })?;
        drop(built);
        Ok(judged.shown(&setup, context))
    }

    fn by_radiance(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let Setup { scene, reference, shot, effort } = self.setup(context)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let question =
            stats::Reference { mean: &reference.mean, standard_error: &reference.standard_error };
        let report = judge_image(question, &effort, &mut |draw| {
            shot.render(built.as_mut(), draw.seed(seed))
        })?;
        let finding = match report.verdict {
            Verdict::Fail if report.impossible.is_none() => {
                let seed = seed.child("clues");
                clues::explained(
                    finding(&report, report.judgement().hypothesis),
                    &report,
                    &reference,
                    &shot,
                    built.as_mut(),
                    seed,
                )?
            }
            _ => finding(&report, report.judgement().hypothesis),
        };
        drop(built);
        let caption = format!("mean of {} runs of {} samples per pixel", report.runs, shot.samples);
        let error = error_picture(&report, &reference.mean, &reference.standard_error);
        context.show(PictureRole::Reference, "Mitsuba", reference.mean);
        context.show(PictureRole::Render, caption, report.mean.clone());
        let caption = format!("difference, {ERROR_SCALE} standard errors at the ends of the scale");
        context.show(PictureRole::SignedError, caption, error);
        Ok(finding)
    }
}

/// What a core is asked for, and what it should show.
pub(super) struct Setup<'a> {
    pub(super) scene: Arc<SceneDescription>,
    pub(super) reference: Reference,
    pub(super) shot: Shot<'a>,
    pub(super) effort: ImageEffort,
}

/// How each run is rendered.
#[derive(Clone, Copy)]
pub(super) struct Shot<'a> {
    check: &'a MatchesReference,
    camera: Camera,
    bounces: [u32; 2],
    pub(super) samples: u32,
    /// Whether the core renders a bounce alone.
    pub(super) isolates: bool,
}

impl Shot<'_> {
    /// First and last bounce.
    pub(super) fn bounces(&self) -> [u32; 2] {
        self.bounces
    }

    /// The same of one bounce alone.
    pub(super) fn of_bounce(self, bounce: u32) -> Self {
        Self { bounces: [bounce; 2], ..self }
    }

    /// The same with another number of samples a pixel.
    pub(super) fn with_samples(self, samples: u32) -> Self {
        Self { samples, ..self }
    }

    pub(super) fn render(
        &self,
        scene: &mut dyn BuiltScene,
        seed: Seed,
    ) -> Result<Image, CheckError> {
        let mut film = Film::default();
        scene.render(&self.camera, &self.settings(seed), &mut film)?;
        let [width, height] = self.camera.film.map(|side| side as usize);
        Ok(Image { width, height, pixels: film.pixels })
    }

    /// The same of a core that writes 8 bits.
    fn codes(
        &self,
        scene: &mut dyn BuiltScene,
        seed: Seed,
    ) -> Result<(Encoding, Picture), CheckError> {
        let mut codes = Picture::default();
        let encoding = scene.render_codes(&self.camera, &self.settings(seed), &mut codes)?;
        Ok((encoding, codes))
    }

    fn settings(&self, seed: Seed) -> RenderSettings {
        let [width, height] = self.camera.film;
        RenderSettings {
            width,
            height,
            samples_per_pixel: self.samples,
            integrator: IntegratorSettings {
                bounces: self.bounces[0]..=self.bounces[1],
                direct: self.check.direct,
                seed: seed.0,
                ..Default::default()
            },
            ..Default::default()
        }
    }
}

/// Difference over its standard error, core and reference together; ±1 is the end of the scale.
pub(super) fn error_picture(report: &ImageReport, mean: &Image, standard_error: &Image) -> Image {
    Image::from_fn(mean.width, mean.height, |x, y| {
        let pixel = y * mean.width + x;
        std::array::from_fn(|c| {
            let difference = report.mean.pixels[pixel][c] - mean.pixels[pixel][c];
            let noise =
                report.standard_error.pixels[pixel][c].hypot(standard_error.pixels[pixel][c]);
            if noise > 0.0 { difference / noise / ERROR_SCALE } else { 0.0 }
        })
    })
}

/// What a report says in words and numbers; `hypothesis` is what the ledger enters.
pub(super) fn finding(report: &ImageReport, hypothesis: Option<Hypothesis>) -> Finding {
    let mut measures: Vec<_> =
        report.ratios.iter().map(|ratio| ratio_measure(ratio, report, hypothesis)).collect();
    measures.extend(report.scales.iter().map(scale_measure));
    let mut finding = Finding::of(
        statement(report),
        format!(
            "would have caught an error of {} of the whole picture",
            percent(report.resolution)
        ),
        measures,
    );
    finding.verdict = report.verdict;
    finding
}

/// How bright the whole picture is: what people ask first. Luminance stands for the test of the
/// picture.
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
        hypothesis: hypothesis.filter(|_| is_luminance),
        ..Measure::exact(name, ratio.ratio, 1.0, 0.0)
            .of_row("brightness of the whole picture")
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
        ..Measure::exact(name, measured, 0.0, scale.critical).in_unit("standard errors")
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
            "{} pixels are {kind}, the first at ({}, {}) from the top left",
            impossible.pixels, impossible.x, impossible.y
        );
    }
    if let Some([x, y]) = report.dead_pixels.first() {
        return format!(
            "{} pixels stay black in every run, the first at ({x}, {y}) from the top left",
            report.dead_pixels.len()
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

/// "the picture has 0.991 of the light it should have".
fn brightness(report: &ImageReport) -> String {
    let whole = report.ratios.iter().find(|ratio| ratio.component == Component::Luminance);
    match whole {
        None => "the picture is black".to_owned(),
        // Of codes it is an extrapolation, which black ones carry below nothing.
        Some(whole) => {
            let share = match whole.ratio <= 0.0 {
                true => "none".to_owned(),
                false => with_interval(whole.ratio, whole.interval),
            };
            format!("the picture has {share} of the light it should have")
        }
    }
}

/// Where fresh runs have confirmed the difference.
fn confirmed(report: &ImageReport, scale: Scale) -> String {
    let cell = report.scales.iter().find(|s| s.scale == scale).and_then(|s| s.worst.first());
    match cell {
        None => format!("confirmed at the scale of a {}", scale_name(scale)),
        Some(cell) => {
            let [mean, expected] = apart([cell.mean, cell.expected]);
            format!(
                "confirmed at the scale of a {}: {} is {mean} instead of {expected} around pixel ({}, {})",
                scale_name(scale),
                component_name(cell.component),
                cell.extent.x,
                cell.extent.y,
            )
        }
    }
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
