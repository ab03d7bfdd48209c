//! Sampled directions reach the light, at the distance they say, with a density that adds up.
//!
//! Two means need no BSDF and no shadow ray: the mean of 1/pdf is the solid angle of the light, that of cos/pdf is π
//! times its form factor. A wrong Jacobian from area to solid angle shows in both.

use super::density::{self, Geometry, area_of};
use crate::cause;
use crate::checks::numbers::Numbers;
use crate::checks::phrase::some_are;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Acceleration, BuiltScene, Capabilities, Hit, LightSample, Ray};
use crate::math::ratios::names_of;
use crate::math::rng::Seed;
use crate::scene::{Light, SceneDescription};
use crate::stats::{
    Band, Claim, Compared, MeanReport, Tolerance, Verdict, judge_exact, judge_means,
};
use crate::text::number::with_interval;
use crate::text::{Chance, Count, Direction, Percent, Positive, Several, Vector};
use serde::Deserialize;
use std::f64::consts::PI;

/// Samples whose end is looked for.
const TRACED: usize = 4096;
/// Shadow rays start and the light is looked for this share of the distance away from either end.
const SLACK: f64 = 1e-3;

/// Samples an area light from some points.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct LightSamplesReachLight {
    /// The smallest error of a mean that must be seen.
    detects: Percent,
    /// Past this the verdict is inconclusive, never a pass.
    at_most: Count,
    point: Several<Point>,
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
}

impl Check for LightSamplesReachLight {
    const NAME: &'static str = "light-samples-reach-light";
    const SUMMARY: &'static str = "sampled directions meet the light; 1/pdf is its solid angle";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE | Capabilities::SAMPLE_LIGHT | Capabilities::INTERSECT
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
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
            let traced = Traced::new(built.as_mut(), point, light, seed)?;
            measures.push(traced.reached(&label, Tolerance::INTERSECTION.of(precision)));
            if point.form_factor.0 == 0.0 {
                measures.push(traced.dark(&label));
                shines_backwards |= !traced.samples.is_empty();
                continue;
            }
            met.extend(area.into_iter().flat_map(|area| traced.geometry(area, point)));
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
        let density = if off { density::mistake(&met) } else { None };
        Ok(Finding::measured("samples reach the light with the density they say", measures)
            .or_else_caught(format!("would have caught one wrong sample among {TRACED}"))
            .complaining(complaints)
            .because_each(backwards, "there are lit samples where the light looks away")
            .because_each(density, &format!("predicts the densities of {} samples", met.len())))
    }
}

/// The number of the first area light, and of its shape.
fn the_area_light(scene: &SceneDescription) -> Result<(u32, u32), CheckError> {
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
        solid_angle.into_iter().chain([factor]).collect()
    }

    /// Means over one run, in the order of the claims. A sample that sees no light counts as zero.
    fn means(
        &self,
        scene: &mut dyn BuiltScene,
        light: u32,
        seed: Seed,
        count: u64,
    ) -> Result<Vec<f64>, CheckError> {
        let samples =
            self.samples(scene, light, seed, usize::try_from(count).unwrap_or(usize::MAX))?;
        let normal = self.normal.0;
        let lit = || samples.iter().filter(|sample| is_lit(sample));
        let inverse: f64 = lit().map(|sample| sample.pdf.recip()).sum();
        let cosine: f64 = lit().map(|s| s.wi.dot(normal).max(0.0) / s.pdf).sum();
        let n = count as f64;
        Ok(self.solid_angle.map(|_| inverse / n).into_iter().chain([cosine / n]).collect())
    }

    fn samples(
        &self,
        scene: &mut dyn BuiltScene,
        light: u32,
        seed: Seed,
        count: usize,
    ) -> Result<Vec<LightSample>, CheckError> {
        let numbers = Numbers::new(seed, count);
        let mut samples = vec![LightSample::NONE; count];
        let from = vec![self.from.0; count];
        scene.sample_light(light, &from, numbers.randomness(), &mut samples)?;
        Ok(samples)
    }
}

fn is_lit(sample: &LightSample) -> bool {
    sample.is_valid == 1 && sample.pdf > 0.0 && sample.radiance != [0.0; 3]
}

/// Some samples, and what their rays meet in the scene.
struct Traced {
    samples: Vec<LightSample>,
    hits: Vec<Hit>,
    shape: u32,
}

impl Traced {
    fn new(
        scene: &mut dyn BuiltScene,
        point: &Point,
        (light, shape): (u32, u32),
        seed: Seed,
    ) -> Result<Self, CheckError> {
        let mut samples = point.samples(scene, light, seed.child("traced"), TRACED)?;
        samples.retain(is_lit);
        // From close before the light: what lies in between is the business of shadow rays.
        let ray = |sample: &LightSample| {
            let start = (1.0 - SLACK) * sample.distance;
            Ray { t_min: start, ..Ray::new(point.from.0, sample.wi) }
        };
        let rays: Vec<_> = samples.iter().map(ray).collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        if !rays.is_empty() {
            scene.intersect(&rays, &mut hits)?;
        }
        Ok(Self { samples, hits, shape })
    }

    /// Every lit sample ends on the light, where it says.
    fn reached(&self, label: &str, tolerance: f64) -> Measure {
        let compared = self.samples.iter().zip(&self.hits).map(|(sample, hit)| {
            let found = if hit.is_hit() && hit.shape == self.shape { hit.t } else { f64::NAN };
            Compared::relative(found, sample.distance, tolerance.max(1e-6))
        });
        let report = judge_exact(compared);
        if report.compared == 0 {
            return Measure::none("samples that see light", 0).of_row(label);
        }
        let some = some_are(report.disagree, report.compared, "samples");
        let measure = match report.verdict {
            Verdict::Pass => Measure::worst("distance to the light", &report),
            _ => {
                Measure::none(format!("{some} not on the light at that distance"), report.disagree)
            }
        };
        measure.of_row(label)
    }

    /// Of the samples that met the light.
    fn geometry(&self, area: f64, point: &Point) -> Vec<(Geometry, f64)> {
        let normal = point.normal.0;
        Geometry::of(area, normal, &self.samples, &self.hits)
    }

    /// A light that looks away sends nothing.
    fn dark(&self, label: &str) -> Measure {
        Measure::none("lit samples of a light that looks away", self.samples.len()).of_row(label)
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
