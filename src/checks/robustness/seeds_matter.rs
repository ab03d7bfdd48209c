//! Different seeds give different noise, and neighbouring pixels have nothing to do with each other.

use super::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Acceleration, Capabilities, Film};
use crate::image::luminance;
use crate::stats::{CORRELATION_FALSE_ALARM, Verdict, judge_uncorrelated};
use serde::Deserialize;

/// Renders a noisy picture with many seeds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SeedsMatter {
    size: [u32; 2],
    bounces: [u32; 2],
    samples_per_pixel: u32,
    /// How many; differences are taken in pairs.
    seeds: u32,
}

impl Check for SeedsMatter {
    const NAME: &'static str = "seeds-matter";
    const SUMMARY: &'static str = "different seeds give different noise; pixels are independent";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE | Capabilities::RENDER
    }

    fn validate(&self) -> Result<(), String> {
        if self.seeds >= 4 { Ok(()) } else { Err("`seeds` must be 4 or more".to_owned()) }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let rendering = Rendering::of(&scene, self.size, self.bounces, self.samples_per_pixel)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let films = (0..self.seeds)
            .map(|run| rendering.film(built.as_mut(), seed.child(run).0, 0))
            .collect::<Result<Vec<_>, _>>()?;
        let measures =
            vec![equal_pictures(&films), neighbours(&films, [1, 0]), neighbours(&films, [0, 1])];
        let statement = match measures.iter().find(|m| m.verdict == Verdict::Fail) {
            None => format!("{} seeds give {} different pictures", self.seeds, self.seeds),
            Some(measure) => {
                format!("the noise is not independent: {} is {:.3}", measure.name, measure.measured)
            }
        };
        let limit = measures[1].allowed;
        let resolution = format!("would have caught a correlation of {:.3}", 2.0 * limit);
        Ok(Finding::of(statement, resolution, measures).spending(2.0 * CORRELATION_FALSE_ALARM))
    }
}

/// Pictures of different seeds that have the same bits.
fn equal_pictures(films: &[Film]) -> Measure {
    let is_repeated = |i: usize| films[..i].iter().any(|earlier| earlier.pixels == films[i].pixels);
    let repeated = (1..films.len()).filter(|i| is_repeated(*i)).count();
    Measure::exact("pictures that an earlier seed has given", repeated as f64, 0.0, 0.0)
}

/// Correlation of the noise of pixels that are `step` apart. Differences of two seeds have no picture left in them.
fn neighbours(films: &[Film], step: [usize; 2]) -> Measure {
    let mut pairs = Vec::new();
    for two in films.chunks_exact(2) {
        let width = two[0].width as usize;
        let height = two[0].height as usize;
        let noise = |x: usize, y: usize| {
            let pixel = y * width + x;
            // The square root tames fireflies, which a correlation would rest on alone.
            let [a, b] = [&two[0], &two[1]].map(|film| luminance(film.pixels[pixel]).sqrt());
            a - b
        };
        for y in 0..height - step[1] {
            pairs.extend(
                (0..width - step[0]).map(|x| [noise(x, y), noise(x + step[0], y + step[1])]),
            );
        }
    }
    let report = judge_uncorrelated(&pairs);
    let direction = if step[0] > 0 { "side by side" } else { "above each other" };
    Measure {
        verdict: report.verdict,
        ..Measure::exact(
            format!("correlation of pixels {direction}"),
            report.coefficient,
            0.0,
            report.limit,
        )
    }
}
