//! Samples of lights that are no shapes: points, the sun, skies. Direction, distance and radiance of the first two are
//! known exactly; of an environment light the mean of radiance over pdf is the integral of its radiance, however it is sampled.

use super::delta_samples::{Judged, Sampled};
use crate::cause::{Cause, light as cause};
use crate::checks::numbers::Numbers;
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, BuiltScene};
use crate::math::ratios::names_of;
use crate::math::rng::Seed;
use crate::scene::Light;
use crate::stats::{Band, Claim, Effort, Tolerance, judge_means};
use crate::text::{Count, Percent};
use glam::DVec3;
use std::f64::consts::PI;

check! {
    pub(crate) struct OpenLightSamples {
        /// The smallest error of the mean of a sky that must be seen.
        detects: Percent,
        at_most: Count,
    }
    name: "open-light-samples",
    summary: "samples of point, directional and environment lights",
    needs: BUILD_SCENE | SAMPLE_LIGHT,
}

impl Check for OpenLightSamples {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let falloff = context.info.conventions.point_light_falloff;
        let tolerance = Tolerance::FORMULA.of(context.info.precision);
        let band = Band::math(context.info.precision);
        let effort = context.effort(self.detects, self.at_most);
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut found = Vec::new();
        for (number, light) in (0..).zip(&scene.lights) {
            let seed = seed.child(number);
            match light {
                Light::Point { .. } | Light::Directional { .. } => {
                    let samples = Sampled::new(built.as_mut(), number, seed)?;
                    found.push(samples.judge_delta(light, falloff, tolerance));
                }
                Light::ConstantSky { radiance } => {
                    let sky = Sky { number, integral: 4.0 * PI * radiance[1], seed };
                    found.push(sky.judge(built.as_mut(), &effort, band)?);
                }
                Light::GradientSky { horizon, zenith, .. } => {
                    // The mean of a cosine that is 0 over half of the sphere is 1/4.
                    let integral = PI * (4.0 * horizon[1] + (zenith[1] - horizon[1]));
                    let judged =
                        Sky { number, integral, seed }.judge(built.as_mut(), &effort, band)?;
                    found.push(Judged { cause: None, ..judged });
                }
                Light::Area { .. } => {}
            }
        }
        if found.is_empty() {
            return Err(CheckError::Broken("the scene has no light of this kind".to_owned()));
        }
        Ok(finding(found))
    }
}

fn finding(found: Vec<Judged>) -> Finding {
    let complaint = |judged: &Judged| {
        let wrong = judged.measures.iter().find(|measure| measure.failed())?;
        let (measured, expected) = (figure(wrong.measured), figure(wrong.expected));
        Some(format!("{} is {measured} instead of {expected}", wrong.name()))
    };
    let (mut complaints, mut causes) = (Vec::new(), Vec::new());
    for (judged, complaint) in found.iter().filter_map(|one| Some((one, complaint(one)?))) {
        complaints.push(complaint);
        causes.extend(judged.cause);
    }
    let right = format!("samples of {} lights are what they should be", found.len());
    Finding::measured(right, found.into_iter().flat_map(|judged| judged.measures))
        .or_else_caught("would have caught one wrong sample")
        .complaining(complaints)
        .because_each(causes, "predicts the samples of the light")
}

/// An environment light.
struct Sky {
    number: u32,
    /// Of the green radiance, over all directions.
    integral: f64,
    seed: Seed,
}

impl Sky {
    fn judge(&self, scene: &mut dyn BuiltScene, effort: &Effort, band: Band) -> Result<Judged> {
        let claims = [Claim::value(self.integral, band)];
        let mut drawn = Drawn::default();
        let reports = judge_means(&claims, effort, &mut |draw| {
            let seed = draw.seed(self.seed);
            let count = usize::try_from(draw.samples).unwrap_or(usize::MAX);
            let from = vec![DVec3::ZERO; count];
            let samples = Numbers::new(seed, count).sample_light(scene, self.number, &from)?;
            let valid = || samples.iter().filter(|sample| sample.is_valid == 1);
            drawn.count += valid().count();
            drawn.directions += valid().map(|sample| sample.wi).sum::<DVec3>();
            let sum: f64 = valid().map(|sample| sample.radiance[1] / sample.pdf).sum();
            Ok::<_, CheckError>(vec![sum / count as f64])
        })?;
        let ratio = reports[0].ratio.unwrap_or([f64::NAN; 2]);
        Ok(Judged {
            measures: vec![Measure::of("mean of radiance over pdf", &reports[0]).of_row("the sky")],
            cause: drawn.mistake(ratio),
        })
    }
}

/// The directions that were sampled of a sky.
#[derive(Clone, Copy, Debug, Default)]
struct Drawn {
    count: usize,
    directions: DVec3,
}

/// The mean of uniform directions of a hemisphere is half as long as each; that of the sphere's is 0.
const ONE_SIDED: f64 = 0.25;

impl Drawn {
    /// What halves the mean of radiance over pdf, and is told by where the samples lie.
    fn mistake(&self, ratio: [f64; 2]) -> Option<&'static Cause> {
        let names = names_of([0.99 * ratio[0], 1.01 * ratio[1]], &[]);
        let is_half = names.first().is_some_and(|named| named.value == 0.5);
        let is_one_sided = self.directions.length() > ONE_SIDED * self.count as f64;
        is_half.then_some(match is_one_sided {
            true => &cause::ENVIRONMENT_FROM_ONE_SIDE,
            false => &cause::ENVIRONMENT_PDF_OF_HEMISPHERE,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::delta_samples::{Expected, expected};
    use super::*;
    use crate::contract::{Falloff, LightSample};
    use crate::stats::Verdict;

    fn sampled(light: &Light, spoil: impl Fn(&mut LightSample)) -> Sampled {
        let from: Vec<_> = (0..20).map(|i| DVec3::new(f64::from(i), 0.3, -1.0)).collect();
        let sample = |from: &DVec3| {
            let Expected { wi, distance, radiance } =
                expected(light, *from, Falloff::InverseSquare);
            let mut sample =
                LightSample { wi, distance, radiance, pdf: 1.0, is_delta: 1, is_valid: 1 };
            spoil(&mut sample);
            sample
        };
        let samples = from.iter().map(sample).collect();
        Sampled { from, samples }
    }

    fn told(light: &Light, spoil: impl Fn(&mut LightSample)) -> Option<&'static str> {
        let judged = sampled(light, spoil).judge_delta(light, Falloff::InverseSquare, 1e-6);
        let finding = finding(vec![judged]);
        (finding.verdict == Verdict::Fail).then(|| cause_of(&finding).unwrap_or("something"))
    }

    fn cause_of(finding: &Finding) -> Option<&'static str> {
        let clue = finding.clues.first()?;
        crate::cause::find(&clue.cause).map(|cause| cause.name)
    }

    const POINT: Light = Light::Point { position: DVec3::new(1.0, 2.0, 3.0), intensity: [2.0; 3] };
    const SUN: Light = Light::Directional { direction: DVec3::NEG_Z, irradiance: [2.0; 3] };

    #[test]
    fn right_samples_pass_and_wrong_ones_are_named() {
        assert_eq!(told(&POINT, |_| ()), None);
        assert_eq!(told(&SUN, |_| ()), None);
        assert_eq!(told(&SUN, |sample| sample.wi = -sample.wi), Some("directional-flipped"));
        let same_everywhere = told(&POINT, |sample| sample.radiance = [2.0; 3]);
        assert_eq!(same_everywhere, Some("falloff-undeclared"));
        assert_eq!(told(&POINT, |sample| sample.distance *= 1.01), Some("something"));
        assert_eq!(told(&POINT, |sample| sample.pdf = f64::NAN), Some("something"));
    }

    #[test]
    fn half_of_a_sky_is_a_wrong_pdf_or_the_other_half_left_out() {
        let of = |directions| Drawn { count: 100, directions }.mistake([0.499, 0.501]);
        let names = [DVec3::new(3.0, 1.0, 2.0), 50.0 * DVec3::Z].map(|sum| of(sum).unwrap().name);
        assert_eq!(names, ["environment-pdf-of-hemisphere", "environment-from-one-side"]);
        assert!(Drawn { count: 100, directions: DVec3::ZERO }.mistake([0.9, 1.1]).is_none());
    }
}
