//! Mean radiance along a ray against a number that is known.

use super::by_convention::ConventionEntry;
use super::estimate::{Aim, PatchEntry, RayEntry, RouletteEntry, needs, one, settings};
use super::foretold::MistakeEntry;
use super::question::{DARK_SAMPLES, Question};
use crate::cause::{contract, light};
use crate::checks::law::{LOST_SAMPLES, lost_in_words};
use crate::checks::phrase::{figure, percent, ratio_of};
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, breach, check};
use crate::contract::{
    Acceleration, Breach, Capabilities, Conventions, CoreError, CoreInfo, DirectSampling,
    IntegratorSettings, Ray,
};
use crate::math::rng::Seed;
use crate::scene::SceneDescription;
use crate::stats::Tolerance;
use crate::text::number::apart;
use crate::text::{Between, Bounces, Colour, Count, Percent, Several};
use serde::Deserialize;

check! {
    pub(crate) struct MeanRadiance {
        /// For every row that has none of its own.
        ray: Option<RayEntry>,
        #[serde(default)]
        direct: DirectSampling,
        #[serde(default = "one")]
        samples_per_light: Between<1, 4096>,
        /// Where the core's own maximum depth ends the paths.
        #[serde(default)]
        by_depth: bool,
        detects: Percent,
        at_most: Count,
        row: Several<Row>,
        #[serde(default)]
        mistake: Vec<MistakeEntry>,
    }
    name: "mean-radiance",
    summary: "mean radiance along a ray against a closed form",
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Row {
    /// What this row is, where `bounces` do not say enough.
    name: Option<String>,
    ray: Option<RayEntry>,
    /// The mean over a surface, instead of a ray.
    over: Option<PatchEntry>,
    bounces: Bounces,
    radiance: Colour,
    /// What it is for cores that have chosen otherwise.
    #[serde(default)]
    by_convention: Vec<ConventionEntry>,
    direct: Option<DirectSampling>,
    roulette: Option<RouletteEntry>,
    /// No path leaves what the camera sees, so that no core has a choice: judged to rounding, on a few samples.
    #[serde(default)]
    exact: bool,
}

impl Check for MeanRadiance {
    fn needs_besides(&self) -> Capabilities {
        self.row.iter().fold(Capabilities::empty(), |all, row| all | needs(&self.settings(row)))
    }

    fn validate(&self) -> Result<(), String> {
        self.mistake.iter().try_for_each(|mistake| mistake.validate(self.row.len()))?;
        self.row.iter().try_for_each(|row| {
            row.by_convention.iter().try_for_each(ConventionEntry::validate)?;
            if row.exact && row.bounces.0 != [0, 0] {
                return Err(
                    "what a bounce brings is an estimate: only bounce 0 is `exact`".to_owned()
                );
            }
            match row.ray.or(self.ray) {
                Some(_) => Ok(()),
                None if row.over.is_some() => Ok(()),
                None => Err("a row has no `ray`, and neither has `[expect]`".to_owned()),
            }
        })
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let (seed, mut effort) = (context.seed, context.effort(self.detects, self.at_most));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let (info, brightest) = (context.info.clone(), brightest(&scene));
        let mut rows = Vec::new();
        let mut lost = Vec::new();
        for (number, row) in self.row.iter().enumerate() {
            let question = Question { brightest, ..self.question(row, seed.child(number), &info) };
            let judged = match question.judge(built.as_mut(), &effort) {
                Err(CheckError::Core(CoreError::BrokeContract(breach)))
                    if divides_by_no_lights(&scene, &breach) =>
                {
                    let finding = breach::failure(&breach);
                    return Ok(finding.because(&light::DIVIDED_BY_ZERO_LIGHTS, NO_LIGHTS));
                }
                judged => judged?,
            };
            let failed = judged.measures.iter().any(Measure::failed);
            rows.push(judged.measures);
            if failed {
                lost.push(judged.lost);
                if context.budget.stops_at_failure {
                    break;
                }
                effort = effort.beside_a_failure();
            }
        }
        let causes: Vec<_> =
            self.mistake.iter().filter_map(|mistake| mistake.explains(&rows)).collect();
        let measures: Vec<_> = rows.into_iter().flatten().collect();
        let lost: Option<Vec<_>> = lost.into_iter().collect();
        let most = lost.and_then(|shares| shares.into_iter().reduce(f64::max));
        let mut statement = statement(&measures);
        if let Some(share) = most {
            statement += &format!("; {}", lost_in_words(share));
        }
        Ok(Finding::measured(statement, measures)
            .or_else_caught(format!("would have caught one lit sample among {DARK_SAMPLES}"))
            .because_of(causes)
            .knowing_laws(most.map(|_| LOST_SAMPLES.to_owned())))
    }
}

/// What speaks for a division by the number of lights.
const NO_LIGHTS: &str = "radiance is not a number in a scene that has no light";

fn divides_by_no_lights(scene: &SceneDescription, breach: &Breach) -> bool {
    scene.lights.is_empty() && breach::cause_of(breach) == Some(&contract::NOT_A_NUMBER)
}

impl MeanRadiance {
    fn settings(&self, row: &Row) -> IntegratorSettings {
        IntegratorSettings {
            samples_per_light: self.samples_per_light.0,
            by_depth: self.by_depth,
            roulette: row.roulette.map(Into::into),
            ..settings(row.bounces.0, row.direct.unwrap_or(self.direct))
        }
    }

    fn question(&self, row: &Row, seed: Seed, info: &CoreInfo) -> Question {
        let ray = || row.ray.or(self.ray).map(|entry| Aim::Ray(entry.ray()));
        let straight_up = Aim::Ray(Ray::new(glam::DVec3::ZERO, glam::DVec3::Z));
        Question {
            name: row.name(),
            aim: row.over.map(Aim::Patch).or_else(ray).unwrap_or(straight_up),
            settings: self.settings(row),
            expected: row.expected(&info.conventions),
            exact: row.exact.then_some(Tolerance::RADIANCE.of(info.precision)),
            seed,
            brightest: 0.0,
        }
    }
}

/// The largest radiance that a surface emits.
fn brightest(scene: &SceneDescription) -> f64 {
    let emissions = scene.materials.iter().filter_map(|material| material.emission.as_ref());
    emissions.flat_map(|emission| emission.radiance).fold(0.0, f64::max)
}

impl Row {
    /// What is right for a core that has chosen so.
    fn expected(&self, declared: &Conventions) -> [f64; 3] {
        let mut exceptions = self.by_convention.iter();
        let exception = exceptions.find(|entry| entry.is_declared_by(declared));
        exception.map_or(self.radiance, |entry| entry.radiance).0
    }

    fn name(&self) -> String {
        self.name.clone().unwrap_or_else(|| match self.bounces.0 {
            [first, last] if first == last => format!("bounce {first}"),
            [first, last] => format!("bounces {first} to {last}"),
        })
    }
}

/// The sentence on top: the worst number, or that all agree.
fn statement(measures: &[Measure]) -> String {
    let departure = |measure: &Measure| ((measure.measured / measure.expected) - 1.0).abs();
    let worst = measures
        .iter()
        .filter(|measure| measure.failed())
        .max_by(|a, b| departure(a).total_cmp(&departure(b)));
    match worst {
        None => format!("all {} mean radiances are what they should be", measures.len()),
        Some(worst) if worst.expected == 0.0 => {
            format!("{}: radiance {} where there is no light", worst.name(), figure(worst.measured))
        }
        Some(worst) => {
            let [measured, expected] = apart([worst.measured, worst.expected]);
            format!(
                "{}: {} of what it should be ({measured} instead of {expected}), off by {}",
                worst.name(),
                ratio_of(worst),
                percent(departure(worst)),
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{check_of, try_judge};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Paths that a black core is asked for in a case of so many rows.
    fn paths(rows: usize) -> u64 {
        let row = "[[expect.row]]\nbounces = [0, 1]\nradiance = 0.5\n";
        let check: MeanRadiance = check_of(&format!(
            "[expect]\nray = {{ from = [0, 0, 0], toward = [0, 0, 1] }}\n\
             detects = \"2 %\"\nat-most = \"1 M paths\"\n{}",
            row.repeat(rows)
        ));
        let asked = Arc::new(AtomicU64::new(0));
        let count = Arc::clone(&asked);
        let radiance = move |_: &mut _, _: &_| {
            count.fetch_add(1, Ordering::Relaxed);
            0.0
        };
        let mut core = Fake { radiance: Box::new(radiance), ..Fake::default() };
        let finding = try_judge(&check, &mut core, Some(SceneDescription::default())).unwrap();
        assert_eq!(finding.failed_measures().count(), 3 * rows);
        asked.load(Ordering::Relaxed)
    }

    #[test]
    fn rows_after_the_first_that_fails_take_a_quarter_of_its_paths() {
        let first = paths(1);
        assert!(4 * (paths(2) - first) < first, "{first}");
    }
}
