//! How much faster than a loop over everything a BVH is, by the clock.
//!
//! A clock tells of the machine as much as of the core, so that it never fails one: what it shows is shown, and what it
//! does not show is undecided. A BVH whose hits are not those of the loop fails, however fast it is. Work is
//! graded by counts (`visits-few-nodes`). A decision in `docs/decisions` says why it is a case all the same.
//!
//! Asking takes time too, with a core in another process more than with one in ours. It is in both
//! times and makes their ratio smaller, never larger; what it takes is told beside the ratio.

use super::question::generic_rays;
use crate::checks::phrase::{figure, percent};
use crate::checks::series::{OneLine, Series, SpeedUps};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Core, Hit, Ray};
use crate::scene::SceneDescription;
use crate::stats::timing::{Faster, judge_faster, median};
use crate::text::{Count, Factor};
use std::time::Instant;

/// Pairs of times: if all of them say the same, chance does so once in 2¹⁵.
const PAIRS: usize = 15;
/// Passes whose shortest counts: a pass that the machine has interrupted is no pass.
const PASSES: usize = 3;
/// The length of a segment that meets nothing.
const HARDLY: f64 = 1e-12;

check! {
    /// The same rays with the core's own BVH and with a loop over every primitive, in turn.
    pub(crate) struct IsFaster {
        /// Rays of one pass.
        rays: Count,
        /// How many times as fast it should be.
        at_least: Factor,
    }
    name: "is-faster",
    summary: "the time with a BVH against that of the loop, for the same hits",
    needs: BUILD_SCENE | INTERSECT | BRUTE_FORCE,
}

impl Check for IsFaster {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let nothing = || CheckError::Broken("the scene has nothing to hit".to_owned());
        let bounds = scene.bounds().ok_or_else(nothing)?;
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let rays = generic_rays(bounds, count, &mut context.seed.stream());
        let hardly = |ray: &Ray| Ray { t_max: ray.t_min + HARDLY, ..*ray };
        let nothing: Vec<_> = rays.iter().map(hardly).collect();
        let mut clock =
            |acceleration, rays: &[Ray]| timed(context.core, &scene, acceleration, rays);
        let (mut pairs, mut asking, mut different) = (Vec::new(), Vec::new(), 0);
        for _ in 0..PAIRS {
            let (without, right) = clock(Acceleration::BruteForce, &rays)?;
            let (with, hits) = clock(Acceleration::DEFAULT, &rays)?;
            pairs.push((without, with));
            asking.push(clock(Acceleration::DEFAULT, &nothing)?.0 / with);
            let is_other = |(a, b): &(&Hit, &Hit)| a.t.to_bits() != b.t.to_bits();
            different = different.max(hits.iter().zip(&right).filter(is_other).count());
        }
        if different > 0 {
            return Ok(useless(different, rays.len()));
        }
        let faster = judge_faster(&pairs, self.at_least.0);
        Ok(finding(&faster, self.at_least.0, median(&asking)))
    }
}

/// The shortest of some passes over all rays, and their hits; the build does not count.
fn timed(
    core: &mut dyn Core,
    scene: &SceneDescription,
    acceleration: Acceleration,
    rays: &[Ray],
) -> Result<(f64, Vec<Hit>), CheckError> {
    let mut built = core.build_scene(scene, acceleration)?;
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut shortest = f64::INFINITY;
    for _ in 0..PASSES {
        let begun = Instant::now();
        built.intersect(rays, &mut hits)?;
        shortest = shortest.min(begun.elapsed().as_secs_f64());
    }
    Ok((shortest, hits))
}

/// Whatever a BVH does that finds other hits, it is not the same faster.
fn useless(different: usize, rays: usize) -> Finding {
    let statement = format!("{different} of {rays} hits with a BVH are not those of the loop");
    let measure = Measure::exact("hits that differ from the loop's", different as f64, 0.0, 0.0);
    Finding::of(statement, "would have caught one wrong hit", vec![measure])
}

fn finding(found: &Faster, at_least: f64, asking: f64) -> Finding {
    let Faster { speed_up, above, p_value, .. } = found;
    let [low, high] = speed_up.interval.map(figure);
    let times = format!("{} times as fast ({low} to {high})", figure(speed_up.ratio));
    let statement = format!(
        "{times} with a BVH as without; more than {at_least} times in {above} of {} pairs",
        speed_up.pairs,
    );
    let measure = Measure {
        interval: Some(speed_up.interval),
        resolution: None,
        verdict: found.verdict,
        ..Measure::exact("speed-up (at least)", speed_up.ratio, at_least, 0.0)
    };
    let shown = format!(
        "{times}; a sign test gives {}; asking alone takes {} of the time with a BVH",
        figure(*p_value),
        percent(asking),
    );
    Finding::of(statement, shown, vec![measure]).showing([series(found, at_least)])
}

fn series(found: &Faster, at_least: f64) -> Series {
    Series::SpeedUp(SpeedUps {
        ratios: OneLine::rounded(found.ratios.iter().copied()),
        median: found.speed_up.ratio,
        interval: Some(found.speed_up.interval),
        at_least,
    })
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::*;
    use crate::checks::testing::{check_of, failure, try_judge};
    use crate::math::rng::Seed;
    use crate::scene::procedural;
    use crate::stats::Verdict;

    #[test]
    fn a_bvh_that_loses_hits_fails_however_fast_it_is() {
        let check: IsFaster = check_of("[expect]\nrays = 200\nat-least = 1.01");
        let scene = super::super::question::scene_of(procedural::soup(500, Seed(1)));
        let finding = try_judge(&check, &mut FakeCore(Slip::ShrinksBoxes), Some(scene)).unwrap();
        assert!(failure(&finding).contains("are not those of the loop"), "{finding:?}");
    }

    #[test]
    fn a_clock_shows_or_leaves_open_and_never_fails() {
        let told = |ratio: f64| {
            let pairs = [(ratio, 1.0); PAIRS];
            finding(&judge_faster(&pairs, 2.0), 2.0, 0.1)
        };
        assert_eq!(told(30.0).verdict, Verdict::Pass);
        assert!(told(30.0).statement.starts_with("30 times as fast"), "{:?}", told(30.0));
        assert_eq!(told(1.0).verdict, Verdict::Inconclusive);
        assert_eq!(told(f64::NAN).verdict, Verdict::Inconclusive);
        assert!(told(30.0).hypotheses().next().is_none(), "nothing is entered in the ledger");
    }
}
