//! Russian roulette: which share of paths gets how far.
//!
//! In a furnace every path that goes on brings light, so an isolated bounce is dark in just those paths that have
//! been stopped. What the survivors are worth is not looked at here: means say that.

use super::estimate::{RayEntry, RouletteEntry, draw_estimates, needs, settings};
use super::roulette_law::{Law, MISTAKES, law};
use crate::checks::phrase::{figure, percent};
use crate::checks::series::{OneLine, Series, Survival};
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, check};
use crate::contract::{
    Acceleration, BuiltScene, Capabilities, DirectSampling, IntegratorSettings, Roulette,
};
use crate::math::rng::Seed;
use crate::stats::{Band, Effort, ShareReport, Verdict, judge_share};
use crate::text::{Between, Count, Percent, Several};

check! {
    pub(crate) struct RouletteStopsPaths {
        ray: RayEntry,
        /// The last bounce that is looked at; the first is 1.
        /// Below 3 no law can be told from another.
        last: Between<3, 1000>,
        roulette: Several<RouletteEntry>,
        detects: Percent,
        at_most: Count,
    }
    name: "roulette-stops-paths",
    summary: "Russian roulette: the share of paths that reaches each bounce",
}

impl Check for RouletteStopsPaths {
    fn needs_besides(&self) -> Capabilities {
        let one = self.roulette.first().copied();
        needs(&IntegratorSettings { roulette: one.map(Into::into), ..self.settings(1) })
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let (seed, effort) = (context.seed, context.effort(self.detects, self.at_most));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut shares = Vec::new();
        for (number, entry) in self.roulette.iter().enumerate() {
            for bounce in 1..=self.last.0 {
                let seed = seed.child(number).child(bounce);
                shares.push(self.share(built.as_mut(), (*entry).into(), bounce, seed, &effort)?);
            }
        }
        Ok(finding(&shares))
    }
}

/// One roulette and one bounce.
struct Share {
    roulette: Roulette,
    bounce: u32,
    report: ShareReport,
}

impl RouletteStopsPaths {
    /// By hemisphere sampling: every direction inside a furnace meets light, whatever a core knows of light sampling.
    fn settings(&self, bounce: u32) -> IntegratorSettings {
        settings([bounce, bounce], DirectSampling::Hemisphere)
    }

    fn share(
        &self,
        scene: &mut dyn BuiltScene,
        roulette: Roulette,
        bounce: u32,
        seed: Seed,
        effort: &Effort,
    ) -> Result<Share> {
        let settings = IntegratorSettings { roulette: Some(roulette), ..self.settings(bounce) };
        let expected = law(&roulette, bounce);
        let report = judge_share(expected, Band::RADIANCE, effort, &mut |stage, samples| {
            let mut lit = 0;
            let seed = seed.child(stage);
            draw_estimates(scene, self.ray.ray(), &settings, seed, samples, &mut |radiance| {
                lit += radiance.iter().filter(|value| **value != [0.0; 3]).count() as u64;
            })?;
            Ok::<_, CheckError>(lit)
        })?;
        Ok(Share { roulette, bounce, report })
    }
}

fn finding(shares: &[Share]) -> Finding {
    let failed = shares.iter().find(|share| share.report.verdict == Verdict::Fail);
    let right = "roulette stops as many paths as it says";
    let finding = Finding::measured(right, shares.iter().map(Share::measure))
        .complaining(failed.map(Share::complaint))
        .showing(shares.chunk_by(|a, b| a.roulette == b.roulette).map(series));
    if failed.is_none() {
        return finding;
    }
    let made = MISTAKES.iter().filter(|(_, law)| {
        let differs = |share: &Share| share.expected(*law) != share.report.expected;
        shares.iter().any(differs) && shares.iter().all(|share| share.is_of(*law))
    });
    let evidence = format!("predicts the shares of all {} isolated bounces", shares.len());
    finding.because_each(made.map(|(cause, _)| *cause), &evidence)
}

/// How far paths get under one roulette.
fn series(shares: &[Share]) -> Series {
    let of = |value: fn(&Share) -> f64| OneLine::rounded(shares.iter().map(value));
    Series::Survival(Survival {
        of: shares.first().map(Share::roulette).unwrap_or_default(),
        bounces: shares.iter().map(|share| share.bounce).collect(),
        share: of(|share| share.report.share),
        low: of(|share| share.report.interval[0]),
        high: of(|share| share.report.interval[1]),
        expected: of(|share| share.report.expected),
    })
}

impl Share {
    fn expected(&self, law: Law) -> f64 {
        law(&self.roulette, self.bounce)
    }

    /// Whether the share is that of a law.
    fn is_of(&self, law: Law) -> bool {
        let [low, high] = self.report.interval;
        let slack = Band::RADIANCE.relative() * self.expected(law);
        (low - slack..=high + slack).contains(&self.expected(law))
    }

    fn name(&self) -> String {
        format!("{}, bounce {}", self.roulette(), self.bounce)
    }

    fn roulette(&self) -> String {
        let Roulette { stop, guaranteed } = self.roulette;
        format!("stop {}, {guaranteed} guaranteed", figure(stop))
    }

    fn measure(&self) -> Measure {
        Measure::of("", &self.report).of_row(self.name())
    }

    fn complaint(&self) -> String {
        let [low, high] = self.report.interval.map(percent);
        let (share, expected) = (percent(self.report.share), percent(self.report.expected));
        let name = self.name();
        format!("{name}: {share} ({low} to {high}) of paths bring light, not {expected}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, try_judge};
    use crate::contract::IntegratorSettings;
    use crate::math::rng::{Stream, uniform};
    use crate::scene::SceneDescription;

    const CASE: &str =
        include_str!("../../../cases/integrator/russian-roulette-path-lengths-are-geometric.toml");

    /// Paths bring light at a bounce with the probability of a law.
    fn stopping(law: Law) -> impl Fn(&mut Stream, &IntegratorSettings) -> f64 + Copy + Send {
        move |stream, settings| {
            let probability = law(&settings.roulette.unwrap(), *settings.bounces.start());
            if uniform(stream) < probability { 0.7 } else { 0.0 }
        }
    }

    fn found(law: Law) -> Finding {
        // Large errors are what these tests make: no need to look for small ones.
        let check = check_of::<RouletteStopsPaths>(&CASE.replace("5 %", "20 %"));
        try_judge(&check, &mut Fake::drawing(stopping(law)), Some(SceneDescription::default()))
            .unwrap()
    }

    #[test]
    fn the_geometric_law_passes() {
        let finding = found(law);
        assert_passes(&finding);
        let names: Vec<_> = finding
            .series
            .iter()
            .map(|series| match series {
                Series::Survival(survival) => (survival.of.clone(), survival.bounces.len()),
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(names.len() * names[0].1, finding.measures.len(), "{names:?}");
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        for (cause, law) in MISTAKES {
            assert_eq!(causes(&found(*law)), [cause.name]);
        }
    }

    #[test]
    fn a_share_that_is_a_little_off_is_seen_and_has_no_name() {
        let finding = found(|roulette, bounce| 0.7 * law(roulette, bounce));
        let statement = failure(&finding);
        assert!(statement.contains(" of paths bring light, not 100 %"), "{statement}");
        assert!(finding.clues.is_empty());
    }
}
