//! The variance of an estimator where theory gives it: two estimators of one mean may be told apart by their noise.
//!
//! What is judged is the mean of the unbiased sample variances of independent runs, a mean like any other; the ratio
//! of two variances would need a normal law that radiance does not have.

use crate::checks::integrator::{
    MistakeEntry, RayEntry, RouletteEntry, draw_estimates, needs, settings,
};
use crate::checks::phrase::{figure, ratio_of};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, BuiltScene, Capabilities, DirectSampling, IntegratorSettings};
use crate::math::rng::Seed;
use crate::stats::{Band, Claim, Effort, Moments, Sides, judge_means};
use crate::text::{Between, Bounces, Count, Lit, Percent, Several};
use serde::Deserialize;

check! {
    /// Each row: the variance of one estimate along a ray is a given number.
    pub(crate) struct VarianceIsKnown {
        ray: RayEntry,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        /// `at-most` where a core may know better ways.
        #[serde(default)]
        sides: Sides,
        /// The smallest error of a variance that must be seen.
        detects: Percent,
        /// Past this the verdict is inconclusive, never a pass.
        at_most: Count,
        row: Several<Row>,
        /// What known mistakes would give.
        #[serde(default)]
        mistake: Vec<MistakeEntry>,
    }
    name: "variance-is-known",
    summary: "the variance of one estimate along a ray against theory",
}

/// One variance.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Row {
    name: String,
    #[serde(default = "one")]
    samples_per_light: Between<1, 4096>,
    roulette: Option<RouletteEntry>,
    /// Of one estimate.
    variance: Lit,
}

const fn one() -> Between<1, 4096> {
    Between(1)
}

impl Check for VarianceIsKnown {
    fn needs_besides(&self) -> Capabilities {
        self.row.iter().fold(Capabilities::empty(), |all, row| all | needs(&self.settings(row)))
    }

    fn validate(&self) -> Result<(), String> {
        if self.detects.0 <= Band::VARIANCE.relative() {
            let band = 100.0 * Band::VARIANCE.relative();
            return Err(format!("`detects` must be above the {band} % that are forgiven"));
        }
        self.mistake.iter().try_for_each(|mistake| mistake.validate(self.row.len()))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let (seed, effort) = (context.seed, context.effort(self.detects, self.at_most));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut rows = Vec::new();
        for (number, row) in self.row.iter().enumerate() {
            rows.push(self.judge(built.as_mut(), row, seed.child(number), &effort)?);
        }
        let causes: Vec<_> =
            self.mistake.iter().filter_map(|mistake| mistake.explains(&rows)).collect();
        let measures: Vec<_> = rows.into_iter().flatten().collect();
        Ok(Finding::measured(statement(&measures), measures).because_of(causes))
    }
}

impl VarianceIsKnown {
    fn settings(&self, row: &Row) -> IntegratorSettings {
        IntegratorSettings {
            samples_per_light: row.samples_per_light.0,
            roulette: row.roulette.map(Into::into),
            ..settings(self.bounces.0, self.direct)
        }
    }

    /// The measures of the three channels.
    fn judge(
        &self,
        scene: &mut dyn BuiltScene,
        row: &Row,
        seed: Seed,
        effort: &Effort,
    ) -> Result<Vec<Measure>, CheckError> {
        let settings = self.settings(row);
        let claim = |variance| Claim::value(variance, Band::VARIANCE).on_side(self.sides);
        let reports = judge_means(&row.variance.0.map(claim), effort, &mut |draw| {
            let mut moments = [Moments::default(); 3];
            let seed = draw.seed(seed);
            let ray = self.ray.ray();
            draw_estimates(scene, ray, &settings, seed, draw.samples, &mut |radiance| {
                for value in radiance {
                    (0..3).for_each(|channel| moments[channel].push(value[channel]));
                }
            })?;
            Ok::<_, CheckError>(moments.iter().map(Moments::variance).collect())
        })?;
        let measures = Measure::of_channels("", &reports).into_iter();
        Ok(measures.map(|measure| measure.of_row(&row.name)).collect())
    }
}

fn statement(measures: &[Measure]) -> String {
    let failed = measures.iter().find(|measure| measure.failed());
    let Some(measure) = failed else {
        return format!("{} variances are what they should be", measures.len());
    };
    format!(
        "{}: the variance is {} of what it should be: {} instead of {}",
        measure.name(),
        ratio_of(measure),
        figure(measure.measured),
        figure(measure.expected),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::contract::IntegratorSettings;
    use crate::math::rng::{Stream, uniform};
    use crate::scene::SceneDescription;

    /// A uniform estimate around 1 of variance 1/12, and the mean of `samples_per_light` of them.
    #[derive(Clone, Copy)]
    struct Noisy {
        width: f64,
        /// All samples of an estimate are one and the same.
        alike: bool,
    }

    impl Noisy {
        fn estimate(self, stream: &mut Stream, settings: &IntegratorSettings) -> f64 {
            let n = if self.alike { 1 } else { settings.samples_per_light };
            let mut once = || 1.0 + self.width * (uniform(stream) - 0.5);
            (0..n).map(|_| once()).sum::<f64>() / f64::from(n)
        }
    }

    const CASE: &str = r#"
        [expect]
        ray     = { from = [0, 0, 0], toward = [0, 0, 1] }
        bounces = [1, 1]
        detects = "30 %"
        at-most = "400 k"
        row     = [
          { name = "one", variance = 0.0833333 },
          { name = "four", samples-per-light = 4, variance = 0.0208333 },
        ]
        mistake = [{ cause = "samples-all-alike", gives = [0.0833333, 0.0833333] }]
    "#;

    fn found(noisy: Noisy, case: &str) -> Finding {
        let check = check_of::<VarianceIsKnown>(case);
        let draw = move |stream: &mut Stream, settings: &IntegratorSettings| {
            noisy.estimate(stream, settings)
        };
        try_judge(&check, &mut Fake::drawing(draw), Some(SceneDescription::default())).unwrap()
    }

    #[test]
    fn the_variance_of_a_uniform_law_is_a_twelfth() {
        assert_passes(&found(Noisy { width: 1.0, alike: false }, CASE));
    }

    #[test]
    fn half_again_as_much_is_seen_and_forgiven_where_less_is_allowed() {
        let wide = Noisy { width: 1.5f64.sqrt(), alike: false };
        assert!(failure(&found(wide, CASE)).starts_with("one, red: the variance is 1.5"));
        let narrow = Noisy { width: 0.5, alike: false };
        failure(&found(narrow, CASE));
        let case = CASE.replace("bounces", "sides = \"at-most\"\nbounces");
        assert_passes(&found(narrow, &case));
    }

    #[test]
    fn samples_that_are_all_alike_are_named() {
        let finding = found(Noisy { width: 1.0, alike: true }, CASE);
        assert!(failure(&finding).contains("four, red: the variance is 4"), "{finding:?}");
        assert_eq!(finding.clues[0].cause, "samples-all-alike");
    }
}
