//! How much faster than a loop over everything a hierarchy is, by the clock.
//!
//! A clock tells of the machine as much as of the core, so that it never fails one: what it shows is
//! shown, and what it does not show is undecided. Work is graded by counts (`visits-few-nodes`). A
//! decision in `docs/decisions` says why it is a case all the same.

use super::question::generic_rays;
use crate::checks::phrase::figure;
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Acceleration, Capabilities, Core, Hit, Ray};
use crate::scene::SceneDescription;
use crate::stats::timing::{Faster, judge_faster};
use crate::text::Count;
use serde::Deserialize;
use std::time::Instant;

/// Pairs of times: if all of them say the same, chance does so once in 2¹⁵.
const PAIRS: usize = 15;
/// Passes whose shortest counts: a pass that the machine has interrupted is no pass.
const PASSES: usize = 3;

/// The same rays with the core's own hierarchy and with a loop over every primitive, in turn.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct IsFaster {
    /// Rays of one pass.
    rays: Count,
    /// How many times as fast it should be.
    at_least: f64,
}

impl Check for IsFaster {
    const NAME: &'static str = "is-faster";
    const SUMMARY: &'static str = "the time with a hierarchy against that of the loop; never fails";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE | Capabilities::INTERSECT | Capabilities::BRUTE_FORCE
    }

    fn validate(&self) -> Result<(), String> {
        if self.at_least >= 1.0 && self.rays.0 > 0 {
            return Ok(());
        }
        Err("`at-least` is a factor above 1, and some `rays` are needed".to_owned())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let bounds = scene
            .bounds()
            .ok_or_else(|| CheckError::Broken("the scene has nothing to hit".to_owned()))?;
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let rays = generic_rays(bounds, count, &mut context.seed.stream());
        let mut time = |acceleration| seconds(context.core, &scene, acceleration, &rays);
        let mut pairs = Vec::with_capacity(PAIRS);
        for _ in 0..PAIRS {
            pairs.push((time(Acceleration::BruteForce)?, time(Acceleration::DEFAULT)?));
        }
        Ok(finding(&judge_faster(&pairs, self.at_least), self.at_least))
    }
}

/// The shortest of some passes over all rays; the build does not count.
fn seconds(
    core: &mut dyn Core,
    scene: &SceneDescription,
    acceleration: Acceleration,
    rays: &[Ray],
) -> Result<f64, CheckError> {
    let mut built = core.build_scene(scene, acceleration)?;
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut shortest = f64::INFINITY;
    for _ in 0..PASSES {
        let begun = Instant::now();
        built.intersect(rays, &mut hits)?;
        shortest = shortest.min(begun.elapsed().as_secs_f64());
    }
    Ok(shortest)
}

fn finding(found: &Faster, at_least: f64) -> Finding {
    let Faster { speed_up, above, p_value, .. } = found;
    let [low, high] = speed_up.interval.map(figure);
    let times = format!("{} times as fast ({low} to {high})", figure(speed_up.ratio));
    let statement = format!(
        "{times} with a hierarchy as without; more than {at_least} times in {above} of {} pairs",
        speed_up.pairs,
    );
    let measure = Measure {
        interval: Some(speed_up.interval),
        resolution: None,
        verdict: found.verdict,
        ..Measure::exact("speed-up (at least)", speed_up.ratio, at_least, 0.0)
    };
    let shown = format!("{times}; a sign test gives {}", figure(*p_value));
    Finding::of(statement, shown, vec![measure])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Verdict;

    #[test]
    fn a_clock_shows_or_leaves_open_and_never_fails() {
        let told = |ratio: f64| {
            let pairs = [(ratio, 1.0); PAIRS];
            finding(&judge_faster(&pairs, 2.0), 2.0)
        };
        assert_eq!(told(30.0).verdict, Verdict::Pass);
        assert!(told(30.0).statement.starts_with("30 times as fast"), "{:?}", told(30.0));
        assert_eq!(told(1.0).verdict, Verdict::Inconclusive);
        assert_eq!(told(f64::NAN).verdict, Verdict::Inconclusive);
        assert!(told(30.0).hypotheses().next().is_none(), "nothing is entered in the ledger");
    }
}
