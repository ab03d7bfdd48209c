//! The variance of an estimator where theory gives it: two unbiased estimators of one mean may be told
//! apart by their noise, and variance reduction is seen to reduce it.
//!
//! What is judged is the mean of the unbiased sample variances of independent runs, a mean like any other; the ratio
//! of two variances would need a normal law that radiance does not have.

use super::estimate::{RayEntry, RouletteEntry, draw_estimates, needs, one, settings};
use super::foretold::MistakeEntry;
use crate::checks::phrase::{figure, ratio_of};
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, BuiltScene, Capabilities, DirectSampling, IntegratorSettings};
use crate::math::rng::Seed;
use crate::stats::{Band, Claim, Effort, Moments, Sides, judge_means};
use crate::text::{Between, Bounces, Count, Lit, Percent, Several};
use serde::Deserialize;

check! {
    pub(crate) struct VarianceIsKnown {
        ray: RayEntry,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        /// `at-most` where a core may know better ways.
        #[serde(default)]
        sides: Sides,
        detects: Percent,
        at_most: Count,
        row: Several<Row>,
        #[serde(default)]
        mistake: Vec<MistakeEntry>,
    }
    name: "variance-is-known",
    summary: "the variance of one estimate along a ray against theory",
}

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

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
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
    ) -> Result<Vec<Measure>> {
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
    use crate::math::rng::{Stream, uniform};
    use crate::scene::SceneDescription;

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

    /// Estimates are uniform around 1, of variance width²/12, or the mean of `samples_per_light` of them; or those
    /// are `alike`, one and the same.
    fn found(width: f64, alike: bool, case: &str) -> Finding {
        let check = check_of::<VarianceIsKnown>(case);
        let draw = move |stream: &mut Stream, settings: &IntegratorSettings| {
            let n = if alike { 1 } else { settings.samples_per_light };
            let mut once = || 1.0 + width * (uniform(stream) - 0.5);
            (0..n).map(|_| once()).sum::<f64>() / f64::from(n)
        };
        try_judge(&check, &mut Fake::drawing(draw), Some(SceneDescription::default())).unwrap()
    }

    /// What one of its measures is of what it should be.
    fn ratio(finding: &Finding, measure: usize) -> f64 {
        finding.measures[measure].measured / finding.measures[measure].expected
    }

    #[test]
    fn the_variance_of_a_uniform_law_is_a_twelfth() {
        assert_passes(&found(1.0, false, CASE));
    }

    #[test]
    fn half_again_as_much_is_seen_and_forgiven_where_less_is_allowed() {
        let wide = found(1.5f64.sqrt(), false, CASE);
        assert!(failure(&wide).starts_with("one, red: the variance is 1."));
        assert!((ratio(&wide, 0) - 1.5).abs() < 0.1, "{wide:?}");
        failure(&found(0.5, false, CASE));
        let case = CASE.replace("bounces", "sides = \"at-most\"\nbounces");
        assert_passes(&found(0.5, false, &case));
    }

    #[test]
    fn samples_that_are_all_alike_are_named() {
        let finding = found(1.0, true, CASE);
        assert!(failure(&finding).contains("four, red: the variance is"), "{finding:?}");
        assert!((ratio(&finding, 3) - 4.0).abs() < 0.2, "{finding:?}");
        assert_eq!(finding.clues[0].cause, "samples-all-alike");
    }
}
