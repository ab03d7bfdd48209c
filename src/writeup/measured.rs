//! Numbers beside a figure, and how long the rest takes.

use super::Plan;
use super::bvh::Mesh;
use super::ladder::Ladder;
use crate::contract::CoreError;
use crate::image::{Image, luminance};
use crate::render::{Made, Shot, Shown, missing};
use serde::{Deserialize, Serialize};

/// What is known of an image besides itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) struct Measured {
    /// Of the core, without the build.
    pub(super) seconds: f64,
    /// Mean luminance and its standard error, if that is known.
    pub(super) mean: Option<(f64, Option<f64>)>,
    /// Mean standard error of a pixel's luminance, over that mean.
    pub(super) noise: Option<f64>,
    /// Mean number of samples that a pixel took, where that varies.
    pub(super) samples: Option<f64>,
    /// What is wrong with the form of its pixels.
    pub(super) breach: Option<String>,
}

impl Measured {
    pub(super) fn of(made: &Made) -> Self {
        let breach = made.breach().map(|error| match error {
            // What was asked for an answer is no matter of a figure.
            CoreError::BrokeContract(breach) => {
                CoreError::BrokeContract(Box::new(breach.without_question())).to_string()
            }
            other => other.to_string(),
        });
        let seconds = made.seconds;
        let rendered = match &made.shown {
            Shown::Codes(_) => {
                return Self { seconds, mean: None, noise: None, samples: None, breach };
            }
            Shown::Radiance(rendered) => rendered,
        };
        let mean = mean(&rendered.image, luminance);
        // Of the light of one path the channels err together: so does their luminance.
        let errors = rendered.standard_error.as_ref().map(|(errors, _)| errors);
        let error = |errors: &Image| self::mean(errors, |error| luminance(error).powi(2));
        let pixels = rendered.image.pixels.len() as f64;
        let average =
            |samples: &Vec<f32>| samples.iter().map(|s| f64::from(*s)).sum::<f64>() / pixels;
        Self {
            seconds,
            mean: Some((mean, errors.map(|errors| (error(errors) / pixels).sqrt()))),
            noise: errors.map(|errors| self::mean(errors, luminance) / mean),
            samples: rendered.samples.as_ref().map(average),
            breach,
        }
    }
}

fn mean(image: &Image, value: impl Fn([f32; 3]) -> f64) -> f64 {
    image.pixels.iter().map(|pixel| value(*pixel)).sum::<f64>() / image.pixels.len() as f64
}

/// What is still to be rendered, in rays, and how long rays take.
pub(super) struct Pace {
    left: f64,
    rendered: f64,
    seconds: f64,
}

impl Pace {
    pub(super) fn of(plan: &Plan<'_>, ladders: &[Ladder]) -> Self {
        let rungs = ladders.iter().flat_map(|ladder| &ladder.rungs);
        let figures = rungs.map(|rung| rung.shot(plan.cast, plan.effort));
        let meshes = Mesh::all().map(|mesh| mesh.shot(plan.cast, plan.effort.size));
        let left = figures.chain(meshes).flatten().map(|shot| to_render(plan, &shot)).sum();
        Self { left, rendered: 0.0, seconds: 0.0 }
    }

    pub(super) fn took(&mut self, shot: &Shot, seconds: f64) {
        self.rendered += rays(shot);
        self.seconds += seconds;
    }

    pub(super) fn is_done(&mut self, plan: &Plan<'_>, shot: &Shot) {
        self.left -= to_render(plan, shot);
    }

    /// Seconds, if anything was rendered by now: `rays` of the figure that is being made, in `seconds`.
    pub(super) fn left(&self, rays: f64, seconds: f64) -> Option<f64> {
        let rendered = self.rendered + rays;
        let left = (self.left - rays).max(0.0);
        (rendered > 0.0).then(|| left * (self.seconds + seconds) / rendered)
    }
}

/// Nothing, where the core cannot.
fn to_render(plan: &Plan<'_>, shot: &Shot) -> f64 {
    if missing(shot, &plan.info).is_empty() { rays(shot) } else { 0.0 }
}

/// About how many rays an image takes: roulette ends paths long before the hundredth bounce.
pub(super) fn rays(shot: &Shot) -> f64 {
    let [width, height] = shot.size.unwrap_or_default().map(f64::from);
    let last = shot.bounces.as_ref().map_or(1, |bounces| (*bounces.end()).min(8));
    let a_path = f64::from(1 + last * (1 + shot.light_samples));
    let rays = if shot.normals { 1.0 } else { f64::from(shot.spp) * a_path };
    width * height * rays
}
