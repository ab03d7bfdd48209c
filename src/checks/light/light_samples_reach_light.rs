//! Sampled directions reach the light, at the distance they say, with a pdf that integrates to one.
//!
//! Two means need no BSDF and no shadow ray: the mean of 1/pdf is the solid angle of the light, that of cos/pdf is π
//! times its form factor. A wrong Jacobian from area to solid angle shows in both. Where samples crowd though their pdf does
//! not say so, the solid angle of a part of the light shows it.

use super::area_pdf::{self, area_of};
use super::traced::{Traced, is_lit};
use crate::cause;
use crate::checks::numbers::Numbers;
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, BuiltScene, LightSample};
use crate::math::ratios::names_of;
use crate::math::rng::Seed;
use crate::scene::{Light, SceneDescription};
use crate::stats::{Band, Claim, MeanReport, Tolerance, Verdict, judge_means};
use crate::text::number::with_interval;
use crate::text::{Angle, Chance, Count, Direction, Percent, Positive, Several, Vector};
use glam::DVec3;
use serde::Deserialize;
use std::f64::consts::PI;

/// Samples whose end is looked for.
const TRACED: usize = 4096;
check! {
    pub(crate) struct LightSamplesReachLight {
        detects: Percent,
        at_most: Count,
        point: Several<Point>,
    }
    name: "light-samples-reach-light",
    summary: "sampled directions meet the light; 1/pdf is its solid angle",
    needs: BUILD_SCENE | SAMPLE_LIGHT | INTERSECT,
}

/// Where the light is sampled from, and how large it looks there.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Point {
    from: Vector,
    /// Of the surface there, unit.
    normal: Direction,
    /// Steradians. None where only a part of the light faces the point.
    solid_angle: Option<Positive>,
    /// Of the light as seen by the surface; 0 where the light looks away.
    form_factor: Chance,
    /// A cone of directions that the light fills.
    within: Option<Cone>,
}

/// Directions around `axis`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Cone {
    axis: Direction,
    half_angle: Angle,
}

impl Cone {
    /// Steradians.
    fn solid_angle(&self) -> f64 {
        2.0 * PI * (1.0 - self.half_angle.0.cos())
    }

    fn holds(&self, direction: DVec3) -> bool {
        direction.dot(self.axis.0) >= self.half_angle.0.cos()
    }
}

impl Check for LightSamplesReachLight {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let light = the_area_light(&scene)?;
        let area = area_of(&scene, light.1);
        let (seed, precision) = (context.seed, context.info.precision);
        let effort = context.effort(self.detects, self.at_most);
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let (mut measures, mut complaints) = (Vec::new(), Vec::new());
        let (mut met, mut shines_backwards) = (Vec::new(), false);
        for (number, point) in self.point.iter().enumerate() {
            let seed = seed.child(number);
            let label = format!("point {}", number + 1);
            let samples = point.samples(built.as_mut(), light.0, seed.child("traced"), TRACED)?;
            let tolerance = Tolerance::INTERSECTION.of(precision);
            let traced = Traced::new(built.as_mut(), point.from.0, samples, light.1, tolerance)?;
            measures.push(traced.reached(&label));
            if point.form_factor.0 == 0.0 {
                measures.push(traced.dark(&label));
                shines_backwards |= !traced.samples.is_empty();
                continue;
            }
            met.extend(area.into_iter().flat_map(|area| traced.geometry(area, point.normal.0)));
            let claims = point.claims(Band::math(precision));
            let plain: Vec<_> = claims.iter().map(|(_, claim)| *claim).collect();
            let reports = judge_means(&plain, &effort, &mut |draw| {
                let run = draw.seed(seed);
                point.means(built.as_mut(), light.0, run, draw.samples)
            })?;
            for ((name, _), report) in claims.iter().zip(&reports) {
                measures.push(Measure::of(name, report).of_row(&label));
                complaints.extend(complaint(&label, name, report));
            }
        }
        let failed = measures.iter().find(|m| m.failed() && m.interval.is_none());
        complaints.extend(failed.map(Measure::name));
        let backwards = shines_backwards.then_some(&cause::light::LIGHT_SHINES_BACKWARDS);
        let off = measures.iter().any(|m| m.failed() && m.interval.is_some());
        let pdf = if off { area_pdf::mistake(&met) } else { None };
        let formula = Tolerance::FORMULA.of(precision);
        let law = if off { area_pdf::law(&met, formula) } else { None };
        Ok(Finding::measured("samples reach the light with the pdf they say", measures)
            .or_else_caught(format!("would have caught one wrong sample among {TRACED}"))
            .complaining(complaints)
            .because_each(backwards, "there are lit samples where the light looks away")
            .because_each(pdf, &format!("predicts the pdfs of {} samples", met.len()))
            .by_law(law))
    }
}

/// The number of the first area light, and of its shape.
fn the_area_light(scene: &SceneDescription) -> Result<(u32, u32)> {
    let area = |light: &Light| match light {
        Light::Area { shape } => Some(*shape),
        _ => None,
    };
    let found = (0..).zip(&scene.lights).find_map(|(number, light)| Some((number, area(light)?)));
    found.ok_or_else(|| CheckError::Broken(format!("scene `{}` has no area light", scene.name)))
}

impl Point {
    /// The means that are known at this point, by name.
    fn claims(&self, band: Band) -> Vec<(&'static str, Claim)> {
        let solid_angle =
            self.solid_angle.map(|value| ("mean of 1/pdf", Claim::value(value.0, band)));
        let factor = ("mean of cos/pdf", Claim::value(PI * self.form_factor.0, band));
        let of_cone =
            |cone: &Cone| ("mean of 1/pdf, inner part", Claim::value(cone.solid_angle(), band));
        solid_angle.into_iter().chain([factor]).chain(self.within.as_ref().map(of_cone)).collect()
    }

    /// Means over one run, in the order of the claims. A sample that sees no light counts as zero.
    fn means(
        &self,
        scene: &mut dyn BuiltScene,
        light: u32,
        seed: Seed,
        count: u64,
    ) -> Result<Vec<f64>> {
        let samples =
            self.samples(scene, light, seed, usize::try_from(count).unwrap_or(usize::MAX))?;
        let normal = self.normal.0;
        let lit = || samples.iter().filter(|sample| is_lit(sample));
        let inverse: f64 = lit().map(|sample| sample.pdf.recip()).sum();
        let cosine: f64 = lit().map(|s| s.wi.dot(normal).max(0.0) / s.pdf).sum();
        let inner = self.within.as_ref().map(|cone| -> f64 {
            lit().filter(|sample| cone.holds(sample.wi)).map(|sample| sample.pdf.recip()).sum()
        });
        let inverse = self.solid_angle.map(|_| inverse);
        let sums = inverse.into_iter().chain([cosine]).chain(inner);
        Ok(sums.map(|sum| sum / count as f64).collect())
    }

    fn samples(
        &self,
        scene: &mut dyn BuiltScene,
        light: u32,
        seed: Seed,
        count: usize,
    ) -> Result<Vec<LightSample>> {
        let from = vec![self.from.0; count];
        Ok(Numbers::new(seed, count).sample_light(scene, light, &from)?)
    }
}

fn complaint(label: &str, name: &str, report: &MeanReport) -> Option<String> {
    if report.verdict != Verdict::Fail {
        return None;
    }
    let ratio = report.ratio?;
    let named = names_of(ratio, &[]);
    let word = named.first().map_or_else(String::new, |ratio| format!(" ({})", ratio.name));
    let factor = with_interval(report.mean / report.expected, ratio);
    Some(format!("{label}: {name} is {factor}{word} of what it should be"))
}
