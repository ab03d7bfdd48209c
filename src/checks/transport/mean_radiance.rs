//! Mean radiance along a ray against a number that is known.

use super::estimate::{
    CHANNELS, RayEntry, RouletteEntry, effort, estimate, measure, needs, percent,
    resolution_sentence, settings,
};
use super::mistaken::{Measured, Mistaken, explanations};
use crate::cause::Cause;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, DirectSampling, IntegratorSettings, Ray,
};
use crate::math::rng::Seed;
use crate::stats::{Band, Claim, Effort, Support, Verdict, judge_means};
use crate::text::{Colour, Count, Percent};
use serde::Deserialize;

/// Relative error of a radiance that no random number touches: a dozen operations in single precision, and a
/// shadow ray that starts and ends a little off its surfaces.
const EXACT_RADIANCE: f64 = 1e-5;
/// Samples of a row that has no variance.
const EXACT_SAMPLES: u64 = 64;
/// Samples of a row that has to be dark: one photon is enough to fail.
const DARK_SAMPLES: u64 = 16_384;

/// Each row: the mean radiance along a ray is a given number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MeanRadiance {
    /// For every row that has none of its own.
    ray: Option<RayEntry>,
    #[serde(default)]
    direct: DirectSampling,
    #[serde(default = "one")]
    samples_per_light: u32,
    /// The smallest error that must be seen.
    detects: Percent,
    /// Past this the verdict is inconclusive, never a pass.
    at_most: Count,
    row: Vec<Row>,
}

/// One number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Row {
    /// What this row is, where `bounces` do not say enough.
    name: Option<String>,
    ray: Option<RayEntry>,
    bounces: [u32; 2],
    radiance: Colour,
    direct: Option<DirectSampling>,
    roulette: Option<RouletteEntry>,
    /// What no sample exceeds, however a core keeps its word; only where `source` says why. A run
    /// in a hurry can then show that light is missing, too.
    largest: Option<Colour>,
    /// The scene leaves nothing to chance: judged to rounding, on a few samples.
    #[serde(default)]
    exact: bool,
    /// What known mistakes would make of it.
    #[serde(default)]
    mistaken: Mistaken,
}

const fn one() -> u32 {
    1
}

impl Check for MeanRadiance {
    const NAME: &'static str = "mean-radiance";
    const SUMMARY: &'static str = "mean radiance along a ray against a closed form";

    fn needs(&self) -> Capabilities {
        self.row.iter().fold(Capabilities::empty(), |all, row| all | needs(&self.settings(row)))
    }

    fn validate(&self) -> Result<(), String> {
        if self.row.is_empty() {
            return Err("there are no rows; add `[[expect.row]]`".to_owned());
        }
        self.row.iter().try_for_each(|row| {
            row.mistaken.validate()?;
            row.ray.or(self.ray).ok_or("a row has no `ray`, and neither has `[expect]`")?.validate()
        })
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let (seed, effort) = (context.seed, effort(self.detects, self.at_most, context.budget));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut measures = Vec::new();
        for (number, row) in self.row.iter().enumerate() {
            let question = self.question(row, seed.child(number));
            let row_measures = question.judge(built.as_mut(), &effort)?;
            let failed = row_measures.iter().any(|measure| measure.verdict == Verdict::Fail);
            measures.push(row_measures);
            if failed && effort.decides_early {
                break;
            }
        }
        let causes = self.explanations(&measures);
        let measures: Vec<_> = measures.into_iter().flatten().collect();
        let statement = statement(&measures);
        let resolution = match resolution_sentence(&measures) {
            dark if dark.is_empty() => {
                format!("would have caught one lit sample among {DARK_SAMPLES}")
            }
            lit => lit,
        };
        Ok(Finding::of(statement, resolution, measures)
            .because_each(causes, "predicts every row of the case"))
    }
}

impl MeanRadiance {
    /// The mistakes that predict all rows that were tried, if one of them failed.
    fn explanations(&self, measures: &[Vec<Measure>]) -> Vec<&'static Cause> {
        if measures.iter().flatten().all(|measure| measure.verdict != Verdict::Fail) {
            return Vec::new();
        }
        let tried = self.row.iter().zip(measures);
        explanations(&tried.map(|(row, measures)| row.measured(measures)).collect::<Vec<_>>())
    }

    fn settings(&self, row: &Row) -> IntegratorSettings {
        IntegratorSettings {
            samples_per_light: self.samples_per_light,
            roulette: row.roulette.map(Into::into),
            ..settings(row.bounces, row.direct.unwrap_or(self.direct))
        }
    }

    fn question(&self, row: &Row, seed: Seed) -> Question {
        let entry = row.ray.or(self.ray);
        Question {
            name: row.name(),
            ray: entry.map_or(Ray::new(glam::DVec3::ZERO, glam::DVec3::Z), RayEntry::ray),
            settings: self.settings(row),
            expected: row.radiance.0,
            largest: row.largest.map(|largest| largest.0),
            exact: row.exact,
            seed,
        }
    }
}

impl Row {
    /// The channels that are measured: those that are not dark, or all of a dark row.
    fn channels(&self) -> impl Iterator<Item = usize> {
        let Colour(radiance) = self.radiance;
        let is_dark = radiance == [0.0; 3];
        (0..3).filter(move |channel| is_dark || self.exact || radiance[*channel] != 0.0)
    }

    fn measured<'a>(&'a self, measures: &'a [Measure]) -> Measured<'a> {
        let (mistaken, right) = (&self.mistaken, self.radiance.0);
        Measured { mistaken, right, measures: self.channels().zip(measures).collect() }
    }

    fn name(&self) -> String {
        self.name.clone().unwrap_or_else(|| match self.bounces {
            [first, last] if first == last => format!("bounce {first}"),
            [first, last] => format!("bounces {first} to {last}"),
        })
    }
}

/// One row, put to one core.
struct Question {
    name: String,
    ray: Ray,
    settings: IntegratorSettings,
    expected: [f64; 3],
    largest: Option<[f64; 3]>,
    exact: bool,
    seed: Seed,
}

impl Question {
    /// The measures of the three channels.
    fn judge(
        &self,
        scene: &mut dyn BuiltScene,
        effort: &Effort,
    ) -> Result<Vec<Measure>, CheckError> {
        if self.expected == [0.0; 3] {
            return self.judge_dark(scene);
        }
        if self.exact {
            return self.judge_exact(scene);
        }
        let lit: Vec<_> = (0..3).filter(|channel| self.expected[*channel] != 0.0).collect();
        let claims: Vec<_> = lit.iter().map(|channel| self.claim(*channel)).collect();
        let reports = judge_means(&claims, effort, &mut |draw| {
            let seed = draw.seed(self.seed);
            let run = estimate(scene, self.ray, &self.settings, seed, draw.samples)?;
            Ok::<_, CheckError>(lit.iter().map(|channel| run.mean[*channel]).collect())
        })?;
        let measures = lit.iter().zip(&reports);
        Ok(measures.map(|(channel, report)| measure(self.label(*channel), report)).collect())
    }

    /// Radiance is not negative, and sometimes more is known.
    fn claim(&self, channel: usize) -> Claim {
        let claim = Claim::value(self.expected[channel], Band::RADIANCE);
        match self.largest {
            Some(largest) => claim.with_samples_up_to(largest[channel]),
            None => claim.with_support(Support::NotNegative),
        }
    }

    /// No light at all: not one sample may carry any.
    fn judge_dark(&self, scene: &mut dyn BuiltScene) -> Result<Vec<Measure>, CheckError> {
        let run = estimate(scene, self.ray, &self.settings, self.seed, DARK_SAMPLES)?;
        Ok((0..3).map(|c| Measure::exact(self.label(c), run.largest[c], 0.0, 0.0)).collect())
    }

    /// No variance: a few samples say it all.
    fn judge_exact(&self, scene: &mut dyn BuiltScene) -> Result<Vec<Measure>, CheckError> {
        let run = estimate(scene, self.ray, &self.settings, self.seed, EXACT_SAMPLES)?;
        let exact = |c: usize| {
            let allowed = EXACT_RADIANCE * self.expected[c].abs();
            Measure::exact(self.label(c), run.mean[c], self.expected[c], allowed)
        };
        Ok((0..3).map(exact).collect())
    }

    fn label(&self, channel: usize) -> String {
        format!("{}, {}", self.name, CHANNELS[channel])
    }
}

/// The sentence on top: the worst number, or that all agree.
fn statement(measures: &[Measure]) -> String {
    let departure = |measure: &Measure| ((measure.measured / measure.expected) - 1.0).abs();
    let worst = measures
        .iter()
        .filter(|measure| measure.verdict == Verdict::Fail)
        .max_by(|a, b| departure(a).total_cmp(&departure(b)));
    match worst {
        None => format!("all {} mean radiances are what they should be", measures.len()),
        Some(worst) if worst.expected == 0.0 => {
            format!("{}: radiance {:.3e} where there is no light", worst.name, worst.measured)
        }
        Some(worst) => format!(
            "{}: {:.4} of what it should be ({:.6} instead of {:.6}), off by {}",
            worst.name,
            worst.measured / worst.expected,
            worst.measured,
            worst.expected,
            percent(departure(worst)),
        ),
    }
}
