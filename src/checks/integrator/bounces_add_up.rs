//! What is accumulated over some bounces is the sum of those bounces, isolated.

use super::estimate::{RayEntry, estimate, judge_difference, needs, settings};
use crate::checks::phrase::percent;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, Capabilities, DirectSampling};
use crate::stats::Verdict;
use crate::text::{Between, Count, Percent};

/// Samples of the estimate that relative errors are relative to.
const SCALE_SAMPLES: u64 = 65_536;

check! {
    pub(crate) struct BouncesAddUp {
        ray: RayEntry,
        last: Between<1, 1000>,
        #[serde(default)]
        direct: DirectSampling,
        detects: Percent,
        at_most: Count,
    }
    name: "bounces-add-up",
    summary: "isolated bounces sum to the accumulated radiance",
}

impl Check for BouncesAddUp {
    fn needs_besides(&self) -> Capabilities {
        needs(&settings([self.last.0; 2], self.direct))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let (seed, ray) = (context.seed, self.ray.ray());
        let effort = context.effort(self.detects, self.at_most);
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let accumulated = settings([0, self.last.0], self.direct);
        let isolated: Vec<_> =
            (0..=self.last.0).map(|bounce| settings([bounce, bounce], self.direct)).collect();
        let scale =
            estimate(built.as_mut(), ray, &accumulated, seed.child("scale"), SCALE_SAMPLES)?.mean;
        let reports = judge_difference(scale, &effort, seed, &mut |seed, samples| {
            let all = seed.child("all");
            let mut difference = estimate(built.as_mut(), ray, &accumulated, all, samples)?.mean;
            for (bounce, settings) in isolated.iter().enumerate() {
                let alone = estimate(built.as_mut(), ray, settings, seed.child(bounce), samples)?;
                (0..3).for_each(|c| difference[c] -= alone.mean[c]);
            }
            Ok(difference)
        })?;
        let difference = Measure::of_channels("accumulated minus sum", &reports);
        let share = |c: usize| (reports[c].mean / scale[c]).abs();
        let worst = percent((0..3).map(share).fold(0.0, f64::max));
        let failed = reports.iter().any(|report| report.verdict == Verdict::Fail);
        let complaint =
            format!("accumulated radiance differs from the sum of its bounces by {worst}");
        Ok(Finding::measured(format!("bounces 0 to {} add up", self.last.0), difference)
            .complaining(failed.then_some(complaint)))
    }
}
